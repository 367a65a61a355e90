#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, and the Python package `touchdown` into an environment of your own, which is made if it is
# not there. Compiles for some minutes; the tree is build/pip.
#   ./python.sh my_env
set -euo pipefail

# shellcheck source=.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/.ci/setup.sh"
environment=$(realpath -m "${1:?"./python.sh FOLDER: the environment, as my_env"}")
cd "$TOUCHDOWN_ROOT"

install_tiers build report python
[ -x "$environment/bin/python" ] || /usr/bin/python3 -m venv --system-site-packages "$environment"

say "Installing the package touchdown into $environment"
"$environment/bin/pip" install --no-build-isolation --no-index .
echo
echo "Try it: $environment/bin/python -c \"import touchdown; print(touchdown.run_trial('open').outcome)\""
