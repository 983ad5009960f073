#!/usr/bin/env python3
"""Lookups in layered hit buffers beside Embree's closest hits of the same rays, alternately in one run; Markdown on stdout.

    sudo apt-get install libembree-dev
    python3 benchmarks/beside_embree.py [SCENE...] [--rounds 5]

The rays are cosine-weighted, from random points of the scene's surfaces. Lookups are in the order of their directions, as the method
makes them; Embree, one ray a call on all cores, gets the rays in that order and in a random one. Embree is needed for measuring
only.
"""

import argparse
import re
import subprocess
import tempfile
from pathlib import Path
from statistics import median

ROOT = Path(__file__).resolve().parent.parent
BENCH = ["cargo", "bench", "--quiet", "-p", "twinlight", "--bench", "lhb", "--", "--part", "lookups"]


def compiled(folder: Path) -> Path:
    source, program = ROOT / "benchmarks/embree_rays.cpp", folder / "embree_rays"
    for library in ("embree4", "embree3"):
        command = ["c++", "-O3", "-march=native", str(source), f"-l{library}", "-lpthread", "-o", str(program)]
        if subprocess.run(command, capture_output=not library.endswith("3")).returncode == 0:
            return program
    raise SystemExit("embree_rays.cpp did not compile: is Embree installed?")


def lookups(scene: str, dump: Path | None = None) -> float:
    command = [*BENCH, scene, "--rounds", "3", *(["--dump", str(dump)] if dump else [])]
    text = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return float(re.search(r"lookups: ([\d.]+) M/s", text)[1])


def embree(program: Path, dump: Path) -> dict[str, float]:
    text = subprocess.run([str(program), str(dump), "3"], check=True, capture_output=True, text=True).stdout
    return {line.split()[0]: float(line.split()[1]) for line in text.splitlines()}


def spread(values: list[float], digits: int) -> str:
    return f"{median(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=["builtin:room-70k", "builtin:room-1m"])
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    print("| scene | lookups, M/s | Embree, same order, M/s | random order, M/s | ratio | random order |")
    print("|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        program, dump = compiled(Path(folder)), Path(folder) / "rays"
        for scene in options.scenes:
            rounds = []
            lookups(scene, dump)
            for _ in range(options.rounds):
                rounds.append((lookups(scene), embree(program, dump)))
            ours = [rate for rate, _ in rounds]
            cells = [spread(ours, 1)]
            cells += [spread([theirs[order] for _, theirs in rounds], 2) for order in ("sorted", "shuffled")]
            cells += [spread([rate / theirs[order] for rate, theirs in rounds], 1) for order in ("sorted", "shuffled")]
            print("| " + " | ".join([scene, *cells]) + " |", flush=True)


if __name__ == "__main__":
    main()
