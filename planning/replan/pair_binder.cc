// SPDX-License-Identifier: BSD-3-Clause
// The curve and the guide past an obstacle pass it on different sides; otherwise the curve would be
// free. A place on the guide is moved towards the curve until the obstacle is near. So its
// half-spaces belong to this obstacle even where the guide keeps far off.

#include "planning/replan/pair_binder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "planning/map/voxel_traversal.h"

namespace touchdown::planning {

namespace {

constexpr char kPairTerm[] = "obstacle_pair";
constexpr int kFirstFree = 3;          // control points that both boundaries fix
constexpr int kLevels = 2;             // pairs of a control point for floor and ceiling
constexpr double kFloorMargin = 0.05;  // kept from floor and ceiling [m]

/// s_f of the term obstacle_pair.
double PairClearance(const Formulation& formulation) {
  for (const TermEntry& entry : formulation.terms) {
    if (entry.info.name != kPairTerm) continue;
    TermSetup setup = DefaultSetup(entry, PairBinder::kMostControlPoints);
    for (const TermSettings& settings : formulation.settings) {
      if (settings.name == kPairTerm) ApplySettings(entry, settings, &setup);
    }
    return setup.Get("clearance");
  }
  return 0.0;
}

/// From a free point on a guide towards the curve, until an obstacle is near. The guide's point if
/// nothing is between.
Eigen::Vector3d BesideObstacle(const FreeSpace& space, const Eigen::Vector3d& guide,
                               const Eigen::Vector3d& curve, double stand_off) {
  const double length = (curve - guide).norm();
  if (!(length > stand_off)) return guide;
  const Eigen::Vector3d ahead = (curve - guide) / length;
  double hit = 0.0;
  const bool free =
      TraverseCells(guide, curve, space.map->resolution(), [&](const CellIndex& cell) {
        hit = std::clamp((space.map->CentreOf(cell) - guide).dot(ahead), 0.0, length);
        return !space.Blocked(cell);
      });
  return free ? guide : Eigen::Vector3d(guide + std::max(0.0, hit - stand_off) * ahead);
}

/// Walks along a polyline at constant speed.
class PathWalk {
 public:
  explicit PathWalk(const GuidePath& path) : path_(path), length_(PathLength(path)) {}
  /// At this share of the length; shares must not fall from call to call.
  Eigen::Vector3d At(double share) {
    while (next_ + 1 < path_.size() && before_ + Side() < share * length_)
      before_ += Side(), ++next_;
    if (path_.size() == 1) return path_.front();
    const double side = Side();
    const double along =
        side > 0.0 ? std::clamp((share * length_ - before_) / side, 0.0, 1.0) : 0.0;
    return path_[next_ - 1] + along * (path_[next_] - path_[next_ - 1]);
  }

 private:
  double Side() const { return (path_[next_] - path_[next_ - 1]).norm(); }

