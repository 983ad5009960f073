"""Measures the builtin scenes that `render --budget` chooses by where a scene has no table of its own, and writes what it needs of them.

python benchmarks/shipped_costs.py --twinlight target/release/twinlight [--time-limit 150] [--out cli/src/budget/shipped.json]

On an idle machine: times are compared with each other, and with those of the machine that chooses by a look at builtin:cornell.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

# Few triangles and many; half of the light indirect, and nearly all of it; lobes, glass and a sky.
SCENES = ("builtin:cornell", "builtin:room-70k", "builtin:room-1m", "builtin:environment")
KEYS = ("relmse", "flip")


def measured(twinlight: str, scene: str, seconds: float) -> dict:
    with tempfile.TemporaryDirectory() as folder:
        command = [twinlight, "cost", scene, "--bounces", "4", "--size", "128x128", "--backend", "cpu"]
        subprocess.run([*command, "--time-limit", str(seconds), "--out", folder], check=True)
        return json.loads((Path(folder) / "cost.json").read_text())


def needed(cost: dict) -> dict:
    def digits(x: float) -> float:
        return float(f"{x:.4g}")

    def point(point: dict) -> dict:
        return {
            "method": point["method"],
            "settings": point["settings"],
            "seconds": {"median": digits(point["seconds"]["median"])},
            "steps": [{"name": step["name"], "seconds": digits(step["seconds"])} for step in point["steps"]],
            "errors": {key: digits(point["errors"][key]) for key in KEYS},
        }

    return {key: cost[key] for key in ("twinlight", "scene", "size", "bounces", "backend", "look")} | {
        "points": [point(p) for p in cost["points"] if all(p["errors"][key] is not None for key in KEYS)]
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--twinlight", required=True)
    parser.add_argument("--time-limit", type=float, default=150)
    parser.add_argument("--out", type=Path, default=Path("cli/src/budget/shipped.json"))
    options = parser.parse_args()
    tables = [needed(measured(options.twinlight, scene, options.time_limit)) for scene in SCENES]
    lines = ",\n".join(json.dumps(table, separators=(",", ":")) for table in tables)
    options.out.write_text(f"[\n{lines}\n]\n")


if __name__ == "__main__":
    main()
