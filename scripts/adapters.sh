# Makes the two software Vulkan adapters of the conformance suite available to this shell: Mesa's lavapipe, and the
# SwiftShader that Debian ships in chromium-common (unpacked under target/, not installed). To be sourced.
# Sets VK_DRIVER_FILES. On systems without apt-get it says what to install and goes on with what there is.

twinlight_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

twinlight_as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

twinlight_apt_updated=""
twinlight_apt_update() {
  [ -n "$twinlight_apt_updated" ] && return 0
  twinlight_as_root apt-get update -qq && twinlight_apt_updated=1
}

# Prints the driver manifest of lavapipe, installing it where apt-get can.
twinlight_lavapipe() {
  local found
  found=$(ls /usr/share/vulkan/icd.d/lvp_icd*.json 2>/dev/null | head -n 1)
  if { [ -z "$found" ] || ! ldconfig -p | grep -q libvulkan.so.1; } && command -v apt-get >/dev/null; then
    { twinlight_apt_update && twinlight_as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends mesa-vulkan-drivers libvulkan1; } >&2
    found=$(ls /usr/share/vulkan/icd.d/lvp_icd*.json 2>/dev/null | head -n 1)
  fi
  printf '%s' "$found"
}

# Prints the driver manifest of SwiftShader, fetching and unpacking it where apt-get can.
twinlight_swiftshader() {
  local folder="$twinlight_root/target/swiftshader" manifest
  manifest="$folder/usr/lib/chromium/vk_swiftshader_icd.json"
  if [ ! -f "$manifest" ] && command -v apt-get >/dev/null && command -v dpkg >/dev/null; then
    mkdir -p "$folder"
    { twinlight_apt_update && cd "$folder" && apt-get download -qq chromium-common && dpkg -x chromium-common_*.deb . \
        && rm -f chromium-common_*.deb; } >&2 || true
  fi
  [ -f "$manifest" ] && printf '%s' "$manifest"
}

# Callers may end at the first failure; what is missing is said below instead.
twinlight_lvp=$(twinlight_lavapipe) || true
twinlight_ss=$(twinlight_swiftshader) || true
twinlight_missing=""
[ -z "$twinlight_lvp" ] && twinlight_missing="lavapipe"
[ -z "$twinlight_ss" ] && twinlight_missing="$twinlight_missing SwiftShader"
if [ -n "$twinlight_missing" ]; then
  echo "twinlight: software adapters missing:" $twinlight_missing >&2
  echo "  lavapipe: package mesa-vulkan-drivers (Debian, Ubuntu), vulkan-swrast (Arch), mesa-vulkan-drivers (Fedora)" >&2
  echo "  SwiftShader: libvk_swiftshader.so and vk_swiftshader_icd.json of any Chromium; name the manifest in VK_DRIVER_FILES" >&2
fi
# Mesa asks for a runtime folder and writes an error per device without one.
if [ -z "${XDG_RUNTIME_DIR:-}" ]; then
  export XDG_RUNTIME_DIR="$twinlight_root/target/run"
  mkdir -p "$XDG_RUNTIME_DIR" && chmod 700 "$XDG_RUNTIME_DIR"
fi
if [ -n "$twinlight_lvp$twinlight_ss" ]; then
  export VK_DRIVER_FILES="$twinlight_lvp${twinlight_lvp:+${twinlight_ss:+:}}$twinlight_ss${VK_DRIVER_FILES:+:$VK_DRIVER_FILES}"
fi
