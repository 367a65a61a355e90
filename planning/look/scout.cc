// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/look/scout.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <limits>

#include "planning/certify/pad_strip.h"
#include "planning/look/lookout.h"

namespace touchdown::planning {
namespace {

constexpr double kPatience = 2.5;   // without progress [s]
constexpr double kNearer = 0.3;     // is progress [m]
constexpr double kAsksEvery = 0.5;  // [s]
constexpr double kGap = 1.0;        // without a step: what was before does not count [s]
constexpr double kAtGoal = 0.3;     // [m]
constexpr double kThere = 0.3, kTurnedTo = 0.2;  // of a viewpoint [m], [rad]
constexpr int kImages = 6;          // used without progress
constexpr int kLooks = 3;           // ... and from a viewpoint
constexpr double kEnough = 0.05;    // of the cells there may stay unseen
constexpr double kSlowest = 0.4;    // on the way there [m/s] ...
constexpr double kLonger = 5.0;     // ... and so much longer [s]

}  // namespace

class Scout::Impl {
 public:
  explicit Impl(const ReplannerOptions& options)
      : options_(options), lookout_(options.vertical_cost) {}

  std::optional<Viewpoint> Step(const ReplanInput& input, const std::vector<LookCamera>& cameras,
                                const OccupancyMap& map, bool may_look) {
    const double t = input.t_now;
    if (cameras.empty()) return std::nullopt;
    if (!was_.empty() && t > was_.back().t + kGap) Pause();
    if (look_ && !(may_look && StillLooks(input, cameras, map))) Pause();
    const int images = Images(cameras);
    const Eigen::Vector3d goal = Goal(input), at = input.vehicle.p_WB;
    was_.push_back({t, images, at, goal});
    if (look_) {
      while (was_.size() > 1 && was_[1].t <= t - kPatience) was_.pop_front();
      return look_->from;
    }
    while (was_.size() > 1 && IsLongAgo(was_[1], t, images)) was_.pop_front();
    if (!may_look || !IsLongAgo(was_.front(), t, images) || t < asked_t_ + kAsksEvery) {
      return std::nullopt;
    }
    asked_t_ = t;
    if ((goal - at).norm() < kAtGoal) return std::nullopt;
    FreeSpace space;
    space.map = &map;
    space.floor = options_.floor_height;
    space.ceiling = options_.ceiling_height;
    LayPadStrip(*input.pad, input.endpoint, at, input.t_start, input.t_start + options_.min_duration,
                options_.pad_radius, options_.contact_height, &space);
    if (Progresses(space, was_.front(), at, goal)) return std::nullopt;
    HullSpace hull;
    hull.space = &space;
    hull.hull_radius = options_.hull_radius;
    hull.margin = input.margins.Sum();
    hull.pad = input.pad->has_deck() ? input.pad : nullptr;
    hull.deck_half_size = options_.deck_half_size;
    hull.foot_depth = options_.contact_height;
    if (!lookout_.NoteNeeded(hull, at)) return std::nullopt;
    look_ = lookout_.Choose(hull, cameras, input.vehicle, input.pull_W, struck_);
    if (!look_) {
    if (getenv("LOOKDBG")) fprintf(stderr, "%.2f no place to look from, struck %zu\n", t, struck_.size());
      struck_.clear();
      return std::nullopt;
    }
    if (getenv("LOOKDBG")) fprintf(stderr, "%.2f look at %.2f %.2f %.2f -> %.2f %.2f %.2f yaw %.2f way %.2f sees %zu\n", t, at.x(), at.y(), at.z(), look_->from.p_WB.x(), look_->from.p_WB.y(), look_->from.p_WB.z(), look_->from.yaw, look_->way, look_->cells.size());
    was_.clear();
    was_.push_back({t, images, at, goal});
    until_ = t + look_->way / kSlowest + kLonger;
    images_at_ = std::numeric_limits<int>::max();
    return look_->from;
  }

  void Pause() {
    look_.reset();
    was_.clear();
  }

 private:
  struct Was {
    double t;
    int images;
    Eigen::Vector3d p_WB, goal_W;
  };

  /// Whether the vehicle is nearer to where the goal was then, or to where it is now.
  bool Progresses(const FreeSpace& space, const Was& was, const Eigen::Vector3d& at,
                  const Eigen::Vector3d& goal) {
    const auto nearer = [&](const Eigen::Vector3d& to) {
      const double then = lookout_.Length(space, was.p_WB, to);
      const double now = lookout_.Length(space, at, to);
      return !std::isfinite(now) || now < then - kNearer;
    };
    return ((goal - was.goal_W).norm() > kNearer && nearer(was.goal_W)) || nearer(goal);
  }

  static bool IsLongAgo(const Was& was, double t, int images) {
    return was.t <= t - kPatience && was.images <= images - kImages;
  }

  /// Where the vehicle wants to be in the end: a descent that pauses wants to go on.
  Eigen::Vector3d Goal(const ReplanInput& input) const {
    const double t = input.t_start + options_.min_duration;
    EndpointTarget end = input.endpoint;
    if (end.may_touch(options_.contact_height)) end.height = end.height_floor = options_.contact_height;
    return EndStateAt(*input.pad, end, t).state.p;
  }

  static int Images(const std::vector<LookCamera>& cameras) {
    int images = 0;
    for (const LookCamera& camera : cameras) images += camera.images;
    return images;
  }

  bool StillLooks(const ReplanInput& input, const std::vector<LookCamera>& cameras,
                  const OccupancyMap& map) {
    const auto unseen = std::count_if(look_->cells.begin(), look_->cells.end(), [&](const CellIndex& cell) {
      return !map.IsObservedFree(cell) && !map.IsOccupied(cell);
    });
    if (static_cast<double>(unseen) <= kEnough * static_cast<double>(look_->cells.size())) {
    if (getenv("LOOKDBG")) fprintf(stderr, "%.2f all seen\n", input.t_now);
      return false;
    }
    const Viewpoint& from = look_->from;
    const bool near = (input.vehicle.p_WB - from.p_WB).norm() < kThere;
    const bool there =
        near && std::abs(estimation::WrapAngle(estimation::Yaw(input.vehicle.q_WB) - from.yaw)) < kTurnedTo;
    const int images = Images(cameras);
    if (there) images_at_ = std::min(images_at_, images);
    const bool in_vain = images_at_ < std::numeric_limits<int>::max() && images >= images_at_ + kLooks;
    const bool stands = !near && was_.front().t <= input.t_now - kPatience &&
                        (was_.front().p_WB - input.vehicle.p_WB).norm() < kNearer;
    if (!in_vain && !stands && input.t_now < until_) return true;
    if (getenv("LOOKDBG")) fprintf(stderr, "%.2f struck %s, unseen %ld of %zu\n", input.t_now, in_vain ? "in vain" : stands ? "stands" : "late", static_cast<long>(unseen), look_->cells.size());
    struck_.push_back(from);
    return false;
  }

  ReplannerOptions options_;
  Lookout lookout_;
  std::deque<Was> was_;
  double asked_t_ = -std::numeric_limits<double>::infinity();
  std::optional<Look> look_;
  double until_ = 0.0;  // by when it is done [s]
  int images_at_ = 0;   // images before the first from there
  std::vector<Viewpoint> struck_;
};

Scout::Scout(const ReplannerOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Scout::~Scout() = default;

std::optional<Viewpoint> Scout::Step(const ReplanInput& input,
                                     const std::vector<LookCamera>& cameras,
                                     const OccupancyMap& map, bool may_look) {
  return impl_->Step(input, cameras, map, may_look);
}

}  // namespace touchdown::planning
