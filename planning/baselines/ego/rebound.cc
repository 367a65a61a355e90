// SPDX-License-Identifier: BSD-3-Clause
// Zhou et al. 2021, algorithm 2, with the limits and the order of events of the published system. A
// break takes effect before the next evaluation, so the next run starts at the last trial point.

#include "planning/baselines/ego/rebound.h"

#include <utility>

#include "planning/baselines/ego/ego_cost.h"

namespace touchdown::planning {

namespace {

constexpr int kQuietEvaluations = 4;  // of each run before it looks for obstacles: 0 to 3
constexpr double kSmooth = 0.1;  // smoothness per inner control point, below which it looks [m^2]

}  // namespace

Rebound::Rebound(const EgoOptions& options) : options_(options), search_(options) {}

EgoStatus Rebound::Run(const EgoGrid& grid, double interval, ControlPoints* q) {
  grid_ = &grid;
  interval_ = interval;
  q_ = *q;
  gradient_.setZero(3, q_.cols());
  pairs_.assign(static_cast<std::size_t>(q_.cols()), {});
  paths_.clear();
  counts_ = {};
  weight_collision_ = options_.weight_collision;
  lbfgs_.Prepare(3 * (static_cast<int>(q_.cols()) - 2 * kEgoDegree), options_.memory);
  EgoStatus status = EgoStatus::kPairLookupEmpty;
  if (BindPolygon()) status = RunOnce();
  *q = q_;
  return status;
}

EgoStatus Rebound::RunOnce() {
  solvers::LbfgsOptions lbfgs;
  lbfgs.gradient_tolerance = options_.rebound_tolerance;
  lbfgs.max_iterations = options_.max_iterations;
  const auto free = q_.middleCols(kEgoDegree, q_.cols() - 2 * kEgoDegree);
  for (;;) {
    break_ = Break::kNone;
    evaluations_ = 0;
    x_ = free.reshaped();
    const solvers::LbfgsResult run = lbfgs_.Minimize(lbfgs, this, &x_);
    ++counts_.runs;
    counts_.iterations += run.iterations;
    counts_.evaluations += run.evaluations;
    switch (run.status) {
      case solvers::LbfgsStatus::kCancelled:
        if (break_ == Break::kTerminal) return EgoStatus::kTerminalBlocked;
        if (break_ == Break::kEmptyPair) return EgoStatus::kPairLookupEmpty;
        if (++counts_.rebounds > options_.max_rebounds) {
          return BlockedStatus(EgoStatus::kReboundsUsedUp);
        }
        continue;
      case solvers::LbfgsStatus::kLineSearchFailed:
      case solvers::LbfgsStatus::kEvaluationFailed:
        return EgoStatus::kSolverFailed;
      case solvers::LbfgsStatus::kConverged:
      case solvers::LbfgsStatus::kAlreadyMinimized:
      case solvers::LbfgsStatus::kIterationLimit:
        break;
    }
    double t = 0.0;
    if (!FirstTwoThirdsBlocked(UniformBspline(q_, interval_, 0.0), *grid_, &t)) {
      return EgoStatus::kPlanned;
    }
    if (t <= interval_) return EgoStatus::kStartInObstacle;
    ++counts_.restarts;
    if (counts_.restarts >= options_.max_restarts) {
      return BlockedStatus(EgoStatus::kRestartsUsedUp);
    }
    if (!BindPolygon()) return EgoStatus::kPairLookupEmpty;
    weight_collision_ *= 2.0;
  }
}

EgoStatus Rebound::BlockedStatus(EgoStatus otherwise) const {
  return counts_.failed_searches > 0 ? EgoStatus::kSearchFailed : otherwise;
}

double Rebound::Evaluate(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
  const auto free = static_cast<int>(q_.cols()) - 2 * kEgoDegree;
  q_.middleCols(kEgoDegree, free).reshaped() = x;
  gradient_.setZero();
  double cost = 0.0;
  const double roughness = EgoSmoothness(q_, options_.weight_smoothness, &gradient_);
  cost += options_.weight_smoothness * roughness;
  ++evaluations_;
  if (evaluations_ > kQuietEvaluations && roughness / free < kSmooth) break_ = LookForObstacles();
  cost += weight_collision_ *
          EgoCollision(q_, pairs_, options_.clearance, weight_collision_, &gradient_);
  cost += options_.weight_feasibility * EgoFeasibility(q_, interval_, options_.max_speed,
                                                       options_.max_acceleration,
                                                       options_.weight_feasibility, &gradient_);
  *gradient = gradient_.middleCols(kEgoDegree, free).reshaped();
  return cost;
}

bool Rebound::Search(const CollisionSegment& segment, std::vector<Eigen::Vector3d>* path) {
  if (counts_.exhausted_searches > 0) {  // one of them takes as long as all others of a call
    ++counts_.failed_searches;
    return false;
  }
  ++counts_.searches;
  const EgoSearchStatus status =
      search_.Search(*grid_, q_.col(segment.in), q_.col(segment.out), path);
  if (status == EgoSearchStatus::kFound) {
    paths_.push_back(*path);
    return true;
  }
  ++counts_.failed_searches;
  if (status == EgoSearchStatus::kExpansionLimit) ++counts_.exhausted_searches;
  return false;
}

/// Pairs for every stretch of the polygon. If one search fails, no stretch gets pairs, as
/// published. False if a pair is looked up where there is none.
bool Rebound::BindPolygon() {
  segments_ = FindCollisionSegments(q_, *grid_);
  std::vector<std::vector<Eigen::Vector3d>> paths(segments_.size());
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    if (!Search(segments_[i], &paths[i])) return true;
  }
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    if (!BindSurfacePairs(q_, segments_[i], paths[i], *grid_, &pairs_)) return false;
  }
  return true;
}

/// Pairs for obstacles that no pair covers yet. A stretch whose search fails is left out.
Rebound::Break Rebound::LookForObstacles() {
  if (!FindNewObstacles(q_, *grid_, pairs_, &segments_)) return Break::kTerminal;
  std::vector<Eigen::Vector3d> path;
  for (const CollisionSegment& segment : segments_) {
    if (!Search(segment, &path)) continue;
    if (!BindSurfacePairs(q_, segment, path, *grid_, &pairs_)) return Break::kEmptyPair;
  }
  return segments_.empty() ? Break::kNone : Break::kRebound;
}

}  // namespace touchdown::planning
