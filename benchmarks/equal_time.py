"""Errors for the same time: what each method makes of a budget, and what `--budget` chooses.

python benchmarks/equal_time.py --twinlight target/release/twinlight SCENE... [--size 256] [--times 0.1,0.3,1,3,10] [--costs DIR]

Prints a Markdown table per scene: seconds that were taken from the compiled scene to the picture, relMSE and ꟻLIP against the
reference tracer with as many bounces. With --costs, settings come from the tables DIR/STEM-cost that `twinlight cost` wrote of
the scenes; without, from the builtin scenes' (`--budget` as a newcomer has it).
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

METHODS = ("reference", "slhb", "voxel", None)


def run(options, scene: str, out: Path, extra: list[str]) -> dict:
    size = f"{options.size}x{options.size}"
    command = [options.twinlight, "render", scene, "-o", str(out), "--size", size, "--bounces", str(options.bounces)]
    command += ["--backend", "cpu", "--progress", "never", *extra]
    command += [word for path in options.allow_path for word in ("--allow-path", path)]
    subprocess.run(command, check=True, capture_output=True)
    return json.loads(out.with_suffix(".json").read_text())


def errors(options, test: Path, reference: Path) -> dict:
    command = [options.twinlight, "compare", "--json", str(test), str(reference)]
    measured = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)["metrics"]
    return {name: metric["value"] for name, metric in measured.items()}


def stem(scene: str) -> str:
    return scene.removeprefix("builtin:") if scene.startswith("builtin:") else Path(scene).stem


def knobs(sidecar: dict) -> str:
    settings = sidecar["settings"]
    of = settings["slhb"] or settings["voxel"] or {}
    names = ("directions", "size", "interleave", "filter", "shadows", "grid", "storage", "cones")
    return " ".join([settings["method"], *(str(of[name]) for name in names if name in of)])


def cell(options, scene: str, seconds: float, method: str | None, truth: Path, out: Path) -> str:
    extra = ["--budget", str(seconds)] + (["--method", method] if method else [])
    if options.costs:
        extra += ["--costs", str(options.costs / f"{stem(scene)}-cost")]
    sidecar = run(options, scene, out, extra)
    found = errors(options, out, truth)
    text = f"{sidecar['budget']['taken']:.2f} s, {found['relmse']:.4f}, {found['flip']:.3f}"
    if method is None:
        expected = sidecar["budget"]["expected"]
        text += f" | {knobs(sidecar)} | {expected['relmse']:.4f}, {expected['flip']:.3f}"
    return text


def table(options, scene: str, folder: Path) -> None:
    print(f"\n{scene}, {options.size}², {options.bounces} bounces: seconds taken, relMSE, ꟻLIP\n")
    print("| budget | reference | slhb | voxel | chosen by --budget | what | expected |\n|" + "---|" * 7)
    truth, out = folder / "truth.exr", folder / "test.exr"
    run(options, scene, truth, ["--spp", str(options.reference_spp), "--seed", "7"])
    for seconds in options.times:
        cells = [cell(options, scene, seconds, method, truth, out) for method in METHODS]
        print(f"| {seconds} s | " + " | ".join(cells) + " |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--twinlight", required=True)
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--bounces", type=int, default=4)
    parser.add_argument("--reference-spp", type=int, default=2048)
    parser.add_argument("--times", type=lambda text: [float(t) for t in text.split(",")], default=[0.1, 0.3, 1, 3, 10])
    parser.add_argument("--costs", type=Path)
    parser.add_argument("--allow-path", action="append", default=[])
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for scene in options.scenes:
            table(options, scene, Path(folder))


if __name__ == "__main__":
    main()
