// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>

#include "touchdown/planning/certify/stored_stop.h"
#include "touchdown/planning/replan/attempt_ladder.h"
#include "touchdown/planning/replan/planner.h"
#include "touchdown/planning/replan/replan_log.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::planning {

/// All that a replanner remembers from one step to the next. Plain data: with the same options, map
/// and input the next step gives the same bits.
struct ReplannerState {
  FlightPair current;             ///< flown before `next` takes over
  FlightPair next;                ///< committed
  bool planned = false;           ///< `next` is a plan to the pad: its arrival is kept ...
  bool around_unseen = false;     ///< ... and it led around cells that were not seen
  BoundParts bound;               ///< what of it is bound to free space
  double looked_t = 0.0;          ///< when other ways were last looked for [s]
  std::optional<double> asked_t;  ///< when the last answer took over [s]
  std::optional<Attempt>
      unfinished;  ///< at which the last step, without a plan, ran out of its budget
  std::optional<double> climb;                ///< `next` is the caller's rest with this climb [m]
  std::optional<double>
      strip_t;  ///< when the strip over the pad was last known [s], and the strip:
  Eigen::Vector2d strip_from = Eigen::Vector2d::Zero();  ///< in W [m]
  Eigen::Vector2d strip_to = Eigen::Vector2d::Zero();    ///< in W [m]
  double strip_floor = 0.0;                              ///< in W [m]
};

/// Plans, re-plans and holds the committed trajectory (docs/replanning.md). One instance
/// per vehicle; not thread-safe; different instances are independent.
class Replanner : public Planner {
 public:
  /// Throws std::invalid_argument if an option is out of range, or if the backend is unknown or
  /// cannot do what the options ask. The sentence says which.
  Replanner(const ReplannerOptions& options, const solvers::BackendRegistry& backends);
  ~Replanner() override;
  Replanner(const Replanner&) = delete;
  Replanner& operator=(const Replanner&) = delete;

  void Prepare(const OccupancyMap& map) override;

  /// The vehicle hovers at p_W from t on: the first committed trajectory.
  void CommitHover(const Eigen::Vector3d& p_W, double t) override;

  /// Does not allocate.
  void CommitStop(const FlatState& from, double t) override;

  /// One replanning step against the map. The result stays valid until the next call. Throws std::invalid_argument
  /// before the first CommitHover. The result is a proven flight pair, or says that it is not (docs/safety.md). Nothing can
  /// be proven in cells that the map has not observed. So a map that was filled by hand needs MarkFree, one of a
  /// sensor at least around the start.
  const ReplanResult& Replan(const ReplanInput& input, const OccupancyMap& map) override;

  /// Comes to rest and stays because there is no pad to go to. It flies a certified braking trajectory, or with
  /// `climb` > 0 [m] one that ends that much higher. Once begun, it is kept. `input.pad`, nullptr where nothing is
  /// known of it, is the deck that it may start above. `input.endpoint` says whether a contact is still wanted.
  const ReplanResult& Rest(const ReplanInput& input, double climb,
                           const OccupancyMap& map) override;

  void TakeOverAt(double t) override;

  /// The committed reference at time t (yaw fields zero). The plan made by Replan takes over at its
  /// t_start; before that the older one is flown. Does not allocate.
  FlatState Reference(double t) const override;

  const ReplannerOptions& options() const;

  /// What the next step depends on, besides its arguments: it changes with the step. And the way back to it, which
  /// allocates.
  const ReplannerState& state() const;
  void Restore(const ReplannerState& state);

  /// The following steps are logged in `log` (cleared at each); nullptr ends it. It must outlive
  /// the steps. Allocates in the steps; their decisions stay the same.
  void set_log(ReplanLog* log);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::planning
