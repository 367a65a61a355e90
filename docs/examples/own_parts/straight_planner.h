// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "touchdown/planning/replan/planner.h"
#include "touchdown/planning/spline/limits.h"

namespace own {

using namespace touchdown::planning;  // NOLINT: an example

/// A planner that is as short as possible: the quintic from the vehicle to where the pad will be, or to contact with
/// it. It ignores obstacles. Nothing is certified.
class StraightPlanner : public Planner {
 public:
  explicit StraightPlanner(const Limits& limits) : limits_(limits) {}

  void CommitHover(const Eigen::Vector3d& p_W, double t) override;
  const ReplanResult& Replan(const ReplanInput& input, const OccupancyMap& map) override;
  const ReplanResult& Rest(const ReplanInput& input, double climb,
                           const OccupancyMap& map) override;
  void TakeOverAt(double t) override { takes_over_ = result_.committed ? t : takes_over_; }
  FlatState Reference(double t) const override;

 private:
  const ReplanResult& Commit(UniformBspline curve, ReplanStatus status, ReplanReason reason);
  SplineState StartAt(double t) const;

  Limits limits_;
  UniformBspline current_, next_;
  double takes_over_ = 0.0;      // next_ does [s]
  std::optional<double> climb_;  // of the rest under way [m]
  bool touches_ = false;         // the plan under way ends in contact
  ReplanResult result_;
};

}  // namespace own
