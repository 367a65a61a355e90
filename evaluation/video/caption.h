// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "evaluation/record/record_reader.h"
#include "evaluation/video/flight_track.h"
#include "sim/rendering/font.h"

namespace touchdown::evaluation {

/// The words below a picture of a flight: two lines, each from the left and from the right.
struct Caption {
  std::string flight;  ///< scenario, planner, seed
  std::string time;    ///< of the flight
  std::string state;  ///< mode and its reason, why there is no new plan, and the outcome in the end
  std::string distance;  ///< to the pad, or goal
};

/// @param now at the time of the picture. @param t_next time of the picture after it: events before it are shown [s].
/// @param target pad or goal.
Caption CaptionOf(const RecordedFlight& flight, const FlightTrack& track, const TrackSample& now,
                  double t_next, const Eigen::Vector3d& target_W);

/// As much of the text, from its beginning, as this width has room for [pixel].
std::string Fitting(const std::string& text, int width, const sim::Font& font);

/// The step whose curve is flown at `t`, the last that has taken over; nullptr: none yet.
const RecordPlan* PlanAt(const std::vector<RecordPlan>& plans, double t);

}  // namespace touchdown::evaluation
