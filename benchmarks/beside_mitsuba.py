#!/usr/bin/env python3
"""The reference path tracer beside Mitsuba 3, alternately in one run; Markdown tables on stdout.

    cargo build --release
    python3 -m venv target/peers && target/peers/bin/pip install mitsuba numpy
    target/peers/bin/python benchmarks/beside_mitsuba.py

About ten minutes on two cores; for a look, add --rounds 3 --reference-spp 512 --seconds 0.5 2 --seeds 1.

Same triangles, normals, materials, light and camera, 256x256, box filter, unlimited bounces, roulette from the fourth
vertex on. First it checks that both converge to the same picture: what is not the same is not worth timing. Mitsuba is
needed for measuring only; twinlight never depends on it. Its llvm variants look for LLVM's library where
DRJIT_LIBLLVM_PATH says (Debian: libllvm19, /usr/lib/x86_64-linux-gnu/libLLVM.so.19.1).

Times: the kernel alone for twinlight, mi.render() alone for Mitsuba, which has compiled its kernels before. Neither
counts loading the scene or building its hierarchy.
"""

import argparse
import datetime
import os
import platform
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from contenders import SIZE, Mitsuba, Twinlight
from measures import Agreement, Converged, combined, rel_mse, spread

ROOT = Path(__file__).resolve().parent.parent
SCENES = ["builtin:cornell", "builtin:room-70k", "builtin:room-1m"]
# Seeds below this one are for timing, from it on for references: no picture is judged by its own samples.
REFERENCE_SEED = 1000


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", action="append", help=f"of diffuse surfaces; default: {', '.join(SCENES)}")
    parser.add_argument("--rounds", type=int, default=7, help="alternating rounds of the timing")
    parser.add_argument("--spp", type=int, default=64, help="samples per pixel of the timing")
    parser.add_argument("--reference-spp", type=int, default=2048, help="samples per pixel of each converged picture")
    parser.add_argument("--batches", type=int, default=16, help="independent parts of each converged picture")
    parser.add_argument("--seconds", type=float, nargs="*", default=[0.5, 1.0, 2.0, 5.0], help="of error over time")
    parser.add_argument("--seeds", type=int, default=3, help="pictures whose errors are averaged")
    parser.add_argument("--twinlight", type=Path, default=ROOT / "target/release/twinlight")
    chosen = parser.parse_args()
    if not chosen.twinlight.exists():
        parser.error(f"{chosen.twinlight} is not there: cargo build --release")
    if chosen.batches < 2 or chosen.reference_spp < chosen.batches:
        parser.error("a converged picture needs two batches and a sample for each")
    return chosen


def main() -> None:
    chosen = arguments()
    import mitsuba as mi

    # Only to read pictures here; the timed variants have processes of their own.
    mi.set_variant("scalar_rgb")
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        ours = Twinlight(chosen.twinlight, folder)
        scalar, llvm = Mitsuba("scalar_rgb"), Mitsuba("llvm_ad_rgb")
        print(heading(mi.__version__, chosen))
        for scene in chosen.scene or SCENES:
            exported = folder / "scene.toml"
            convert = [chosen.twinlight, "scene", "convert", scene, exported]
            subprocess.run(convert, check=True, stdout=subprocess.DEVNULL)
            for contender in (ours, scalar, llvm):
                contender.load(scene, exported)
            measure(scene, ours, scalar, llvm, chosen)


def heading(mitsuba_version: str, chosen: argparse.Namespace) -> str:
    version = subprocess.check_output([chosen.twinlight, "--version"], text=True).strip()
    load = ", ".join(f"{x:.1f}" for x in os.getloadavg())
    return (
        f"{version} beside Mitsuba {mitsuba_version}, {datetime.date.today()}, {processor()}, {os.cpu_count()} threads,"
        f" {SIZE}×{SIZE}, box filter, unlimited bounces. Load averages at the start: {load}."
    )


def processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.machine())


def measure(scene: str, ours: Twinlight, scalar: Mitsuba, llvm: Mitsuba, chosen: argparse.Namespace) -> None:
    print(f"\n## {scene}", flush=True)
    pictures = [converged(contender, chosen) for contender in (ours, llvm)]
    print_agreement(pictures, chosen)
    reference, noise = combined(*pictures)
    rates = print_rates([ours, scalar, llvm], chosen)
    print_samplers(ours, llvm, reference, noise, chosen)
    if chosen.seconds:
        print_error_over_time([ours, scalar, llvm], rates, reference, chosen)


