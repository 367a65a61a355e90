// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/problem/step_constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace touchdown::planning {

std::span<const StepConstant> StepConstantTable() {
  using C = StepConstants;
  static constexpr std::array kTable = {
      StepConstant{"heuristic_weight", &C::heuristic_weight, "",
                   "weight of the estimate in the search for a path", 1.0},
      StepConstant{"tight_cost", &C::tight_cost, "m/m", "cost of a metre next to an obstacle", 1.0},
      StepConstant{
          "detour_longer", &C::detour_longer, "m",
          "a detour of the committed curve is longer than the straight line by this at most"},
      StepConstant{"hold_beside_time", &C::hold_beside_time, "s",
                   "time that the curve must stay beside the path before the detour ends"},
      StepConstant{"path_cost_ratio", &C::path_cost_ratio, "m/m",
                   "search another path up to this multiple of the first path's cost", 1.0},
      StepConstant{"side_change_ratio", &C::side_change_ratio, "",
                   "a plan on the other side must cost less than this share"},
      StepConstant{"near_obstacle", &C::near_obstacle, "segments",
                   "until an obstacle that needs fine segments at once"},
      StepConstant{"fine_segments", &C::fine_segments, "", "share of the longest segment"},
      StepConstant{"bound_beside", &C::bound_beside, "control points",
                   "bound on each side of a blocked stretch"},
      StepConstant{"stand_off", &C::stand_off, "m",
                   "distance of a reference point from the obstacle"},
      StepConstant{"pair_growth", &C::pair_growth, "", "of the pairs' weight from round to round",
                   1.0},
      StepConstant{"blocked_share_left", &C::blocked_share_left, "",
                   "share of the blocked time that a round leaves at most"},
      StepConstant{"limit_growth", &C::limit_growth, "",
                   "of the weight of soft limits that are exceeded", 1.0},
      StepConstant{"limit_far", &C::limit_far, "",
                   "of a limit, beyond which that weight grows by the square", 1.0},
      StepConstant{"limit_rounds", &C::limit_rounds, "solves",
                   "with a larger weight of the exceeded limits"},
      StepConstant{"look_every", &C::look_every, "s", "between two searches for alternatives"},
      StepConstant{"kept_latest", &C::kept_latest, "",
                   "of the time left, after which a kept plan may not arrive", 1.0},
      StepConstant{"retime_below", &C::retime_below, "",
                   "a new guess below this share of the time left replaces the committed arrival"},
      StepConstant{"near_contact", &C::near_contact, "s",
                   "last part of a plan to contact that is planned anew at every step"},
      StepConstant{"stretch", &C::stretch, "", "of the duration after an attempt that failed", 1.0},
      StepConstant{"end_step", &C::end_step, "", "of the duration while the plan's end is blocked",
                   1.0},
      StepConstant{"grid_longest", &C::grid_longest, "",
                   "longest arrival that segments are made for, over the first one", 1.0},
      StepConstant{"unseen_reach", &C::unseen_reach, "m",
                   "distance around the start in which unobserved cells are blocked"},
      StepConstant{"unseen_least", &C::unseen_least, "m", "the same in the last try at rest"},
  };
  return kTable;
}

double ValueOf(const StepConstants& constants, const StepConstant& which) {
  return std::visit([&](auto member) { return static_cast<double>(constants.*member); },
                    which.value);
}

StepConstants Scaled(const StepConstants& constants, const StepConstant& which, double factor) {
  if (!(factor > 0.0) || !std::isfinite(factor)) {
    throw std::invalid_argument("Scaled: factor is " + std::to_string(factor) +
                                ", it must be positive and finite");
  }
  StepConstants changed = constants;
  if (const auto* real = std::get_if<double StepConstants::*>(&which.value)) {
    double& value = changed.*(*real);
    value = which.least + factor * (value - which.least);
    return changed;
  }
  int& count = changed.*std::get<int StepConstants::*>(which.value);
  const int rounded = static_cast<int>(std::lround(count * factor));
  const int step = factor < 1.0 ? -1 : factor > 1.0 ? 1 : 0;
  count = std::max(1, rounded == count ? count + step : rounded);
  return changed;
}

}  // namespace touchdown::planning
