"""What grids, storages and cones cost and give: the method voxel beside the reference tracer with equal bounces.

python benchmarks/voxel_quality.py --twinlight target/release/twinlight SCENE... [--size 128] [--spp 64]

Prints a Markdown table per scene. The line "reference" is another render by the reference tracer with as many samples and
another seed: the noise that the other lines' direct light has too.
"""

import argparse
import itertools
import tempfile
from pathlib import Path

from slhb_quality import compare, render

GRIDS, STORAGES, CONES = (64, 128, 256), ("iso", "aniso", "sh", "sh8"), ("6", "generic:16")


def row(label: str, measured: dict, sidecar: dict) -> str:
    metrics = {name: metric["value"] for name, metric in measured["metrics"].items()}
    seconds = sidecar["seconds"]
    cells = [label, *(f"{metrics[name]:.4f}" for name in ("relmse", "mssim", "flip", "ratio"))]
    for step in ("voxelize", "light_voxels", "reduce_mips", "trace_cones"):
        cells.append("" if seconds.get(step) is None else f"{seconds[step] * 1e3:.0f}")
    cells.append(f"{seconds['trace_paths']:.2f}")
    return "| " + " | ".join(cells) + " |"


def table(options, scene: str, folder: Path) -> None:
    print(f"\n{scene}, {options.size}², {options.bounces} bounces, {options.spp} samples per pixel\n")
    head = "grid, storage, cones | relMSE | MSSIM | ꟻLIP | mean ratio | voxelize, ms | light, ms | reduce, ms | cones, ms | paths, s"
    print(f"| {head} |")
    print("|" + "---|" * 10)
    truth, out = folder / "truth.exr", folder / "test.exr"
    render(options, scene, truth, options.reference_spp, ["--method", "reference"])
    other = render(options, scene, out, options.spp, ["--method", "reference", "--seed", "1"])
    print(row("reference", compare(options, out, truth), other), flush=True)
    for cones, storage, grid in itertools.product(CONES, STORAGES, GRIDS):
        knobs = ["--method", "voxel", "--grid", str(grid), "--storage", storage, "--cones", cones]
        sidecar = render(options, scene, out, options.spp, [*knobs, "--seed", "1"])
        print(row(f"{grid}, {storage}, {cones}", compare(options, out, truth), sidecar), flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--twinlight", default="twinlight")
    parser.add_argument("--allow-path", action="append", default=[], help="folders beside the scene's that it may read")
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--reference-spp", type=int, default=1024)
    parser.add_argument("--bounces", type=int, default=4)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for scene in options.scenes:
            table(options, scene, Path(folder))


if __name__ == "__main__":
    main()