def converged(contender, chosen: argparse.Namespace) -> Converged:
    spp = chosen.reference_spp // chosen.batches
    # Batches of different seeds are independent, which the variance over batches relies on.
    shots = [contender.render(spp, REFERENCE_SEED + i) for i in range(chosen.batches)]
    return Converged(np.stack([shot.image for shot in shots]), spp * chosen.batches)


def table(header: list[str], rows: list[list[str]]) -> None:
    lines = [header, ["---"] * len(header), *rows]
    print("\n" + "\n".join("| " + " | ".join(line) + " |" for line in lines), flush=True)


def print_agreement(pictures: list[Converged], chosen: argparse.Namespace) -> None:
    ours, theirs = pictures
    same = Agreement.between(ours, theirs)
    print(f"\nSame picture? {ours.spp} samples per pixel each, Mitsuba llvm_ad_rgb, {chosen.batches} batches.")
    table(
        ["", "twinlight against Mitsuba", "expected of equal pictures, from the noise"],
        [
            ["mean radiance, ratio", f"{same.ratio:.5f}", f"1 ± {same.ratio_error:.5f}"],
            ["relMSE, pixels", f"{same.pixels:.3g}", f"{same.pixels_noise:.3g}"],
            ["relMSE, blocks of 16×16 pixels", f"{same.blocks:.3g}", f"{same.blocks_noise:.3g}"],
        ],
    )


def print_rates(contenders: list, chosen: argparse.Namespace) -> list[float]:
    """Times all contenders in turn; gives each one's median rate, paths per second."""
    paths = SIZE * SIZE * chosen.spp / 1e6
    wall, processor_time = [[] for _ in contenders], [[] for _ in contenders]
    for turn in range(chosen.rounds):
        # Another one begins each time, so that none always comes after the same.
        for k in range(len(contenders)):
            i = (k + turn) % len(contenders)
            shot = contenders[i].render(chosen.spp, turn)
            wall[i].append(paths / shot.seconds)
            processor_time[i].append(paths / shot.processor_seconds)
    rows = []
    for contender, ours, theirs in zip(contenders, wall, processor_time):
        ratios = [f"{np.median(np.divide(a[0], b)):.2f}" for a, b in ((wall, ours), (processor_time, theirs))]
        rows.append([contender.name, spread(ours), ratios[0], spread(theirs), ratios[1]])
    print(f"\nRate: {chosen.spp} samples per pixel, {chosen.rounds} rounds in turn; median (least–greatest).")
    per_second = "M paths per second"
    header = ["", per_second, "twinlight is × faster", "M paths per processor-second", "twinlight is × faster"]
    table(header, rows)
    return [float(np.median(ours)) * 1e6 for ours in wall]


def mean_error(contender, spp: int, sampler: str, reference: np.ndarray, chosen: argparse.Namespace) -> float:
    shots = (contender.render(spp, seed, sampler) for seed in range(chosen.seeds))
    return float(np.mean([rel_mse(shot.image, reference) for shot in shots]))


def print_samplers(ours: Twinlight, llvm: Mitsuba, reference: np.ndarray, noise: float, chosen) -> None:
    rows = []
    for spp in (1, 4, 16, 64):
        sobol, independent = (mean_error(ours, spp, sampler, reference, chosen) for sampler in ours.samplers)
        theirs = mean_error(llvm, spp, "independent", reference, chosen)
        row = [f"{sobol:.4g}", f"{independent:.4g}", f"{independent / sobol:.2f}", f"{theirs:.4g}"]
        rows.append([str(spp), *row])
    print(f"\nrelMSE by samples, mean of {chosen.seeds} seeds; the reference's own is {noise:.2g}.")
    header = ["samples per pixel", "Sobol–Owen", "independent", "independent / Sobol–Owen"]
    table([*header, "Mitsuba independent"], rows)


def print_error_over_time(contenders: list, rates: list[float], reference: np.ndarray, chosen) -> None:
    rows = []
    for contender, rate in zip(contenders, rates):
        row = [contender.name]
        for seconds in chosen.seconds:
            spp = max(round(rate * seconds / (SIZE * SIZE)), 1)
            shot = contender.render(spp, 0)
            row.append(f"{rel_mse(shot.image, reference):.4g} ({shot.seconds:.2f} s, {spp} spp)")
        rows.append(row)
    print("\nrelMSE over time, defaults of each: Sobol–Owen for twinlight, independent for Mitsuba.")
    table(["", *(f"{seconds:g} s" for seconds in chosen.seconds)], rows)


if __name__ == "__main__":
    sys.exit(main())
