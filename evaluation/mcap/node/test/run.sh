#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Reads exports of flights by other people's libraries: run.sh FOLDER, where what the lock file names is installed. TOUCHDOWN_PROGRAM
# names the program.
set -eu
node=$(cd "$(dirname "$0")/.." && pwd)
rm -rf "$1/test" "$1/made"
mkdir -p "$1"
cp -r "$node/package.json" "$node/package-lock.json" "$node/schemas.mjs" "$node/test" "$1"
cd "$1"
if ! cmp -s package-lock.json installed.json; then
  npm ci --ignore-scripts --no-audit --no-fund
  cp package-lock.json installed.json
fi
node schemas.mjs "$node/../schemas" made
for file in made/*; do
  cmp "$file" "$node/../../data/mcap/$(basename "$file")" || {
    echo "data/mcap is not what mcap/node makes: run 'npm ci && npm run schemas' in evaluation/mcap/node" >&2
    exit 1
  }
done
TOUCHDOWN_SOURCE=$(cd "$node/../../.." && pwd) node --test test/export.test.mjs
