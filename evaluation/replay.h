// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "touchdown/evaluation/record_reader.h"
#include "touchdown/planning/replanner.h"
#include "touchdown/sim/pad_motion.h"

namespace touchdown::evaluation {

/// Asks the replanning steps of a record again: the same options, the map as it was, what the
/// replanner remembered, the same input. With the recorded scenario and the recording build the
/// answers are the recorded ones bit for bit.
class Replay {
 public:
  /// `flight` must outlive it. @throws BadInput if the scenario cannot be set up, or was flown by a
  /// planner whose steps are not recorded.
  Replay(const RecordedFlight& flight, const Registries& registries);

  int steps() const { return static_cast<int>(flight_.plans.size()); }

  /// Brings the map to a step in [0, steps()).
  void Seek(int step);

  /// Asks the step that was sought. May be called again: every call starts from the recorded state.
  /// The result stays valid until the next call.
  const planning::ReplanResult& Solve();

  /// The prediction that the step was planned with; nullptr for a rest. Valid until the next Seek.
  const estimation::PadPrediction* prediction() const;

  const RecordPlan& recorded() const { return flight_.plans[static_cast<std::size_t>(step_)]; }
  const planning::OccupancyMap& map() const { return map_; }
  planning::Replanner& replanner() { return replanner_; }

 private:
  const RecordedFlight& flight_;
  sim::OraclePadPrediction oracle_;
  planning::Replanner replanner_;
  planning::OccupancyMap map_;
  std::optional<estimation::BeliefPrediction> belief_;
  int step_ = -1;
};

}  // namespace touchdown::evaluation
