// SPDX-License-Identifier: BSD-3-Clause
// The list of cost terms. A new one is one line here.

#include "touchdown/planning/term_registry.h"

#include "touchdown/planning/terms/arrival_time.h"
#include "touchdown/planning/terms/norm_limit.h"
#include "touchdown/planning/terms/obstacle_pair.h"
#include "touchdown/planning/terms/smoothness.h"

namespace touchdown::planning {

TermRegistry StandardTerms() {
  return {SmoothnessFactory(), ObstaclePairFactory(), SpeedLimitFactory(),
          AccelerationLimitFactory(), ArrivalTimeFactory()};
}

}  // namespace touchdown::planning
