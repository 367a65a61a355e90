// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "planning/baselines/ego/collision_segments.h"
#include "planning/baselines/ego/ego_options.h"
#include "planning/baselines/ego/ego_search.h"
#include "solvers/lbfgs/lbfgs.h"

namespace touchdown::planning {

/// What one rebound optimisation took.
struct ReboundCounts {
  int runs = 0;  ///< of L-BFGS
  int iterations = 0;
  int evaluations = 0;
  int searches = 0;            ///< A* calls
  int failed_searches = 0;     ///< of these, without a path, and those that were not begun
  int exhausted_searches = 0;  ///< of these, out of expansions: no other is begun after one
  int restarts = 0;
  int rebounds = 0;
};

/// The rebound optimisation (Zhou et al., algorithm 2): L-BFGS on smoothness, collision and feasibility. It is
/// interrupted for new {p, v} pairs whenever the nearly smooth polygon meets an obstacle without a pair. It starts again
/// with a doubled collision weight while the result is blocked.
/// The first and last three control points never move. One instance serves one thread.
class Rebound : private solvers::LbfgsFunction {
 public:
  explicit Rebound(const EgoOptions& options);

  /// Optimises *q (at least 7 control points) at a fixed interval. *q is the result, whatever the
  /// status. kPlanned: its first two thirds are free where they were sampled.
  EgoStatus Run(const EgoGrid& grid, double interval, ControlPoints* q);

  const ReboundCounts& counts() const { return counts_; }
  const SurfacePairs& pairs() const { return pairs_; }
  /// Paths of the last Run's searches, in W [m].
  const std::vector<std::vector<Eigen::Vector3d>>& paths() const { return paths_; }

 private:
  enum class Break { kNone, kRebound, kTerminal, kEmptyPair };

  double Evaluate(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) override;
  bool Cancelled() override { return break_ != Break::kNone; }
  EgoStatus RunOnce();
  bool BindPolygon();
  Break LookForObstacles();
  bool Search(const CollisionSegment& segment, std::vector<Eigen::Vector3d>* path);
  EgoStatus BlockedStatus(EgoStatus otherwise) const;

  EgoOptions options_;
  EgoSearch search_;
  solvers::Lbfgs lbfgs_;
  const EgoGrid* grid_ = nullptr;
  double interval_ = 0.0;
  double weight_collision_ = 0.0;
  ControlPoints q_, gradient_;
  Eigen::VectorXd x_;
  SurfacePairs pairs_;
  std::vector<CollisionSegment> segments_;
  std::vector<std::vector<Eigen::Vector3d>> paths_;
  int evaluations_ = 0;  // of this run of L-BFGS
  Break break_ = Break::kNone;
  ReboundCounts counts_;
};

}  // namespace touchdown::planning
