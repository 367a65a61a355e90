// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "touchdown/evaluation/study_plan.h"

namespace touchdown::evaluation {

/// Flies a planned study into a folder, which is made where it is missing: `study.json` (the plan),
/// `study.db` (every trial, see trial_table.h) and `records/CELL-METHOD.db`, the first trial of each
/// part that is to be recorded. What is there of the same plan is kept. Trials with a measured latency
/// are flown one at a time, whatever `jobs` says. @throws BadInput where the folder holds another study
void FlyStudy(const StudyPlan& plan, const std::string& folder, int jobs,
              const Registries& registries);

/// Where the files of a study are.
std::string StudyTablePath(const std::string& folder);

}  // namespace touchdown::evaluation
