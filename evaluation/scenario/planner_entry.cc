// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/scenario/planner_entry.h"

namespace touchdown::evaluation {

#define TOUCHDOWN_PLANNER(name) PlannerEntry name();
#include "evaluation/scenario/planners.def"
#undef TOUCHDOWN_PLANNER

std::vector<PlannerEntry> StandardPlanners() {
  return {
#define TOUCHDOWN_PLANNER(name) name(),
#include "evaluation/scenario/planners.def"
#undef TOUCHDOWN_PLANNER
  };
}

}  // namespace touchdown::evaluation
