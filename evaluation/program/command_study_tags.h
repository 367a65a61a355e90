// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation/program/commands.h"

namespace touchdown::evaluation {

/// Adds `tags` to the command `study`; when it is chosen, sets `run` to what returns the exit
/// status.
void AddTagStudyCommand(Command study, CommandRun* run);

}  // namespace touchdown::evaluation
