// SPDX-License-Identifier: BSD-3-Clause
// The whole flight is known, so the camera's way is planned. At key times, views from all around are given a cost:
// hidden, too near to an obstacle, far away, not from behind. Dynamic programming finds the cheapest way from view to
// view. Between the keys it is smoothed from both sides, so that nothing lags.

#include "evaluation/video/chase_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "touchdown/estimation/base/vehicle_state.h"

namespace touchdown::evaluation {
namespace {

constexpr double kKeyTime = 0.25;  // between key times [s]
constexpr int kAzimuths = 24;      // of the line of sight, all around
constexpr std::array<double, 4> kElevations = {0.30, 0.50, 0.80, 1.15};  // above the focus [rad]
constexpr std::array<double, 4> kDistances = {3.3, 4.4, 6.2, 9.0};       // to the focus [m]
constexpr std::size_t kViews = kAzimuths * kElevations.size() * kDistances.size();
constexpr double kFocusShare = 0.45;  // of the way from vehicle to target ...
constexpr double kMaxFocus = 1.3;     // ... at most [m]
constexpr double kVehicleSize = 0.3;  // of a part that may be hidden alone [m]
constexpr double kTargetSize = 0.6;   // [m]
constexpr double kFloor = 0.6;        // least height of the camera [m]
constexpr double kClearance = 0.7;    // of the camera to obstacles, wanted [m]
constexpr double kSmoothTime =
    0.45;  // standard deviation of the smoothing, of directions and distances [s] ...
constexpr double kFocusTime = 0.15;  // ... and of the focus, which must not fall behind [s]
constexpr double kSettle = 1.5;  // distance to the target below which no direction is behind [m]

constexpr double kPi = std::numbers::pi;

struct View {
  double azimuth = 0.0;    // of the line of sight in W [rad]
  double elevation = 0.0;  // of the camera above the focus [rad]
  double distance = 0.0;   // to the focus [m]
};

View ViewOf(std::size_t index) {
  View view;
  view.azimuth = 2.0 * kPi * static_cast<double>(index % kAzimuths) / kAzimuths;
  view.elevation = kElevations[index / kAzimuths % kElevations.size()];
  view.distance = kDistances[index / kAzimuths / kElevations.size()];
  return view;
}

Eigen::Vector3d FocusOf(const ChaseSubject& subject) {
  const Eigen::Vector3d way = subject.target_W - subject.vehicle_W;
  return subject.vehicle_W + std::min(kFocusShare, kMaxFocus / std::max(way.norm(), 1e-9)) * way;
}

Eigen::Vector3d SightOf(const View& view) {
  const double level = std::cos(view.elevation);
  return {level * std::cos(view.azimuth), level * std::sin(view.azimuth),
          -std::sin(view.elevation)};
}

class Chase {
 public:
  Chase(const sim::ObstacleField& obstacles, const estimation::CameraIntrinsics& camera,
        const ChaseFrame& frame)
      : obstacles_(obstacles), camera_(camera), frame_(frame) {}

