// SPDX-License-Identifier: BSD-3-Clause
// Random landing problems: what the solver backends are compared on.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "touchdown/estimation/pad_predictor.h"
#include "touchdown/planning/grid_search.h"
#include "touchdown/planning/landing_problem.h"
#include "touchdown/planning/occupancy_map.h"
#include "touchdown/sim/obstacle_field.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::evaluation {

/// How the problems are drawn.
struct CaseOptions {
  std::uint64_t seed = 1;
  std::string forest = "C";  ///< kind, see sim::ForestOfKind
  double inflation = 0.3;    ///< of the map [m]
  bool warm = false;         ///< the problem 0.1 s later, with the shifted previous solution
  planning::LandingProblemOptions problem;
};

/// One landing problem, complete: what SetBoundary, SetDuration and SetPairs are given.
struct LandingCase {
  int index = 0;
  planning::SplineState start;
  double t0 = 0.0;  ///< [s]
  std::shared_ptr<const estimation::PadPrediction> pad;
  planning::EndpointTarget target;
  double duration = 0.0;  ///< T, or the first guess of a free one [s]
  std::vector<planning::ObstaclePair> pairs;
  double pair_scale = 1.0;  ///< weight of the pairs, as the rounds raised it
  std::optional<planning::UniformBspline>
      warm;                ///< where the solve starts; none: the Hermite guess
  double pad_speed = 0.0;  ///< [m/s]
  double pad_rate = 0.0;   ///< [rad/s]
  int draws = 1;           ///< scenes drawn until one could be made clear ...
  int not_clear = 0;       ///< ... of those before: no clear curve within the limits was found
  int unsolved = 0;   ///< ... and: a solve of the making backend failed; the rest: out of reach
  int rounds = 0;     ///< of binding pairs, at this size
  bool clear = true;  ///< with these pairs, at this size; else they are those of the last round

  /// Sets the problem's parameters to this case. The case must outlive the solves.
  void Apply(planning::LandingProblem* problem) const;
  /// Where a solve of `problem`, to which the case was applied, starts.
  Eigen::VectorXd StartPoint(const planning::LandingProblem& problem) const;
};

/// Draws landing problems: a forest, a start and a moving, turning pad; then pairs by the planner's
/// own loop (solve, check the whole curve, search around what blocks it, bind, solve again; then
/// with a longer flight) until the curve is clear and keeps the full limits. Pairs are made with soft
/// limits, a fixed arrival and an eliminated endpoint, whatever the comparison solves later: the
/// problem does not depend on who solves it. A scene is taken if that succeeds, with one duration, at
/// each of kReferencePoints (a warm one: now and 0.1 s later), so that the same (seed, index) is the same scene for any number of
/// points; then pairs are bound at that number. A curve that they do not make clear there (with ten
/// points many are too stiff) is kept as it is, and counted.
class CaseMaker {
 public:
  static constexpr std::array kReferencePoints = {20, 40};

  /// Throws std::invalid_argument if an option is out of range or no backend can make pairs.
  CaseMaker(const CaseOptions& options, int points);

  /// Throws std::runtime_error if a hundred scenes in a row could not be made clear.
  LandingCase Make(int index);

  const std::string& backend() const { return references_.front()->backend->name(); }

 private:
  enum class Outcome { kClear, kNotClear, kUnsolved };
  using Curves = std::array<planning::UniformBspline, kReferencePoints.size()>;
  struct Scene;
  /// What pairs are bound with at one size.
  struct Binder {
    Binder(const CaseOptions& options, int points);

    planning::LandingProblem problem;
    planning::LandingProblem hard;  // the same with hard limits, to judge by
    solvers::ViewEvaluation limits;
    std::unique_ptr<solvers::SolverBackend> backend;
  };

  Scene DrawScene(int index, int draw) const;
  bool SetDuration(double duration, Scene* scene) const;
  Outcome StretchUntilClear(Scene* scene, LandingCase* made, Curves* curves);
  Outcome BindAtReferences(const Scene& scene, LandingCase* made, Curves* curves);
  Outcome BindUntilClear(const Scene& scene, Binder* binder, LandingCase* made,
                         planning::UniformBspline* curve);
  LandingCase Later(const Scene& scene, const LandingCase& first,
                    const planning::UniformBspline& solution, int draw) const;
  Outcome MakeOf(Scene* scene, int draw, LandingCase* made);

  CaseOptions options_;
  std::vector<std::unique_ptr<Binder>> references_;
  Binder binder_;
  planning::GridSearch search_;
};

}  // namespace touchdown::evaluation
