// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation/program/commands.h"

namespace touchdown::evaluation {

/// Adds `study hostile`.
void AddHostileStudyCommand(Command study, const Registries& registries, CommandRun* run);

}  // namespace touchdown::evaluation
