// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <utility>

#include <Eigen/Core>

#include "touchdown/solvers/backend/evaluator.h"
#include "touchdown/solvers/backend/gap_rule.h"
#include "touchdown/solvers/backend/optimality.h"
#include "touchdown/solvers/backend/solver_options.h"
#include "touchdown/solvers/backend/solver_result.h"
#include "touchdown/solvers/backend/stop.h"
#include "touchdown/solvers/problem/view.h"
#include "touchdown/solvers/problem/view_structure.h"

namespace touchdown::solvers {

/// What a backend can take. `compiled` false: it was left out at configure time.
struct Capabilities {
  bool compiled = true;
  bool hard_rows = false;        ///< inequality constraint rows
  bool equality_rows = false;    ///< equality constraint rows
  bool variable_bounds = false;  ///< bounds on blocks (Problem::SetBounds)
  bool free_interval = true;     ///< a free knot interval
  bool needs_residuals = false;  ///< takes only costs that are sums of squares
};

/// A requested solve, before it is made. Valid during the call of a listener.
struct SolveRequest {
  const View& view;
  const WarmStart& start;
  const Stop& stop;
};
using SolveListener = std::function<void(const SolveRequest&)>;

/// A solver behind one interface. Everything that does not differ between backends happens once,
/// here: checks, timing, counting, best-point tracking. A backend writes DoPrepare and DoSolve.
/// An instance serves one thread at a time.
class SolverBackend {
 public:
  virtual ~SolverBackend() = default;

  const std::string& name() const { return name_; }
  virtual Capabilities capabilities() const = 0;
  SolverOptions& options() { return options_; }
  const SolverOptions& options() const { return options_; }

  /// Empty if this backend can solve `view`, else one sentence saying why not.
  std::string Refusal(const View& view) const;

  /// Allocates for problems with the structure of `view`. Throws std::invalid_argument with the
  /// refusal if the backend cannot solve it.
  void Prepare(const View& view);

  /// Called before every solve, in the thread that asks for it. It may solve the same view with
  /// other backends meanwhile. None by default.
  void set_listener(SolveListener listener) { listener_ = std::move(listener); }

  /// Sizes a result for solves of this structure: so the first of them does not allocate it.
  static void Reserve(const View& view, SolverResult* result);

  /// Solves from `warm` (view.num_variables() numbers; what is beyond its bounds is moved onto
  /// them). The view must have the prepared structure; its parameters may have changed. Numerical
  /// outcomes are in result->status. Throws std::invalid_argument on another structure, a wrong
  /// size, a number that is not finite, or without Prepare.
  void Solve(const View& view, const WarmStart& warm, const Stop& stop, SolverResult* result);

 protected:
  SolverBackend(std::string name, SolverOptions options)
      : name_(std::move(name)), options_(std::move(options)) {}

 private:
  virtual void DoPrepare(const View& view) = 0;
  /// True if the backend's own stop test already looks at GapRule's bound, with a factor that it
  /// has anyway. It then keeps Stop::gap itself.
  virtual bool measures_gap() const { return false; }
  /// Runs the solver from `warm`, evaluating only through `evaluator`, and reports every finished
  /// iteration to it. Sets status (converged is a claim that the base checks), native_status,
  /// message, and multipliers if it has them. Charges the time inside its library to
  /// Share::kNative. The base fills in the rest from the evaluator.
  virtual void DoSolve(const View& view, const WarmStart& warm, const Stop& stop,
                       Evaluator* evaluator, SolverResult* result) = 0;

  void TellFailures(const View& view, SolverResult* result);
  void Judge(const View& view, const Eigen::VectorXd& start, SolverResult* result);
  bool FellWithoutEnd(const View& view, const Eigen::VectorXd& start);

  std::string name_;
  SolverOptions options_;
  SolveListener listener_;
  Evaluator evaluator_;
  OptimalityCheck check_;
  GapRule rule_;
  WarmStart inside_{Eigen::VectorXd()};  // a warm start moved into the bounds
  ViewStructure prepared_;
};

}  // namespace touchdown::solvers
