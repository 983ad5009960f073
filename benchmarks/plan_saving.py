"""What plans save: every scene with all effects and as planned, in turns, for each method.

python benchmarks/plan_saving.py --twinlight target/release/twinlight SCENE... [--size 128] [--spp 32] [--rounds 3]

Prints a Markdown table: time to plan, seconds from the compiled scene to the picture with all effects and as planned (medians, in
turns within one run), their ratio with its spread, the largest difference of a pixel, and the plan's bound of it.
"""

import argparse
import json
import statistics
import subprocess
import tempfile
from pathlib import Path

METHODS = ("reference", "slhb", "voxel")
STEPS = ("plan", "upload", "rasterize_lhb", "pack_lhb", "walk_lhb", "trace_paths", "shade_primary", "filter_indirect")
STEPS += ("voxelize", "light_voxels", "reduce_mips", "trace_cones")


def render(options, scene: str, method: str, effects: str, out: Path) -> dict:
    size = f"{options.size}x{options.size}"
    command = [options.twinlight, "render", scene, "-o", str(out), "--size", size, "--spp", str(options.spp)]
    command += ["--method", method, "--effects", effects, "--backend", "cpu", "--progress", "never"]
    command += [word for path in options.allow_path for word in ("--allow-path", path)]
    subprocess.run(command, check=True, capture_output=True)
    return json.loads(out.with_suffix(".json").read_text())


def seconds(sidecar: dict) -> float:
    return sum(sidecar["seconds"].get(step) or 0.0 for step in STEPS)


def difference(options, test: Path, reference: Path) -> float:
    command = [options.twinlight, "compare", "--json", str(test), str(reference)]
    found = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    return found["max_abs"]["value"] or 0.0


def row(options, scene: str, method: str, folder: Path) -> str:
    everything, planned = folder / "all.exr", folder / "auto.exr"
    pairs, plans = [], []
    for _ in range(options.rounds):
        whole = render(options, scene, method, "all", everything)
        part = render(options, scene, method, "auto", planned)
        pairs.append((seconds(whole), seconds(part)))
        plans.append(part["seconds"]["plan"])
    ratios = [auto / whole for whole, auto in pairs]
    skipped = [e["effect"] for e in part["plan"]["effects"] if e["decision"] == "skipped"]
    bound = part["plan"]["bound"]
    cells = [Path(scene).stem, method, f"{statistics.median(plans) * 1e3:.1f}"]
    cells += [f"{statistics.median(side):.3f}" for side in zip(*pairs)]
    cells.append(f"{statistics.median(ratios):.2f} ({min(ratios):.2f}–{max(ratios):.2f})")
    cells += [f"{difference(options, planned, everything):.2g}", "unknown" if bound is None else f"{bound:.2g}"]
    cells.append(f"{part['plan']['bounces'] or 'roulette'}, {len(skipped)} of {len(part['plan']['effects'])}")
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--twinlight", required=True)
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--spp", type=int, default=32)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--allow-path", action="append", default=[])
    options = parser.parse_args()
    head = "scene | method | plan, ms | all effects, s | planned, s | ratio | largest difference | bound | bounces, effects skipped"
    print(f"| {head} |\n|" + "---|" * 9)
    with tempfile.TemporaryDirectory() as folder:
        for scene in options.scenes:
            for method in METHODS:
                print(row(options, scene, method, Path(folder)), flush=True)


if __name__ == "__main__":
    main()
