// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation/program/commands.h"

namespace touchdown::evaluation {

/// Adds `study run FILE` and a short form of it for each shipped study: `study paper`, ...
void AddStudyRunCommands(Command study, const Registries& registries, CommandRun* run);

}  // namespace touchdown::evaluation
