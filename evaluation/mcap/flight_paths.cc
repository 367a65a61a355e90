// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/mcap/flight_paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "evaluation/mcap/flight_scene.h"

namespace touchdown::evaluation {
namespace {

constexpr double kPoseSpacing = 0.1;  // [s]
constexpr double kTrail = 60.0;       // so much of the way flown is shown [s]
constexpr double kThickness = 0.03;   // [m]

}  // namespace

Poses PlanPoses(const RecordPlan& plan) {
  constexpr double kStanding = 1e-3;  // [m/s]
  const planning::UniformBspline& curve = plan.result.curve;
  std::vector<double> times;
  for (double t = std::max(plan.request.input.t_now, curve.t0()); t < curve.t_end();
       t += kPoseSpacing) {
    times.push_back(t);
  }
  if (!times.empty()) times.push_back(curve.t_end());
  Poses poses;
  Eigen::Quaterniond heading = Eigen::Quaterniond::Identity();
  for (const double t : times) {
    const planning::FlatState state = curve.Evaluate(t);
    if (state.v_WB.norm() > kStanding) {
      heading = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), state.v_WB);
    }
    poses.push_back(PoseOf(state.p_WB, heading));
  }
  return poses;
}

Poses FlownPoses(const FlightTrack& track, double t) {
  Poses poses;
  const int last = static_cast<int>(std::floor(t / kPoseSpacing + 1e-6));
  const int most = static_cast<int>(std::lround(kTrail / kPoseSpacing));
  for (int i = std::max(0, last - most); i <= last; ++i) {
    const estimation::VehicleState vehicle = track.At(i * kPoseSpacing).vehicle;
    poses.push_back(PoseOf(vehicle.p_WB, vehicle.q_WB));
  }
  return poses;
}

Places BeliefEllipse(const estimation::PadState& belief) {
  constexpr int kCorners = 36;
  constexpr double kSigmas = 3.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(belief.cov_p);
  const Eigen::Vector2d sigmas = axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  Places places;
  for (int i = 0; i < kCorners; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / kCorners;
    const Eigen::Vector2d along(std::cos(turn), std::sin(turn));
    Eigen::Vector3d p = belief.p_WP;
    p.head<2>() += kSigmas * (axes.eigenvectors() * sigmas.cwiseProduct(along));
    places.push_back(p);
  }
  return places;
}

Places PlacesOf(const Poses& poses) {
  Places places;
  for (const Eigen::Isometry3d& pose : poses) places.emplace_back(pose.translation());
  return places;
}

std::string LineUpdate(double t, const std::string& name, const Places& places_W,
                       const Color& color, bool closed) {
  SceneEntity entity(t, kWorldFrame, name);
  entity.AddLine(places_W, kThickness, color, closed);
  return SceneUpdate({entity});
}

std::string PointUpdate(double t, const Places& places_W, const Color& color) {
  CloudPoints points;
  for (const Eigen::Vector3d& p : places_W) points.push_back({p, color});
  return PointCloud(t, kWorldFrame, points);
}

}  // namespace touchdown::evaluation
