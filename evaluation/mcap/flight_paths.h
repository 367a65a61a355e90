// SPDX-License-Identifier: BSD-3-Clause
// The curves of a flight that are drawn, as poses or places in W, and as messages.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "evaluation/mcap/message_parts.h"
#include "evaluation/record/record_reader.h"
#include "evaluation/video/flight_track.h"

namespace touchdown::evaluation {

using Poses = std::vector<Eigen::Isometry3d>;
using Places = std::vector<Eigen::Vector3d>;

/// The committed curve of a step from then to its end, every 0.1 s, each pose heading where it leads.
Poses PlanPoses(const RecordPlan& plan);

/// Where the vehicle truly was, every 0.1 s of the last minute.
Poses FlownPoses(const FlightTrack& track, double t);

/// Three standard deviations of the pad's place, around it.
Places BeliefEllipse(const estimation::PadState& belief);

Places PlacesOf(const Poses& poses);

/// foxglove.SceneUpdate and foxglove.PointCloud of a curve in W.
std::string LineUpdate(double t, const std::string& name, const Places& places_W,
                       const Color& color, bool closed);
std::string PointUpdate(double t, const Places& places_W, const Color& color);

}  // namespace touchdown::evaluation
