#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds the Debian package build/touchdown_VERSION_ARCH.deb and has lintian look at it. The tree
# is build/deb.
#   ./deb.sh
set -euo pipefail

# shellcheck source=.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/.ci/setup.sh"
cd "$TOUCHDOWN_ROOT"

install_tiers build deb
# The times of files: two builds of the same sources give the same bytes.
SOURCE_DATE_EPOCH=$(dpkg-parsechangelog -l cmake/debian/changelog -S Timestamp)
export SOURCE_DATE_EPOCH
rm -f build/touchdown_*.deb
say "Building in build/deb"
cmake --workflow --preset deb

say "Looking at it with lintian"
# It is not uploaded to Debian, where a first version closes the request for it.
lintian --allow-root --fail-on error --suppress-tags initial-upload-closes-no-bugs build/touchdown_*.deb
echo
echo "Install it, as root: apt install ./$(echo build/touchdown_*.deb)"
