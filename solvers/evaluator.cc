// SPDX-License-Identifier: BSD-3-Clause
// Counting, caching, stopping and best-point tracking around View::Evaluate. A point is better if
// it violates less (beyond the feasibility tolerance), or is as feasible and costs less.

#include "touchdown/solvers/evaluator.h"

#include <algorithm>
#include <cstring>

namespace touchdown::solvers {

Evaluator::Evaluator(const View& view, const Stop& stop, ViewEvaluation* storage)
    : view_(view),
      stop_(stop),
      storage_(storage),
      cached_(view.num_variables()),
      best_(view.num_variables()),
      best_cost_by_term_(static_cast<std::size_t>(view.problem().num_terms()), 0.0),
      start_(std::chrono::steady_clock::now()) {}

double Evaluator::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

bool Evaluator::Evaluate(const double* y, Want want) {
  const auto bytes = static_cast<std::size_t>(cached_.size()) * sizeof(double);
  const bool same = cache_valid_ && std::memcmp(cached_.data(), y, bytes) == 0 &&
                    (!want.gradient || cached_want_.gradient) &&
                    (!want.hessian || cached_want_.hessian);
  if (!same) {
    ++evaluations_;
    std::memcpy(cached_.data(), y, bytes);
    cached_want_ = want;
    cache_valid_ = view_.Evaluate(y, want, nullptr, storage_);
    if (!cache_valid_) {
      failed_ = true;
      return false;
    }
    Track(y);
  }
  CheckStop();
  return true;
}

bool Evaluator::CheckStop() {
  if (must_stop()) return true;
  if (iterations_ >= stop_.max_iterations || evaluations_ >= stop_.max_evaluations) {
    stop_status_ = SolveStatus::kIterationLimit;
  } else if (stop_.wall_limit_s < std::numeric_limits<double>::infinity() &&
             elapsed_s() >= stop_.wall_limit_s) {
    stop_status_ = SolveStatus::kTimeLimit;
  } else if (stop_.callback && cache_valid_) {
    const StopQuery query{{cached_.data(), static_cast<std::size_t>(cached_.size())},
                          storage_->full.cost_by_term,
                          evaluations_};
    if (stop_.callback(query)) stop_status_ = SolveStatus::kStopped;
  }
  return must_stop();
}

void Evaluator::Track(const double* y) {
  const double violation = std::max(storage_->full.max_violation, kFeasible);
  const double cost = storage_->full.value;
  const bool better = !has_best_ || violation < best_violation_ ||
                      (violation == best_violation_ && cost < best_cost_);
  if (!better) return;
  has_best_ = true;
  best_violation_ = violation;
  best_cost_ = cost;
  best_ = Eigen::Map<const Eigen::VectorXd>(y, best_.size());
  best_cost_by_term_ = storage_->full.cost_by_term;
}

}  // namespace touchdown::solvers
