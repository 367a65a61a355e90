// SPDX-License-Identifier: BSD-3-Clause
// The cost of a flight, sample by sample, for a profile; and the input of its pad filter.
#pragma once

#include <string>
#include <vector>

#include "evaluation/flight/pad_log.h"
#include "evaluation/flight/perception.h"
#include "touchdown/planning/replan/replan_result.h"

namespace touchdown::evaluation {

/// One replanning step.
struct ReplanSample {
  double t_now = 0.0;  ///< [s]
  planning::ReplanStatus status = planning::ReplanStatus::kHolding;
  planning::ReplanReason reason = planning::ReplanReason::kNone;
  bool from_odometry = false;
  int pairs = 0;
  int solves = 0;
  int rebinds = 0;
  int iterations = 0;  ///< of the last solve
  int work = 0;        ///< of planning.max_work
  planning::StageTimes times;
  std::string forbidden_by;  ///< the term or limit that forbade a plan, if one did
};

/// One depth image.
struct FrameSample {
  double t = 0.0;  ///< [s]
  FrameTimes times;
};

/// All of it from one flight.
struct TrialSamples {
  std::vector<ReplanSample> replans;
  std::vector<FrameSample> frames;
  PadLog pad;
};

/// `t_now`: when the step was asked for [s].
inline ReplanSample SampleOf(double t_now, const planning::ReplanResult& result,
                             const planning::StageTimes& times) {
  const std::string forbidden_by(result.forbidden_by);
  return {t_now,        result.status, result.reason,  result.from_odometry,
          result.pairs, result.solves, result.rebinds, result.solver.iterations,
          result.work,  times,         forbidden_by};
}

}  // namespace touchdown::evaluation
