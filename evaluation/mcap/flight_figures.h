// SPDX-License-Identifier: BSD-3-Clause
// Figures of a recorded flight over time, and the messages of our own schemas that carry them (schemas/touchdown).
#pragma once

#include <optional>
#include <string>

#include "evaluation/record/record_reader.h"
#include "evaluation/video/flight_track.h"
#include "sim/obstacles/true_clearance.h"
#include "touchdown/planning/replan/goal.h"

namespace touchdown::evaluation {

/// touchdown.Step. @param number of the step, from 0.
std::string StepMessage(int number, const RecordPlan& plan);

/// What a FlightTrack tells, by the index of its samples.
class FlightFigures {
 public:
  /// `track` must outlive it. @throws std::invalid_argument naming the vehicle's file.
  FlightFigures(const RecordedFlight& flight, const FlightTrack& track);

  int count() const { return static_cast<int>(track_.samples().size()); }
  double TimeOf(int sample) const { return At(sample).vehicle.t; }
  const TrackSample& At(int sample) const {
    return track_.samples()[static_cast<std::size_t>(sample)];
  }

  /// The estimated pad then; nullptr before there was an estimate, and in the task go_to.
  const TrackBelief* PadBelief(int sample) const;

  /// Where the flight leads in the task go_to.
  const std::optional<planning::MovingGoal>& goal() const { return goal_; }

  /// touchdown.State.
  std::string StateMessage(int sample) const;

 private:
  const FlightTrack& track_;
  std::optional<sim::TrueClearance> clearance_;
  std::optional<planning::MovingGoal> goal_;
};

}  // namespace touchdown::evaluation
