// SPDX-License-Identifier: BSD-3-Clause
// Counting, caching, stopping and best-point tracking around View::Evaluate. A point is better if
// it violates less (beyond the feasibility tolerance), or is as feasible and costs less.

#include "touchdown/solvers/backend/evaluator.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace touchdown::solvers {

void Evaluator::Prepare(const View& view) {
  view.Resize(&storage_);
  cached_.resize(view.num_variables());
  failed_.resize(view.num_variables());
  best_.resize(view.num_variables());
  best_cost_by_term_.assign(static_cast<std::size_t>(view.problem().num_terms()), 0.0);
}

void Evaluator::Begin(const View& view, const Stop& stop, GapRule* rule) {
  view_ = &view;
  stop_ = &stop;
  rule_ = rule;
  near_enough_ = false;
  cache_valid_ = false;
  evaluations_ = iterations_ = 0;
  failures_ = 0;
  stop_status_ = SolveStatus::kConverged;
  has_best_ = false;
  best_cost_ = first_cost_ = best_violation_ = 0.0;
  worst_term_ = -1;
  std::fill(best_cost_by_term_.begin(), best_cost_by_term_.end(), 0.0);
  storage_.HoldParameters();
  trace_.clear();
  shares_ = {};
  share_ = Share::kAdapter;
  start_ = share_start_ = std::chrono::steady_clock::now();
}

double Evaluator::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

bool Evaluator::AtCachedPoint(const double* y) const {
  const auto bytes = static_cast<std::size_t>(cached_.size()) * sizeof(double);
  return cache_valid_ && std::memcmp(cached_.data(), y, bytes) == 0;
}

bool Evaluator::Evaluate(const double* y, Want want) {
  const bool same = AtCachedPoint(y);
  if (same) {
    const bool known = (!want.gradient || cached_want_.gradient) &&
                       (!want.hessian || cached_want_.hessian) &&
                       (!want.residual || cached_want_.residual);
    if (known) return true;
    want.gradient = want.gradient || cached_want_.gradient;
    want.residual = want.residual || cached_want_.residual;
  }
  return Run(y, !same, want, {});
}

bool Evaluator::EvaluateLagrangian(const double* y, const Lagrangian& lagrangian) {
  const bool same = AtCachedPoint(y);
  const bool ok = Run(y, !same, {.gradient = true, .hessian = true}, lagrangian);
  cached_want_.hessian = false;
  return ok;
}

bool Evaluator::Run(const double* y, bool new_point, Want want, const Lagrangian& lagrangian) {
  if (new_point) {
    ++evaluations_;
    std::copy(y, y + cached_.size(), cached_.data());
  }
  cached_want_ = want;
  {
    const ShareScope scope(this, Share::kEvaluation);
    cache_valid_ = view_->Evaluate(y, want, lagrangian, &storage_);
  }
  if (cache_valid_ && new_point) Track();
  if (!cache_valid_) {
    ++failures_;
    failed_ = cached_;
  }
  if (new_point && !CheckStop()) AskCallback();
  return cache_valid_;
}

void Evaluator::FinishIteration(double step_norm, double gradient_max_norm) {
  ++iterations_;
  CheckGap();
  if (!stop_->trace) return;
  trace_.push_back({iterations_, best_cost_, best_cost_by_term_, best_violation_, step_norm,
                    gradient_max_norm, elapsed_s()});
}

void Evaluator::CheckGap() {
  if (!rule_ || must_stop() || !has_best_) return;
  const ShareScope scope(this, Share::kEvaluation);
  near_enough_ = rule_->Met(best_, best_cost_, best_violation_);
}

Share Evaluator::SwitchShare(Share share) {
  const Share before = share_;
  if (!stop_->shares) return before;
  const auto now = std::chrono::steady_clock::now();
  const double spent = std::chrono::duration<double>(now - share_start_).count();
  switch (before) {
    case Share::kAdapter:
      shares_.adapter_s += spent;
      break;
    case Share::kEvaluation:
      shares_.evaluation_s += spent;
      break;
    case Share::kWhitening:
      shares_.whitening_s += spent;
      break;
    case Share::kNative:
      shares_.native_s += spent;
      break;
  }
  share_start_ = now;
  share_ = share;
  return before;
}

bool Evaluator::CheckStop() {
  if (must_stop()) return true;
  const bool spent = iterations_ >= stop_->max_iterations ||
                     evaluations_ >= stop_->max_evaluations ||
                     evaluations_ / kMostPerIteration > stop_->max_iterations;
  if (spent) stop_status_ = SolveStatus::kIterationLimit;
  return spent || CheckClock();
}

bool Evaluator::CheckClock() {
  if (stop_status_ == SolveStatus::kStopped) return true;
  const bool limited = stop_->wall_limit_s < std::numeric_limits<double>::infinity();
  if (limited && elapsed_s() >= stop_->wall_limit_s) stop_status_ = SolveStatus::kTimeLimit;
  return stop_status_ == SolveStatus::kTimeLimit;
}

void Evaluator::AskCallback() {
  if (stop_->callback && cache_valid_) {
    const StopQuery query{{cached_.data(), static_cast<std::size_t>(cached_.size())},
                          storage_.full.value,
                          storage_.full.max_violation,
                          storage_.full.cost_by_term,
                          evaluations_};
    if (stop_->callback(query)) stop_status_ = SolveStatus::kStopped;
  }
}

void Evaluator::Track() {
  if (!has_best_) first_cost_ = storage_.full.value;
  const double violation = std::max(storage_.full.max_violation, kFeasible);
  const double best_violation = std::max(best_violation_, kFeasible);
  const double cost = storage_.full.value;
  const bool better = !has_best_ || violation < best_violation ||
                      (violation == best_violation && cost < best_cost_);
  if (better) Keep();
}

void Evaluator::PreferLast() {
  if (cache_valid_) Keep();
}

void Evaluator::PreferLastIfFeasible() {
  if (cache_valid_ && storage_.full.max_violation <= kFeasible) Keep();
}

void Evaluator::Keep() {
  has_best_ = true;
  best_violation_ = storage_.full.max_violation;
  worst_term_ = storage_.full.worst_term;
  best_cost_ = storage_.full.value;
  best_ = cached_;
  best_cost_by_term_ = storage_.full.cost_by_term;
}

}  // namespace touchdown::solvers
