// SPDX-License-Identifier: BSD-3-Clause
// Figures of a recorded flight over time, and the messages of our own schemas that carry them (schemas/touchdown).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "evaluation/record/record_reader.h"
#include "evaluation/video/flight_track.h"
#include "sim/obstacles/true_clearance.h"
#include "touchdown/planning/replan/goal.h"

namespace touchdown::evaluation {

/// touchdown.Step. @param number of the step, from 0.
std::string StepMessage(int number, const RecordPlan& plan);

/// What `samples` of FlightTables tell, by their index.
class FlightFigures {
 public:
  /// `track` must outlive it. @throws std::invalid_argument naming the vehicle's file.
  FlightFigures(const RecordedFlight& flight, const FlightTrack& track,
                nlohmann::ordered_json samples);

  int count() const { return static_cast<int>(times_.size()); }
  double TimeOf(int sample) const { return times_[static_cast<std::size_t>(sample)]; }
  TrackSample At(int sample) const { return track_.At(TimeOf(sample)); }

  /// What was believed of the pad then; nullptr before anything was, and in the task go_to.
  const TrackBelief* PadBelief(int sample) const;

  /// Where the flight leads in the task go_to.
  const std::optional<planning::MovingGoal>& goal() const { return goal_; }

  /// touchdown.State.
  std::string StateMessage(int sample) const;

 private:
  double Number(const char* table, const char* column, int sample) const;
  Eigen::Vector3d Vector(const char* table, const char* x, const char* y, const char* z,
                         int sample) const;

  const FlightTrack& track_;
  nlohmann::ordered_json samples_;
  std::vector<double> times_;
  std::optional<sim::TrueClearance> clearance_;
  std::optional<planning::MovingGoal> goal_;
};

}  // namespace touchdown::evaluation
