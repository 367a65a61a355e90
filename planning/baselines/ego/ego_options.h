// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::planning {

/// Parameters of the EGO-Planner baseline with the published system's defaults (X. Zhou, Z. Wang,
/// H. Ye, C. Xu, F. Gao, "EGO-Planner", RA-L 6(2), 2021, and its released configuration).
struct EgoOptions {
  double max_speed = 2.0;         ///< of each axis [m/s]
  double max_acceleration = 3.0;  ///< of each axis [m/s^2]

  double horizon = 7.5;                 ///< distance of the local target [m]
  double control_point_distance = 0.4;  ///< d_cp: nominal spacing of control points [m]
  double clearance = 0.5;               ///< s_f: wanted from the inflated surface along v [m]
  double limit_tolerance = 0.05;        ///< share beyond a limit that still counts as feasible

  double weight_smoothness = 1.0;   ///< of the squared third differences [1/m^2]
  double weight_collision = 0.5;    ///< doubled at each restart
  double weight_feasibility = 0.1;  ///< of squared excesses over limits
  double weight_fitness = 1.0;      ///< of the refinement's distance to the stretched curve

  double rebound_tolerance = 0.01;  ///< stop test of L-BFGS, |g| / max(1, |x|): rebound ...
  double refine_tolerance = 0.001;  ///< ... and refinement
  int memory = 16;                  ///< of L-BFGS
  int max_iterations = 200;         ///< of each L-BFGS run
  int max_restarts = 3;             ///< runs whose result still hits an obstacle
  int max_rebounds = 20;            ///< runs broken off for a new obstacle, and one more

  double search_step = 0.1;        ///< lattice of A* [m]
  int search_cells = 100;          ///< its extent along each axis, centred between the two ends
  int search_expansions = 200000;  ///< in place of the published limit of 0.2 s

  double replan_distance = 1.5;     ///< no replanning nearer than this to the plan's start [m]
  double no_replan_distance = 2.0;  ///< nor nearer than this to the goal [m]
  double emergency_time = 1.0;      ///< a hit sooner than this stops the vehicle [s]
};

/// Throws std::invalid_argument naming the first option out of its range.
void Validate(const EgoOptions& options);

/// How a plan call ended. What crashes or never returns in the published code has a name here.
enum class EgoStatus {
  kPlanned,          ///< there is a new trajectory
  kInvalidInput,     ///< a number of the request is not finite
  kCloseToGoal,      ///< the local target is nearer than 0.2 m: counts as a failure
  kOutsideMap,       ///< the start lies outside the map (published: memory out of range)
  kNoInitialPath,    ///< no sampling of the first guess suits (published: an endless loop)
  kStartInObstacle,  ///< the curve is blocked within its first knot interval
  kTerminalBlocked,  ///< the blocked stretch reaches the end of the polygon
  kSearchFailed,     ///< still blocked, and A* found no way around an obstacle
  kRestartsUsedUp,   ///< still blocked after every restart
  kReboundsUsedUp,   ///< still meeting new obstacles after every rebound
  kPairLookupEmpty,  ///< a control point shall copy a pair that its neighbour does not have
                     ///< (published: memory out of range)
  kSolverFailed,     ///< a line search of L-BFGS gave up
  kRefinementHit,    ///< the refined curve is blocked
};
const char* ToString(EgoStatus status);
/// One sentence for people.
const char* Explain(EgoStatus status);

}  // namespace touchdown::planning
