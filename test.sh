#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds everything and runs the whole test suite: C++ and Python.
#   ./test.sh           the suite
#   ./test.sh quick     the unit tests: minutes, for who changes the code
#   ./test.sh deep      sanitizers, another compiler, clang-tidy, fuzzers: two hours; parts by name: address, tidy, threads, fuzz
#   ./test.sh fuzz      files, measurements, maps as nobody would write them, 60 s of each kind: fuzz [SECONDS] [TARGET...]
#   ./test.sh inputs    broken files and command lines through the program: inputs [--count N] [KIND...]; inputs largest
#   ./test.sh wasm      the planner in a page: build/wasm/playground.html, and its tests; needs 0.8 GB more
#   ./test.sh bare      the Debian package in a bare Debian 12, the source in a bare Debian 12 and 13; parts by name: deb, source
#   ./test.sh mutants   whether the tests notice changes of what must be right: an hour
set -euo pipefail

# shellcheck source=.ci/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/.ci/setup.sh"
cd "$TOUCHDOWN_ROOT"

selection=()
case ${1:-} in
  '') ;;
  quick) selection=(-L unit -LE 'python|docs') ;;
  deep) exec .ci/deep "${@:2}" ;;
  fuzz) exec .ci/fuzz "${@:2}" ;;
  inputs)
    install_tiers build
    build_release OFF touchdown
    if [ "${2:-}" = largest ]; then exec .ci/largest_inputs.py "${@:3}"; fi
    exec .ci/mutated_inputs.py "${@:2}"
    ;;
  wasm)
    install_tiers build report test page wasm
    exec .ci/wasm
    ;;
  bare) exec .ci/bare "${@:2}" ;;
  mutants)
    install_tiers build test
    exec .ci/mutants.py "${@:2}"
    ;;
  *)
    echo "./test.sh $1: there is ./test.sh, and with it quick, deep, fuzz, inputs, wasm, bare and mutants." >&2
    exit 2
    ;;
esac

install_tiers build report study python notebooks video page test
build_release ON

say "Testing"
ctest --test-dir build/release --output-on-failure -j2 "${selection[@]}"
