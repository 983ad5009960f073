#!/usr/bin/env bash
# Renders every scene file of this folder whose models are under MODELS: render.sh MODELS OUT [SPP]
set -euo pipefail
models=$(cd "$1" && pwd); mkdir -p "$2"; out=$(cd "$2" && pwd); spp=${3:-64}
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
cargo build --release --quiet --manifest-path "$root/Cargo.toml" -p twinlight-cli
gathered=$(mktemp -d)
trap 'rm -rf "$gathered"' EXIT
for file in "$here"/*.toml; do
  name=$(basename "$file" .toml)
  cp "$file" "$gathered/"
  present=yes
  for model in $(sed -n 's/^path = "\(.*\)"/\1/p' "$file"); do
    folder=${model%%/*}
    if [ -d "$models/$folder" ]; then cp -rn "$models/$folder" "$gathered/"; else present=no; fi
  done
  if [ $present = no ]; then echo "skipped $name: its models are not under $models"; continue; fi
  "$root/target/release/twinlight" render "$gathered/$name.toml" --spp "$spp" --progress never -o "$out/$name.png" -o "$out/$name.exr"
done