  // With the focus in the middle of the frame.
  sim::CameraPose PoseOf(const Eigen::Vector3d& focus, const View& view) const {
    const Eigen::Vector3d sight = SightOf(view);
    const Eigen::Vector3d right = sight.cross(Eigen::Vector3d::UnitZ()).normalized();
    Eigen::Matrix3d toward;
    toward << right, sight.cross(right), sight;
    const double u = 0.5 * (frame_.left + frame_.right) - 0.5;
    const double v = 0.5 * (frame_.top + frame_.bottom) - 0.5;
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(-std::atan(u * camera_.width / camera_.focal),
                           Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(std::atan(v * camera_.height / camera_.focal), Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    sim::CameraPose pose;
    pose.R_WC = toward * turn;
    pose.p_WC = focus - view.distance * sight;
    return pose;
  }

  // @param ahead direction to the target. @param behind how much it matters, in [0, 1].
  double CostOf(const ChaseSubject& subject, const View& view, double ahead, double behind) const {
    const sim::CameraPose pose = PoseOf(FocusOf(subject), view);
    const Eigen::Vector3d& p = pose.p_WC;
    double cost = 0.4 * view.distance + 1.5 * std::abs(view.elevation - kElevations[1]);
    cost += 2.0 * behind * (1.0 - std::cos(view.azimuth - ahead));
    cost += 40.0 * std::max(0.0, kClearance - obstacles_.SignedDistance(p));
    cost += 40.0 * std::max(0.0, kFloor - p.z());
    cost += 30.0 * Missing(pose, subject.vehicle_W, kVehicleSize);
    cost += 5.0 * Missing(pose, subject.target_W, kTargetSize);
    return cost;
  }

 private:
  bool Holds(const sim::CameraPose& pose, const Eigen::Vector3d& p_W) const {
    const Eigen::Vector3d p = pose.R_WC.transpose() * (p_W - pose.p_WC);
    if (p.z() < 0.5) return false;
    const double u = (camera_.cx + camera_.focal * p.x() / p.z()) / camera_.width;
    const double v = (camera_.cy + camera_.focal * p.y() / p.z()) / camera_.height;
    return u > frame_.left && u < frame_.right && v > frame_.top && v < frame_.bottom;
  }

  // The share of a thing that is out of the frame or hidden, by its middle and its ends on both sides.
  double Missing(const sim::CameraPose& pose, const Eigen::Vector3d& p_W, double size) const {
    int missing = 0;
    for (const double side : {-1.0, 0.0, 1.0}) {
      const Eigen::Vector3d part = p_W + side * size * pose.R_WC.col(0);
      const bool hidden = obstacles_.RayDistance(pose.p_WC, part - pose.p_WC) < 1.0;
      if (hidden || !Holds(pose, part)) ++missing;
    }
    return missing / 3.0;
  }

  const sim::ObstacleField& obstacles_;
  estimation::CameraIntrinsics camera_;
  ChaseFrame frame_;
};

// The cost of going from one view to another within kKeyTime.
double MoveCost(const View& a, const View& b) {
  const double turn = estimation::WrapAngle(b.azimuth - a.azimuth);
  const double climb = b.elevation - a.elevation;
  const double away = std::log(b.distance / a.distance);
  return 12.0 * turn * turn + 12.0 * climb * climb + 20.0 * away * away;
}

// The views at the key times, the cheapest in all; azimuths without jumps.
std::vector<View> PlanViews(const std::vector<ChaseSubject>& keys, const Chase& chase) {
  std::vector<double> move;  // from a view to a view
  for (std::size_t i = 0; i < kViews; ++i) {
    for (std::size_t j = 0; j < kViews; ++j) move.push_back(MoveCost(ViewOf(j), ViewOf(i)));
  }
  std::vector<std::vector<std::size_t>> from(keys.size(), std::vector<std::size_t>(kViews));
  std::vector<double> best(kViews, 0.0);
  double ahead = 0.0;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const Eigen::Vector2d way = (keys[k].target_W - keys[k].vehicle_W).head<2>();
    const double behind = std::min(1.0, way.norm() / kSettle);
    if (way.norm() > 0.0) ahead = std::atan2(way.y(), way.x());
    const std::vector<double> before = best;
    for (std::size_t i = 0; i < kViews; ++i) {
      double least = k == 0 ? 0.0 : std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; k > 0 && j < kViews; ++j) {
        const double cost = before[j] + move[i * kViews + j];
        if (cost < least) {
          least = cost;
          from[k][i] = j;
        }
      }
      best[i] = least + chase.CostOf(keys[k], ViewOf(i), ahead, behind);
    }
  }
  std::vector<View> chosen(keys.size());
  auto at = static_cast<std::size_t>(std::min_element(best.begin(), best.end()) - best.begin());
  for (std::size_t k = keys.size(); k-- > 0;) {
    chosen[k] = ViewOf(at);
    at = from[k][at];
  }
  for (std::size_t k = 1; k < chosen.size(); ++k) {
    const double before = chosen[k - 1].azimuth;
    chosen[k].azimuth = before + estimation::WrapAngle(chosen[k].azimuth - before);
  }
  return chosen;
}

// Each becomes the mean of its neighbourhood. Beyond the ends it is continued, so that the ends do not lag.
template <typename Vector>
std::vector<Vector> Smoothed(const std::vector<Vector>& rows, double time, double dt) {
  const int reach = static_cast<int>(3.0 * time / dt);
  std::vector<Vector> smooth;
  const int last = static_cast<int>(rows.size()) - 1;
  const auto at = [&](int i) -> Vector {
    const auto row = [&](int k) -> const Vector& {
      return rows[static_cast<std::size_t>(std::clamp(k, 0, last))];
    };
    if (i < 0) return 2.0 * row(0) - row(-i);
    if (i > last) return 2.0 * row(last) - row(2 * last - i);
    return row(i);
  };
  for (int i = 0; i <= last; ++i) {
    Vector sum = Vector::Zero();
    double weights = 0.0;
    for (int k = -reach; k <= reach; ++k) {
      const double x = k * dt / time;
      const double weight = std::exp(-0.5 * x * x);
      sum += weight * at(i + k);
      weights += weight;
    }
    smooth.push_back(sum / weights);
  }
  return smooth;
}

}  // namespace

std::vector<sim::CameraPose> ChaseFlight(const std::vector<ChaseSubject>& subjects, double dt,
                                         const sim::ObstacleField& obstacles,
                                         const estimation::CameraIntrinsics& camera,
                                         const ChaseFrame& frame) {
  if (subjects.empty()) return {};
  const Chase chase(obstacles, camera, frame);
  const auto step = static_cast<std::size_t>(std::max(1.0, std::round(kKeyTime / dt)));
  std::vector<ChaseSubject> keys;
  for (std::size_t i = 0; i < subjects.size(); i += step) keys.push_back(subjects[i]);
  const std::vector<View> views = PlanViews(keys, chase);

  std::vector<Eigen::Vector3d> between, focuses;  // azimuth, elevation, distance; focus
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    const std::size_t k = i / step;
    const View& a = views[k];
    const View& b = views[std::min(k + 1, views.size() - 1)];
    const double s = static_cast<double>(i % step) / static_cast<double>(step);
    between.emplace_back(a.azimuth + s * (b.azimuth - a.azimuth),
                         a.elevation + s * (b.elevation - a.elevation),
                         a.distance + s * (b.distance - a.distance));
    focuses.push_back(FocusOf(subjects[i]));
  }
  between = Smoothed(between, kSmoothTime, dt);
  focuses = Smoothed(focuses, kFocusTime, dt);
  std::vector<sim::CameraPose> poses;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    poses.push_back(chase.PoseOf(focuses[i], {between[i].x(), between[i].y(), between[i].z()}));
  }
  return poses;
}

}  // namespace touchdown::evaluation
