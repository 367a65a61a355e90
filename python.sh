#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, and the Python package `touchdown` into an environment of your own, which is made if it is
# not there, with a kernel for notebooks. Compiles for some minutes; the tree is build/pip.
#   ./python.sh my_env
set -euo pipefail

# shellcheck source=.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/.ci/setup.sh"
environment=$(realpath -m "${1:?"./python.sh FOLDER: the environment, as my_env"}")
cd "$TOUCHDOWN_ROOT"

install_tiers build report study python notebooks
[ -x "$environment/bin/python" ] || /usr/bin/python3 -m venv --system-site-packages "$environment"

say "Installing the package touchdown into $environment"
"$environment/bin/pip" install --no-build-isolation --no-index .
# Notebooks ask for the kernel python3, which is else that of /usr/bin/python3. The variable: no words about its debugger.
PYDEVD_DISABLE_FILE_VALIDATION=1 "$environment/bin/python" -m ipykernel install --sys-prefix >/dev/null
echo
echo "Try it: $environment/bin/python -c \"import touchdown; print(touchdown.run_trial('open').outcome)\""
echo "Or run a notebook: $environment/bin/python notebooks/render.py notebooks/06_my_own_planner.ipynb out/planner.html"