  const GuidePath& path_;
  double length_;
  double before_ = 0.0;   // length before the present side
  std::size_t next_ = 1;  // its end
};

/// When the curve is nearest to a control point.
double TimeOf(const UniformBspline& curve, int control_point) {
  return curve.t0() + (control_point - 1) * curve.interval();
}

}  // namespace

PairBinder::PairBinder(const Formulation& formulation, const StepConstants& constants)
    : constants_(constants),
      corridor_(PairClearance(formulation), kFloorMargin),
      planes_(formulation.max_pairs_per_point - kLevels),
      per_point_(formulation.max_pairs_per_point) {
  if (per_point_ < kLevels) {
    throw std::invalid_argument("PairBinder: max_pairs_per_point is " + std::to_string(per_point_) +
                                ", it must be >= 2, for floor and ceiling");
  }
  bound_.reserve(kMostControlPoints);
  corners_.reserve(kMostControlPoints);
}

void PairBinder::Begin(int control_points) {
  if (control_points > kMostControlPoints) {
    throw std::invalid_argument("PairBinder: control_points is " + std::to_string(control_points) +
                                ", it must be <= " + std::to_string(kMostControlPoints));
  }
  bound_.assign(static_cast<std::size_t>(control_points), false);
}

void PairBinder::Start(const UniformBspline& curve) {
  for (std::size_t i = 0; i < bound_.size(); ++i) {
    reference_[i] = curve.Position(TimeOf(curve, static_cast<int>(i)));
  }
  corners_.clear();
}

void PairBinder::Remember(const UniformBspline& curve, BoundParts* parts) const {
  parts->clear();
  const double half = 0.5 * curve.interval();
  bool inside = false;
  for (std::size_t i = 0; i < bound_.size(); ++i) {
    const double t = TimeOf(curve, static_cast<int>(i));
    if (bound_[i] && !inside) parts->push_back({t - half, t + half});
    if (bound_[i]) parts->back().to = t + half;
    inside = bound_[i];
  }
  for (const Corner& corner : corners_) {
    const double t = curve.t0() + corner.place * curve.interval();
    if (parts->size() < kMostControlPoints) parts->push_back({t, t});
  }
}

void PairBinder::Lead(const TimedPath& way, const BoundParts& more) {
  const int n = static_cast<int>(bound_.size());
  const double interval = (way.t_end() - way.t0()) / (n - kFirstFree);
  const auto time_of = [&](int i) { return way.t0() + (i - 1) * interval; };
  const auto bind = [&](double from, double to) {
    for (int i = kFirstFree; i < n - kFirstFree; ++i) {
      bound_[i] |= time_of(i) >= from && time_of(i) <= to;
    }
  };
  for (int i = 0; i < n; ++i) reference_[i] = way.At(time_of(i));
  corners_.clear();
  const double beside = constants_.bound_beside * interval;
  for (const BoundPart& part : way.bound()) bind(part.from - beside, part.to + beside);
  for (const BoundPart& part : more) {
    const double from = way.TimeOf(part.from), to = way.TimeOf(part.to);
    if (part.from < part.to) {
      bind(from, to);
    } else if (from >= way.t0() && from <= way.t_end()) {
      BindCorner((from - way.t0()) / interval, way.At(from));
    }
  }
}

/// @param place on the curve [intervals].
void PairBinder::BindCorner(double place, const Eigen::Vector3d& p) {
  corners_.push_back({place, static_cast<int>(place) + 1, p});
}

void PairBinder::Follow(const UniformBspline& curve, const BlockedRun& run, const GuidePath& guide,
                        const FreeSpace& space) {
  PathWalk walk(guide);
  const double margin = constants_.bound_beside * curve.interval();
  const int n = static_cast<int>(bound_.size());
  for (int i = kFirstFree; i < n - kFirstFree; ++i) {
    const double t = TimeOf(curve, i);
    if (t < run.t_in - margin || t > run.t_out + margin) continue;
    bound_[i] = true;
    if (t < run.t_in || t > run.t_out) continue;
    const Eigen::Vector3d guided = walk.At((t - run.t_in) / (run.t_out - run.t_in));
    reference_[i] = BesideObstacle(space, guided, reference_[i], constants_.stand_off);
  }
}

void PairBinder::AddCorner(const UniformBspline& curve, const BlockedRun& run,
                           const GuidePath& guide, const FreeSpace& space) {
  const double t = 0.5 * (run.t_in + run.t_out);
  const Eigen::Vector3d p =
      BesideObstacle(space, PathWalk(guide).At(0.5), curve.Position(t), constants_.stand_off);
  BindCorner((t - curve.t0()) / curve.interval(), p);
}

void PairBinder::Bind(const FreeSpace& space, std::vector<ObstaclePair>* pairs) {
  pairs->clear();
  const int n = static_cast<int>(bound_.size());
  for (int i = kFirstFree; i < n - kFirstFree; ++i) {
    if (!bound_[i]) continue;
    corridor_.Bind(i, reference_[i], space, static_cast<std::size_t>(planes_), pairs);
  }
  const auto most = static_cast<std::size_t>(n) * static_cast<std::size_t>(per_point_);
  for (const Corner& corner : corners_) {
    for (const int i : {corner.before, corner.before + 1}) {
      if (i < kFirstFree || i >= n - kFirstFree) continue;
      if (pairs->size() + 1 + kLevels > most) return;
      corridor_.Bind(i, corner.p, space, planes_ > 0 ? 1 : 0, pairs);
    }
  }
}

}  // namespace touchdown::planning
