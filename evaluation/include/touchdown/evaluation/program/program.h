// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "touchdown/evaluation/base/shipped_files.h"
#include "touchdown/evaluation/scenario/registries.h"

namespace touchdown::evaluation {

/// The program `touchdown`. Results go to stdout, logs to stderr. Returns the exit status:
/// - 0: done. `land`: landed, and all requested files are written. `sweep`: every trial has an outcome, whichever.
/// - 1: ran but fell short. Examples: not landed; a picture or file that could not be made; a trial without an outcome
///   (`error`, `crashed`, `hung`); a study that misses a demand; derivatives that disagree (`check-term`); an internal
///   error.
/// - 2: bad usage or bad input. Nothing was run and nothing written.
/// - 128 + N: a sweep was interrupted by signal N (SIGINT, SIGTERM).
int RunProgram(int argc, const char* const* argv, const Registries& registries);

// find_package(touchdown) says so to programs that it links.
#ifdef TOUCHDOWN_SHARE_DIRECTORY
inline const bool kShareIsKnown = UseShare(TOUCHDOWN_SHARE_DIRECTORY);
#endif

}  // namespace touchdown::evaluation
