#!/usr/bin/env python3
"""What layered hit buffers cost against triangles, directions, size, paths and bounces: Yu's tables 6.1 to 6.4; Markdown on stdout.

    python3 benchmarks/slhb_scaling.py [--scene builtin:room-70k] [--meshes SCENE...] [--allow-path FOLDER] [--rounds 5]

Seconds are medians over the rounds, in which all points take turns, with the least and the most. "growth" is the growth of the time over that of the
knob since the line above: 1 is linear.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path
from statistics import median

ROOT = Path(__file__).resolve().parent.parent


def measured(options, scene: str, step: str, flags: dict) -> tuple[float, dict]:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.exr"
        command = [options.twinlight, "render", scene, "--method", "slhb", "-o", out, "--backend", "cpu", "--progress", "never"]
        for name, value in flags.items():
            command += [f"--{name}", str(value)]
        for path in options.allow_path:
            command += ["--allow-path", path]
        subprocess.run(list(map(str, command)), check=True, capture_output=True)
        sidecar = json.loads(out.with_suffix(".json").read_text())
    return sidecar["seconds"][step], sidecar


def table(options, title: str, knob: str, step: str, points: list[tuple[str, float | None, str, dict]]) -> None:
    """Points are a label, the knob's value (None: triangles of the scene), a scene and flags."""
    times = [[] for _ in points]
    values = [value for _, value, _, _ in points]
    for _ in range(options.rounds):
        for i, (_, value, scene, flags) in enumerate(points):
            seconds, sidecar = measured(options, scene, step, flags)
            times[i].append(seconds)
            if value is None:
                values[i] = sidecar["scene"]["triangles"]
    print(f"\n{title}\n\n| {knob} | ms | | growth |\n|---|---|---|---|")
    before = None
    for (label, _, _, _), value, seconds in zip(points, values, times):
        middle = median(seconds)
        growth = "" if before is None else f"{middle / before[1] / (value / before[0]):.2f}"
        print(f"| {label or f'{value:,}'} | {middle * 1e3:.1f} | {min(seconds) * 1e3:.1f} to {max(seconds) * 1e3:.1f} | {growth} |", flush=True)
        before = value, middle


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", default="builtin:room-70k")
    parser.add_argument("--meshes", nargs="*", default=["builtin:cornell", "builtin:room-70k", "builtin:room-1m"])
    parser.add_argument("--allow-path", action="append", default=[], help="folders beside the scene's that it may read")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--twinlight", type=Path, default=ROOT / "target/release/twinlight")
    options = parser.parse_args()
    picture = {"size": "128x128", "spp": 1, "bounces": 1}
    build = {**picture, "size": "8x8"}
    room, set_ = options.scene, {"directions": 320, "lhb-size": 128}
    table(options, "Build against triangles (6.1), 320 directions, 128²", "triangles", "rasterize_lhb",
          [("", None, scene, {**build, **set_}) for scene in options.meshes])
    table(options, f"Build against directions (6.2), {room}, 128²", "directions", "rasterize_lhb",
          [("", n, room, {**build, "directions": n, "lhb-size": 128}) for n in (20, 80, 320, 1280)])
    table(options, f"Build against size (6.3), {room}, 320 directions", "pixels of a view", "rasterize_lhb",
          [(f"{n}²", n * n, room, {**build, "directions": 320, "lhb-size": n}) for n in (32, 64, 128, 256, 512)])
    table(options, f"Walk against paths (6.4), {room}, 128² pixels, two bounces", "paths per pixel", "walk_lhb",
          [("", n, room, {**picture, **set_, "spp": n, "bounces": 2}) for n in (4, 16, 64)])
    table(options, f"Walk against bounces (6.4), {room}, 128² pixels, 16 paths", "bounces", "walk_lhb",
          [("", n, room, {**picture, **set_, "spp": 16, "bounces": n}) for n in (1, 2, 3, 4, 5)])


if __name__ == "__main__":
    main()
