"""What directions, sizes and the cone cost and give: the method slhb beside the reference tracer with equal bounces.

python benchmarks/slhb_quality.py --twinlight target/release/twinlight SCENE... [--size 128] [--spp 256]

Prints a Markdown table per scene. The line "reference" is another render by the reference tracer with as many samples and
another seed: the noise that the other lines can't fall below.
"""

import argparse
import itertools
import json
import subprocess
import tempfile
from pathlib import Path

DIRECTIONS, SIZES, CONES = (8, 20, 80, 320, 1280), (32, 64, 128, 256), ("auto", "off")


def render(options, scene: str, out: Path, spp: int, extra: list[str]) -> dict:
    size = f"{options.size}x{options.size}"
    command = [options.twinlight, "render", scene, "-o", str(out), "--size", size, "--spp", str(spp)]
    command += ["--bounces", str(options.bounces), "--backend", "cpu", "--progress", "never", *extra]
    command += [word for path in options.allow_path for word in ("--allow-path", path)]
    subprocess.run(command, check=True, capture_output=True)
    return json.loads(out.with_suffix(".json").read_text())


def compare(options, test: Path, reference: Path) -> dict:
    command = [options.twinlight, "compare", "--json", str(test), str(reference)]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


def row(label: str, measured: dict, sidecar: dict) -> str:
    metrics = {name: metric["value"] for name, metric in measured["metrics"].items()}
    seconds = sidecar["seconds"]
    build = seconds.get("rasterize_lhb")
    walk = seconds.get("walk_lhb") or seconds.get("trace_paths")
    cells = [label, *(f"{metrics[name]:.4f}" for name in ("relmse", "mssim", "flip", "ratio"))]
    cells += ["" if build is None else f"{build * 1e3:.0f}", f"{walk:.2f}"]
    return "| " + " | ".join(cells) + " |"


def table(options, scene: str, folder: Path) -> None:
    print(f"\n{scene}, {options.size}², {options.bounces} bounces, {options.spp} samples per pixel\n")
    print("| directions, size, cone | relMSE | MSSIM | ꟻLIP | mean ratio | build, ms | walk, s |")
    print("|---|---|---|---|---|---|---|")
    truth, out = folder / "truth.exr", folder / "test.exr"
    render(options, scene, truth, options.reference_spp, ["--method", "reference"])
    other = render(options, scene, out, options.spp, ["--method", "reference", "--seed", "1"])
    print(row("reference", compare(options, out, truth), other), flush=True)
    for cone, size, directions in itertools.product(CONES, SIZES, DIRECTIONS):
        knobs = ["--method", "slhb", "--directions", str(directions), "--lhb-size", str(size), "--cone", cone]
        sidecar = render(options, scene, out, options.spp, [*knobs, "--seed", "1"])
        print(row(f"{directions}, {size}², {cone}", compare(options, out, truth), sidecar), flush=True)


def tables(description: str, spp: int, table) -> None:
    """Prints `table` of every scene of the command line."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--twinlight", default="twinlight")
    parser.add_argument("--allow-path", action="append", default=[], help="folders beside the scene's that it may read")
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--spp", type=int, default=spp)
    parser.add_argument("--reference-spp", type=int, default=1024)
    parser.add_argument("--bounces", type=int, default=4)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for scene in options.scenes:
            table(options, scene, Path(folder))


if __name__ == "__main__":
    tables(__doc__, 256, table)
