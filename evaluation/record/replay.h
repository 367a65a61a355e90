// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "evaluation/record/record_reader.h"
#include "touchdown/evaluation/scenario/predictor_entry.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::evaluation {

/// Asks the replanning steps of a record again: the same options, the map as it was, the planner's state, the same
/// input. With the recorded scenario and the recording build the answers are the recorded ones bit for bit. The landing
/// planner gets its state from the record. Any other planner is asked all steps before, from the first hover on.
class Replay {
 public:
  /// `flight` and `registries` must outlive it. @throws BadInput if the scenario cannot be set up, or was flown by a
  /// planner not all of whose steps are recorded.
  Replay(const RecordedFlight& flight, const Registries& registries);

  /// That was sought last; -1: none.
  int step() const { return step_; }
  int steps() const { return static_cast<int>(flight_.plans.size()); }

  /// Brings the map, and the planner, to a step in [0, steps()).
  void Seek(int step);

  /// Asks the step that was sought. May be called again: every call starts from the recorded state.
  /// The result stays valid until the next call.
  const planning::ReplanResult& Solve();

  /// The prediction that the step was planned with; nullptr if the pad was not known. Valid until the next call of
  /// Seek, Solve or this.
  const estimation::PadPrediction* prediction();

  const RecordPlan& recorded() const { return flight_.plans[static_cast<std::size_t>(step_)]; }
  const planning::OccupancyMap& map() const { return map_; }
  /// The landing planner; nullptr: it is another one.
  planning::Replanner* replanner() { return replanner_; }

 private:
  void Rewind();
  const planning::ReplanResult& Ask();

  const RecordedFlight& flight_;
  const Registries& registries_;
  estimation::VehicleModel model_;
  std::unique_ptr<estimation::PadPredictor> predictor_;
  std::unique_ptr<planning::Planner> planner_;
  planning::Replanner* replanner_;
  planning::OccupancyMap map_;
  int step_ = -1;
  bool asked_ = false;  // the step, of a planner whose state cannot be set
};

}  // namespace touchdown::evaluation
