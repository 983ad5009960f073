#!/usr/bin/env bash
# Fails when a dependency declares a newer Rust than this workspace does. (Uses of newer std items are clippy's
# incompatible_msrv.)
set -euo pipefail
cd "$(dirname "$0")/.."
cargo metadata --format-version 1 --locked | python3 -c '
import json, sys
packages = json.load(sys.stdin)["packages"]
number = lambda v: tuple(int(x) for x in (v + ".0.0").split(".")[:3])
ours = max(number(p["rust_version"]) for p in packages if p["name"] == "twinlight")
late = [(p["name"], p["rust_version"]) for p in packages if p["rust_version"] and number(p["rust_version"]) > ours]
for name, version in sorted(late):
    print(f"{name} needs Rust {version}")
sys.exit(1 if late else print("ok: nothing needs more than Rust", ".".join(map(str, ours))) or 0)
'
