"""What grids, storages and cones cost and give: the method voxel beside the reference tracer with equal bounces.

python benchmarks/voxel_quality.py --twinlight target/release/twinlight SCENE... [--size 128] [--spp 64]

Prints a Markdown table per scene. The line "reference" is another render by the reference tracer with as many samples and
another seed: the noise that the other lines' direct light has too.
"""

import itertools
from pathlib import Path

from slhb_quality import compare, render, tables

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


if __name__ == "__main__":
    tables(__doc__, 64, table)
