// SPDX-License-Identifier: BSD-3-Clause
// The part of a solve that is the same for every backend (a non-virtual interface, as in Drake's
// SolverBase): refuse what the backend cannot take, check the caller's numbers, time the solve, and
// return the best feasible point that the evaluator saw.

#include "touchdown/solvers/solver_backend.h"

#include <stdexcept>

#include "touchdown/solvers/thread_clock.h"

namespace touchdown::solvers {

std::string SolverBackend::Refusal(const View& view) const {
  const Capabilities can = capabilities();
  if (!can.compiled) {
    return "backend " + name_ + " was not compiled in (configure with its TOUCHDOWN_WITH_ option)";
  }
  if (view.free_interval() && !can.free_interval) {
    return "backend " + name_ + " cannot optimise the arrival time";
  }
  const Problem& problem = view.problem();
  for (int i = 0; i < problem.num_terms(); ++i) {
    if (problem.role(i) != Role::kConstraint) continue;
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
  view.Resize(&storage_);
  DoPrepare(view);
  prepared_variables_ = view.num_variables();
}

void SolverBackend::Solve(const View& view, const Eigen::VectorXd& warm, const Stop& stop,
                          SolverResult* result) {
  const int n = view.num_variables();
  if (prepared_variables_ != n || warm.size() != n) {
    throw std::invalid_argument("backend " + name_ + ": prepared for " +
                                std::to_string(prepared_variables_) +
                                " variables, warm start has " + std::to_string(warm.size()) +
                                ", the view has " + std::to_string(n));
  }
  if (!warm.allFinite()) {
    throw std::invalid_argument("backend " + name_ + ": the warm start is not finite");
  }
  const double cpu_start = ThreadCpuSeconds();
  Evaluator evaluator(view, stop, &storage_);
  result->trace.clear();
  result->message.clear();
  result->native_status = 0;
  DoSolve(view, warm, stop, &evaluator, result);
  if (evaluator.must_stop() && result->usable()) result->status = evaluator.stop_status();
  if (!evaluator.has_best()) result->status = SolveStatus::kEvaluationFailed;

  result->x = evaluator.has_best() ? evaluator.best() : warm;
  result->cost = evaluator.best_cost();
  result->max_violation =
      evaluator.best_violation() > Evaluator::kFeasible ? evaluator.best_violation() : 0.0;
  result->cost_by_term.resize(evaluator.best_cost_by_term().size());
  for (std::size_t i = 0; i < result->cost_by_term.size(); ++i) {
    result->cost_by_term[i] = {view.problem().term(static_cast<int>(i)).info().name,
                               evaluator.best_cost_by_term()[i]};
  }
  result->iterations = evaluator.iterations();
  result->evaluations = evaluator.evaluations();
  result->wall_s = evaluator.elapsed_s();
  result->cpu_s = ThreadCpuSeconds() - cpu_start;
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
