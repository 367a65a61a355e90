#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# From a clean clone to a first landing: installs what is missing, builds program and libraries, flies the
# paper's case 1 and draws it. Writes out/landing.db, out/landing.html and out/landing.png.
set -euo pipefail

# shellcheck source=.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/.ci/setup.sh"
cd "$TOUCHDOWN_ROOT"

install_tiers build report
build_release OFF

say "Landing on a moving vehicle between buildings that are unknown at take-off"
mkdir -p out
build/release/bin/touchdown land straight_turn --record out/landing.db --html out/landing.html --plot out/landing.png
echo
echo "Look at it, in a browser: out/landing.html"
echo "Record: out/landing.db    Picture: out/landing.png"
echo "Next:   build/release/bin/touchdown --help"
