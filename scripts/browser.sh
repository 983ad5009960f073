# Makes a headless Chromium available to this shell: the one that is installed, or Debian's chromium-headless-shell with the
# libraries that this machine lacks (unpacked under target/, not installed). To be sourced.
# Sets TWINLIGHT_BROWSER to the path of its binary. On systems without apt-get it says what to install and goes on.

twinlight_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# Prints the path of an installed Chromium.
twinlight_installed_browser() {
  local name
  for name in chromium-headless-shell chromium chromium-browser google-chrome google-chrome-stable; do
    command -v "$name" && return 0
  done
  return 1
}

# Fetches the package and what it depends on and this machine has not, and unpacks them into the current folder.
twinlight_unpack_browser() {
  local package packages
  # Without lists, or with old ones, the packages are not found.
  if [ "$(id -u)" = 0 ]; then apt-get update -qq; else sudo apt-get update -qq; fi || return 1
  packages=$(apt-get install -s -qq --no-install-recommends chromium-headless-shell | awk '$1 == "Inst" { print $2 }')
  [ -n "$packages" ] || return 1
  # One word each.
  # shellcheck disable=SC2086
  apt-get download -qq $packages || return 1
  for package in *.deb; do dpkg -x "$package" . || return 1; done
  rm -f ./*.deb
}

# Writes the start script: it finds the unpacked libraries, and the unpacked fonts where the machine has none.
twinlight_write_browser_start() {
  cat >"$1" <<'START'
#!/bin/sh
here=$(cd "$(dirname "$0")" && pwd)
libraries=$(echo "$here"/usr/lib/*-linux-gnu "$here"/usr/lib/*-linux-gnu/pulseaudio | tr ' ' ':')
export LD_LIBRARY_PATH="$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
[ -f /etc/fonts/fonts.conf ] || export FONTCONFIG_SYSROOT="$here"
exec "$here/usr/lib/chromium/chromium-headless-shell" "$@"
START
  chmod +x "$1"
}

# Prints the path of a Chromium, fetching and unpacking one where apt-get can.
twinlight_browser() {
  local folder="$twinlight_root/target/browser"
  [ -x "$folder/start" ] && { printf '%s' "$folder/start"; return 0; }
  twinlight_installed_browser && return 0
  command -v apt-get >/dev/null && command -v dpkg >/dev/null || return 1
  # The start script is written last: a folder without one is half unpacked.
  rm -rf "$folder" && mkdir -p "$folder"
  { (cd "$folder" && twinlight_unpack_browser) && twinlight_write_browser_start "$folder/start"; } >&2 || return 1
  printf '%s' "$folder/start"
}

# Callers may end at the first failure; what is missing is said below instead.
TWINLIGHT_BROWSER="${TWINLIGHT_BROWSER:-$(twinlight_browser)}" || true
if [ -n "$TWINLIGHT_BROWSER" ]; then
  export TWINLIGHT_BROWSER
else
  unset TWINLIGHT_BROWSER
  echo "twinlight: no headless Chromium: package chromium-headless-shell (Debian), chromium (Arch, Fedora)," >&2
  echo "  or name the binary in TWINLIGHT_BROWSER" >&2
fi
