// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/campaign/recorded_trials.h"
#include "evaluation/campaign/study_plan.h"

namespace touchdown::evaluation {

/// Flies a planned study into a folder, which is made if it is missing:
/// - `study.db`: every trial (campaign.h).
/// - `study.json`: the plan and how it was flown.
/// - `records/CELL-METHOD.db`: the first trial of the parts that are recorded.
/// - `records/trial_N.db`: the trials that `which` names. Each record has its page beside it (recorded_trials.h).
/// Trials that are there already are kept. A shard goes to a file of its own, StudyTablePath, and writes nothing else.
/// `options.db` is set here. @throws as RunCampaign does
CampaignResult FlyStudy(const StudyPlan& plan, const std::string& folder, CampaignOptions options,
                        Recorded which, const Registries& registries);

/// The plan in a study's folder, of 4 MiB at most. @throws BadInput
nlohmann::ordered_json ReadStudyPlan(const std::string& folder);

/// Where the trials of a study are.
std::string StudyTablePath(const std::string& folder, const Shard& shard = {});

}  // namespace touchdown::evaluation
