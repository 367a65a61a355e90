// SPDX-License-Identifier: BSD-3-Clause
// Why a flight ran out of time, in words: what stood in most of its steps, not only in the last one.
#pragma once

#include <string>
#include <string_view>

#include "evaluation/judge/trial_result.h"

namespace touchdown::evaluation {

/// Why there was no new plan. `last`: the reason of the last replanning step, empty if it made a plan. Begins with a
/// space; empty if every step made a plan.
std::string NoPlanSentence(const TrialResult& result, std::string_view last);

/// What the landing condition lacked. `last`: how it was at the end. Begins with a space; empty if it was always open,
/// or never asked for.
/// ' The vehicle knew no way: ...'; empty if it did not say so.
std::string NoWaySentence(const TrialResult& result);

std::string GateSentence(const TrialResult& result, std::string_view last);

}  // namespace touchdown::evaluation
