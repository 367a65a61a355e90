#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds everything and runs the whole test suite: C++ and Python.
set -euo pipefail

# shellcheck source=.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/.ci/setup.sh"
cd "$TOUCHDOWN_ROOT"

install_tiers build report study notebooks test
build_release ON

say "Testing"
ctest --test-dir build/release --output-on-failure -j2
