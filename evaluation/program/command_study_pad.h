// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation/program/commands.h"

namespace touchdown::evaluation {

/// Adds `pad` to the command `study`; when it is chosen, sets `run` to what returns the exit
/// status. `registries` must outlive it.
void AddPadStudyCommand(Command study, const Registries& registries, CommandRun* run);

}  // namespace touchdown::evaluation
