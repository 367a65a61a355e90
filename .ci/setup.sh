# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
# Sourced by the scripts at the top and in .ci/: installs what is missing and builds.

TOUCHDOWN_ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
export TOUCHDOWN_ROOT

say() { printf '\n== %s\n' "$*"; }

# Whether the check of packages.txt holds: is_there KIND WHAT.
is_there() {
  case $1 in
    command) command -v "$2" >/dev/null 2>&1 ;;
    file) compgen -G "$2" >/dev/null ;;
    python) /usr/bin/python3 -c "import $2" >/dev/null 2>&1 ;;
    *) echo "packages.txt: unknown check '$1'" >&2 && exit 2 ;;
  esac
}

# Prints the packages of a tier whose check fails.
missing_packages() {
  local wanted=$1 tier='' package kind what
  while read -r package kind what; do
    case $package in
      '' | '#'*) ;;
      '['*']') tier=${package:1:-1} ;;
      *) if [ "$tier" = "$wanted" ] && ! is_there "$kind" "$what"; then echo "$package"; fi ;;
    esac
  done <"$TOUCHDOWN_ROOT/packages.txt"
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null 2>&1; then
    sudo "$@"
  else
    echo "Run as root or install sudo; needed: $*" >&2
    exit 1
  fi
}

# Installs what is missing of the given tiers. If nothing is missing, no network is used.
install_tiers() {
  local tier missing=()
  for tier in "$@"; do
    mapfile -t -O "${#missing[@]}" missing < <(missing_packages "$tier")
  done
  if [ "${#missing[@]}" -eq 0 ]; then return; fi
  say "Installing: ${missing[*]}"
  as_root apt-get update -q
  as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -q -y --no-install-recommends "${missing[@]}"
}

# Configures build/release with the given options and builds the given targets (none: all). demo.sh
# and test.sh share the tree, so neither builds again what the other has built.
build_release() {
  local tests=$1
  shift
  say "Building in build/release"
  (cd "$TOUCHDOWN_ROOT" && cmake --preset release -DTOUCHDOWN_BUILD_TESTS="$tests" >/dev/null)
  # A first compilation has no separate preprocessing.
  CCACHE_DEPEND=1 cmake --build "$TOUCHDOWN_ROOT/build/release" -j2 ${1:+--target "$@"}
}
