#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Tests the planner in a page: run_playground.sh FOLDER MODULE.js MODULE.wasm, where what the lock file names is installed
# and the page is put together.
set -eu
web=$(cd "$(dirname "$0")/.." && pwd)
glue=$(realpath "$2")
wasm=$(realpath "$3")
rm -rf "$1/src" "$1/test"
mkdir -p "$1"
cp -r "$web/package.json" "$web/package-lock.json" "$web/bundle.mjs" "$web/playground.mjs" "$web/src" "$web/test" "$1"
cd "$1"
if ! cmp -s package-lock.json installed.json; then
  npm ci --ignore-scripts --no-audit --no-fund
  cp package-lock.json installed.json
fi
TOUCHDOWN_PLAYGROUND=$PWD/playground.html
export TOUCHDOWN_PLAYGROUND
node playground.mjs "$glue" "$wasm" "$TOUCHDOWN_PLAYGROUND"
node --test test/playground_parts.test.mjs test/playground.test.mjs
