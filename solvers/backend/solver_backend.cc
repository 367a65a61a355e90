// SPDX-License-Identifier: BSD-3-Clause
// The part of a solve that is the same for every backend (a non-virtual interface, as in Drake's
// SolverBase). It refuses what the backend cannot take, checks the caller's numbers and times the
// solve. It returns the best feasible point that the evaluator saw.

#include "touchdown/solvers/backend/solver_backend.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "touchdown/solvers/backend/constraint_rows.h"
#include "touchdown/solvers/backend/newton_step.h"
#include "touchdown/solvers/backend/thread_clock.h"

namespace touchdown::solvers {

namespace {

/// A cost that has fallen by so many times its first value, slope and curvature has no end.
constexpr double kEndless = 1e12;
constexpr std::size_t kLongestMessage = 100;  // of backends of our own

}  // namespace

std::string SolverBackend::Refusal(const View& view) const {
  const Capabilities can = capabilities();
  if (!can.compiled) {
    return "backend " + name_ + " was not compiled in (configure with its TOUCHDOWN_WITH_ option)";
  }
  if (view.free_interval() && !can.free_interval) {
    return "backend " + name_ + " cannot optimise the arrival time";
  }
  if (view.bounded() && !view.identity()) {
    return "bounds on variables need a view of the problem's own variables";
  }
  if (view.bounded() && !can.variable_bounds) {
    return "backend " + name_ + " takes no bounds on variables: make them costs";
  }
  const Problem& problem = view.problem();
  for (int i = 0; i < problem.num_terms(); ++i) {
    if (problem.role(i) == Role::kCost) {
      if (can.needs_residuals && !problem.term(i).shape().has_residual) {
        return "backend " + name_ + " minimises sums of squares, and the cost term " +
               problem.term(i).info().name + " is none";
      }
      continue;
    }
    const LossBounds bounds = problem.term(i).bounds();
    const bool equality = bounds.lo == bounds.hi;
    if (equality ? !can.equality_rows : !can.hard_rows) {
      return "backend " + name_ + " takes no " + (equality ? "equality" : "inequality") +
             " constraints: make term " + problem.term(i).info().name + " a cost";
    }
  }
  return "";
}

void SolverBackend::Prepare(const View& view) {
  const std::string refusal = Refusal(view);
  if (!refusal.empty()) throw std::invalid_argument(refusal);
  prepared_ = {};  // what follows may throw with half of it sized
  evaluator_.Prepare(view);
  check_.Prepare(view);
  if (!measures_gap()) rule_.Prepare(view, &check_);
  inside_.y.resize(view.num_variables());
  if (view.num_variables() > 0) DoPrepare(view);
  prepared_ = ViewStructure(view);
}

void SolverBackend::Reserve(const View& view, SolverResult* result) {
  const Problem& problem = view.problem();
  result->x.resize(view.num_variables());
  result->cost_by_term.clear();
  for (int i = 0; i < problem.num_terms(); ++i) {
    result->cost_by_term.push_back({problem.term(i).info().name, 0.0});
  }
  ConstraintRows::Size(view, &result->multipliers);
  result->bound_multipliers.reserve(static_cast<std::size_t>(view.num_variables()));
  result->message.reserve(kLongestMessage);
}

namespace {

/// The first with a value or slope that is not finite; -1: none.
int FailedWindow(const TermBlock& block, int variables) {
  const auto finite = [](double a) { return std::isfinite(a); };
  for (int row = 0; row < block.rows(); ++row) {
    const double* du = block.slopes(row);
    if (!finite(block.u[row]) || !std::all_of(du, du + variables, finite)) {
      return block.window_of(row);
    }
  }
  return -1;
}

/// Which term, why, and where. Evaluates again what threw.
std::string WhatFailed(const Problem& problem, ViewEvaluation* at) {
  constexpr std::size_t kMostNumbers = 12;
  Evaluation& full = at->full;
  std::size_t from = 0, to = at->x.size();
  std::ostringstream text;
  if (full.failed_term >= 0) {
    const Term& term = problem.term(full.failed_term);
    text << "term " << term.info().name;
    TermBlock& block = full.terms[static_cast<std::size_t>(full.failed_term)];
    if (!full.failure.empty()) {
      std::fill(block.u.begin(), block.u.end(), std::numeric_limits<double>::quiet_NaN());
      problem.Evaluate(at->x.data(), at->h, {}, {}, &full);
    }
    const int window = FailedWindow(block, term.shape().variables());
    if (window >= 0 && block.windows > 1) text << ", window " << window;
    if (window >= 0) {
      const int first = block.first_block[window], d = term.shape().block_size;
      from = static_cast<std::size_t>(first * d);
      to = std::min(to, static_cast<std::size_t>((first + term.shape().window) * d));
    }
  } else {
    text << "the gradient";
  }
  text << (full.failure.empty() ? " is not finite" : ": " + full.failure) << ", at (";
  for (std::size_t i = from; i < std::min(from + kMostNumbers, to); ++i) {
    text << (i > from ? ", " : "") << at->x[i];
  }
  if (to - from > kMostNumbers) text << ", ... of " << to - from << " numbers";
  text << ')';
  if (problem.shape().free_interval) text << " and interval " << at->h;
  return text.str();
}

}  // namespace

void SolverBackend::Solve(const View& view, const WarmStart& warm, const Stop& stop,
                          SolverResult* result) {
  const int n = view.num_variables();
  if (prepared_.empty()) {
    throw std::invalid_argument("backend " + name_ + ": Solve before Prepare");
  }
  if (!prepared_.IsOf(view)) {
    throw std::invalid_argument(
        "backend " + name_ +
        ": this view does not have the structure it was prepared for: sizes, "
        "terms, their rows' bounds, and which variables have bounds");
  }
  if (result == nullptr) throw std::invalid_argument("backend " + name_ + ": no result to fill");
  if (warm.y.size() != n) {
    throw std::invalid_argument("backend " + name_ + ": the warm start has " +
                                std::to_string(warm.y.size()) + " numbers, it needs " +
                                std::to_string(n));
  }
  for (int i = 0; i < n; ++i) {
    if (std::isfinite(warm.y[i])) continue;
    throw std::invalid_argument("backend " + name_ + ": number " + std::to_string(i) +
                                " of the warm start is not finite");
  }
  if (!warm.multipliers.empty() && !ConstraintRows::Fit(view, warm.multipliers)) {
    throw std::invalid_argument("backend " + name_ +
                                ": the warm start's multipliers are not those of this problem: "
                                "[term][row], none for a cost");
  }
  for (const std::vector<double>& rows : warm.multipliers) {
    if (!std::all_of(rows.begin(), rows.end(), [](double m) { return std::isfinite(m); })) {
      throw std::invalid_argument("backend " + name_ +
                                  ": the warm start has multipliers that are " + "not finite");
    }
  }
  if (!(stop.gap >= 0.0 && stop.gap < 1.0)) {
    throw std::invalid_argument("backend " + name_ + ": stop.gap is " + std::to_string(stop.gap) +
                                ", it must be in [0, 1)");
  }
  if (stop.max_iterations < 0 || stop.max_evaluations < 0) {
    const bool iterations = stop.max_iterations < 0;
    throw std::invalid_argument(
        "backend " + name_ + ": stop." + (iterations ? "max_iterations" : "max_evaluations") +
        " is " + std::to_string(iterations ? stop.max_iterations : stop.max_evaluations) +
        ", it must be >= 0");
  }
  if (!(stop.wall_limit_s >= 0.0)) {
    throw std::invalid_argument("backend " + name_ + ": stop.wall_limit_s is " +
                                std::to_string(stop.wall_limit_s) + ", it must be >= 0 s");
  }
  inside_.y = warm.y;
  view.MoveIntoBounds(inside_.y.data());
  if (inside_.y != warm.y) {
    inside_.multipliers = warm.multipliers;
    return Solve(view, inside_, stop, result);
  }
  if (listener_) listener_({view, warm, stop});
  const double cpu_start = ThreadCpuSeconds();
  const bool choice = view.num_free_variables() > 0;
  const bool asks_rule = stop.gap > 0.0 && choice && !measures_gap();
  if (asks_rule) rule_.Begin(view, stop.gap);
  evaluator_.Begin(view, stop, asks_rule ? &rule_ : nullptr);
  result->trace.clear();
  result->message.clear();
  for (auto& rows : result->multipliers) rows.clear();  // keeps its storage
  result->bound_multipliers.clear();
  result->native_status = 0;
  if (!choice) {
    evaluator_.Evaluate(warm.y.data(), {});  // all is eliminated or fixed
    const bool feasible = evaluator_.best_violation() <= Evaluator::kFeasible;
    result->status = feasible ? SolveStatus::kConverged : SolveStatus::kInfeasible;
  } else {
    // A start may be near enough, or all that the budget allows.
    if (asks_rule && evaluator_.Evaluate(warm.y.data(), {.gradient = true})) evaluator_.CheckGap();
    result->status = evaluator_.stop_status();
    if (!evaluator_.must_stop()) DoSolve(view, warm, stop, &evaluator_, result);
    if (evaluator_.near_enough()) result->status = SolveStatus::kConverged;
  }
  // A claim from the last allowed iteration is checked like others.
  const bool claimed = result->status == SolveStatus::kConverged &&
                       evaluator_.stop_status() == SolveStatus::kIterationLimit;
  if (evaluator_.must_stop() && result->usable() && !claimed) {
    result->status = evaluator_.stop_status();
  }
  if (!evaluator_.has_best()) result->status = SolveStatus::kEvaluationFailed;
  result->worst_term = evaluator_.worst_term();
  if (result->status == SolveStatus::kEvaluationFailed) {
    result->worst_term = evaluator_.last().full.failed_term;
  }

  result->optimality = {};
  if (choice && stop.confirm && !evaluator_.near_enough()) Judge(view, warm.y, result);
  if (stop.confirm) TellFailures(view, result);

  result->x = evaluator_.has_best() ? evaluator_.best() : warm.y;
  result->cost = evaluator_.best_cost();
  result->max_violation = evaluator_.best_violation();
  result->cost_by_term.resize(evaluator_.best_cost_by_term().size());
  for (std::size_t i = 0; i < result->cost_by_term.size(); ++i) {
    result->cost_by_term[i].name = view.problem().term(static_cast<int>(i)).info().name;
    result->cost_by_term[i].cost = evaluator_.best_cost_by_term()[i];
  }
  evaluator_.SwitchShare(Share::kAdapter);  // charges the time since the last switch
  result->shares = evaluator_.shares();
  if (stop.trace) result->trace = evaluator_.TakeTrace();
  result->iterations = evaluator_.iterations();
  result->evaluations = evaluator_.evaluations();
  result->wall_s = evaluator_.elapsed_s();
  result->cpu_s = ThreadCpuSeconds() - cpu_start;
}

/// What could not be evaluated, and where, unless that did not matter.
void SolverBackend::TellFailures(const View& view, SolverResult* result) {
  if (evaluator_.failures() == 0 || result->status == SolveStatus::kConverged) return;
  ViewEvaluation* at = evaluator_.mutable_last();
  if (view.Evaluate(evaluator_.last_failure().data(), {.gradient = true}, {}, at)) return;
  const std::string what = WhatFailed(view.problem(), at);
  if (result->status == SolveStatus::kEvaluationFailed) {
    result->message = what;
    return;
  }
  if (!result->message.empty()) result->message += "; ";
  result->message +=
      std::to_string(evaluator_.failures()) + " evaluations failed, the last: " + what;
}

/// Turns a backend's claim into the final status.
void SolverBackend::Judge(const View& view, const Eigen::VectorXd& start, SolverResult* result) {
  SolveStatus* status = &result->status;
  const ShareScope scope(&evaluator_, Share::kEvaluation);
  const OptimalityCheck::MustStop must_stop = [this] { return evaluator_.CheckClock(); };
  ViewEvaluation* storage = evaluator_.mutable_last();
  const bool gave_up = *status == SolveStatus::kNumericalFailure && evaluator_.has_best() &&
                       evaluator_.best_violation() > Evaluator::kFeasible;
  if (*status == SolveStatus::kInfeasible || gave_up) {
    using Foot = OptimalityCheck::Foot;
    const Foot foot = check_.StepOntoRows(view, evaluator_.best(), must_stop, storage);
    const bool least = foot == Foot::kLeast;
    if (least == gave_up) {  // the backend's words are of another status
      result->message = least ? "no step meets the constraints better"
                        : foot == Foot::kMeets
                            ? "gave up; steps lead to a point that meets the constraints"
                            : "gave up; whether constraints can be met is not known";
    }
    *status = least ? SolveStatus::kInfeasible : SolveStatus::kNumericalFailure;
    if (evaluator_.CheckClock()) *status = evaluator_.stop_status();
  } else if (*status == SolveStatus::kConverged || *status == SolveStatus::kUnconfirmed) {
    const Optimality at =
        check_.Look(view, evaluator_.best(), *result, evaluator_.first_cost(), must_stop, storage);
    result->optimality = at;
    if (evaluator_.CheckClock()) {
      *status = evaluator_.stop_status();
    } else if (!at.feasible() || !at.stationary()) {
      *status = SolveStatus::kUnconfirmed;
    } else if (at.saddle) {
      *status = SolveStatus::kSaddle;
    } else {
      *status = SolveStatus::kConverged;
      return;
    }
  }
  if (FellWithoutEnd(view, start)) {
    *status = SolveStatus::kUnbounded;
  } else if (*status == SolveStatus::kUnbounded) {
    *status = SolveStatus::kNumericalFailure;  // its points ran away, the cost did not
  }
}

/// By what a step as long as the start is large could have gained there, so many times.
bool SolverBackend::FellWithoutEnd(const View& view, const Eigen::VectorXd& start) {
  const double fallen = evaluator_.first_cost() - evaluator_.best_cost();
  const bool feasible =
      evaluator_.has_best() && evaluator_.best_violation() <= Evaluator::kFeasible;
  if (!feasible || !(fallen > kEndless * std::abs(evaluator_.first_cost()))) return false;
  ViewEvaluation* at = evaluator_.mutable_last();
  if (!view.Evaluate(start.data(), {.gradient = true, .hessian = true}, {}, at)) return false;
  double slope = 0.0, size = 1.0;
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    slope = std::max(slope, (1.0 + std::abs(start[i])) * std::abs(at->gradient[i]));
    size = std::max(size, 1.0 + std::abs(start[i]));
  }
  const double could = std::abs(at->full.value) + slope + size * size * LargestElement(at->hessian);
  return could > 0.0 && fallen > kEndless * could;
}

const char* ToString(SolveStatus status) {
  switch (status) {
    case SolveStatus::kConverged:
      return "converged";
    case SolveStatus::kIterationLimit:
      return "iteration_limit";
    case SolveStatus::kTimeLimit:
      return "time_limit";
    case SolveStatus::kStopped:
      return "stopped";
    case SolveStatus::kUnconfirmed:
      return "unconfirmed";
    case SolveStatus::kSaddle:
      return "saddle";
    case SolveStatus::kUnbounded:
      return "unbounded";
    case SolveStatus::kInfeasible:
      return "infeasible";
    case SolveStatus::kEvaluationFailed:
      return "evaluation_failed";
    case SolveStatus::kNumericalFailure:
      return "numerical_failure";
  }
  return "unknown";
}

}  // namespace touchdown::solvers
