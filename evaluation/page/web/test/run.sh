#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Tests the replay page, and of the planner in a page what needs no module: run.sh FOLDER, where what the lock file names is
# installed and built. TOUCHDOWN_PROGRAM names the program.
set -eu
web=$(cd "$(dirname "$0")/.." && pwd)
rm -rf "$1/src" "$1/test" "$1/built"
mkdir -p "$1"
cp -r "$web/package.json" "$web/package-lock.json" "$web/bundle.mjs" "$web/build.mjs" "$web/src" "$web/test" "$1"
cd "$1"
if ! cmp -s package-lock.json installed.json; then
  npm ci --ignore-scripts --no-audit --no-fund
  cp package-lock.json installed.json
fi
node build.mjs built
for part in replay.js replay.css replay.html LICENCES.txt; do
  cmp "built/$part" "$web/../../data/replay/$part" || {
    echo "data/replay/$part is not what page/web makes: run 'npm ci && npm run build' in evaluation/page/web" >&2
    exit 1
  }
done
TOUCHDOWN_SHIPPED=$(realpath "$web/../../../docs/playground.html")
export TOUCHDOWN_SHIPPED
node --test test/parts.test.mjs test/playground_parts.test.mjs test/page.test.mjs test/shipped.test.mjs
