// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "evaluation/base/sqlite_db.h"
#include "evaluation/judge/trial_result.h"

namespace touchdown::evaluation {

/// A trial's result as values of the columns of the tables `trial` and `timing`, without the first, the trial's number,
/// and without its single replans. Reading them back gives the same result, with two exceptions. Numbers that are not
/// finite become NaN, and only landings have figures at touchdown.
struct TrialValues {
  std::vector<SqlValue> trial;
  std::vector<SqlValue> timing;
};
TrialValues ValuesOf(const TrialResult& result);
/// Without its replan times. @throws std::invalid_argument for values that are no trial's
TrialResult ResultOf(const TrialValues& values);

/// The tables of a file of trials, beside its manifest, in SQL.
std::string TrialSchema();

/// A whole result as bytes, for another process of the same program.
std::string PackResult(const TrialResult& result);
TrialResult UnpackResult(const std::string& bytes);

}  // namespace touchdown::evaluation
