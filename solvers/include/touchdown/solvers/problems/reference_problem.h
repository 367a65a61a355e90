// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "touchdown/solvers/problem/function_term.h"
#include "touchdown/solvers/problem/problem.h"

namespace touchdown::solvers {

/// A problem whose optimum is known, so that a backend's result can be judged from outside.
struct ReferenceProblem {
  std::string name;
  std::shared_ptr<const Problem> problem;
  Eigen::VectorXd start;
  double cost = 0.0;           ///< at the best local optimum that is known
  std::vector<double> others;  ///< costs at other local optima

  /// Distance of a cost from that of the nearest known optimum, as a share of it, or of 1 where it
  /// is less.
  double Off(double at) const {
    double off = std::abs(at - cost) / std::max(1.0, std::abs(cost));
    for (const double other : others) {
      off = std::min(off, std::abs(at - other) / std::max(1.0, std::abs(other)));
    }
    return off;
  }
};

/// How the equality rows of a set are written.
enum class EqualityForm {
  kRows,   ///< u = 0
  kPairs,  ///< u <= 0 and -u <= 0: what a backend without equality rows would be given
};

/// Builds problems in a few variables: one block of them all.
class SmallProblem {
 public:
  SmallProblem(std::string name, std::vector<double> start, double cost, EqualityForm form)
      : form_(form) {
    const auto n = static_cast<Eigen::Index>(start.size());
    lower_.assign(start.size(), -kInfinity);
    upper_.assign(start.size(), kInfinity);
    problem_ =
        std::make_shared<Problem>(ProblemShape{.blocks = 1, .block_size = static_cast<int>(n)});
    reference_ = {
        std::move(name), problem_, Eigen::Map<Eigen::VectorXd>(start.data(), n), cost, {}};
  }

  /// u[0].
  template <class Function>
  SmallProblem& Cost(Function function) {
    return Add("cost", 1, LinearLoss(1.0), Role::kCost, function);
  }
  /// Sum of u[c]^2.
  template <class Function>
  SmallProblem& Squares(int outputs, Function function) {
    return Add("squares", outputs, SquareLoss(2.0), Role::kCost, function);
  }
  /// Rows u >= 0.
  template <class Function>
  SmallProblem& AtLeastZero(int outputs, Function function) {
    return Rows("rows", outputs, {0.0, kInfinity}, function);
  }
  /// Rows u = 0.
  template <class Function>
  SmallProblem& Zero(int outputs, Function function) {
    if (form_ == EqualityForm::kRows) {
      return Add("equalities", outputs, SquareLoss(1.0), Role::kConstraint, function);
    }
    Rows("at_least", outputs, {0.0, kInfinity}, function);
    return Rows("at_most", outputs, {-kInfinity, 0.0}, function);
  }
  /// lo <= x[i] <= hi.
  SmallProblem& Bound(int i, double lo, double hi) {
    lower_[i] = lo;
    upper_[i] = hi;
    problem_->SetBounds(lower_, upper_);
    return *this;
  }
  SmallProblem& BoundAll(double lo, double hi) {
    for (std::size_t i = 0; i < lower_.size(); ++i) Bound(static_cast<int>(i), lo, hi);
    return *this;
  }
  SmallProblem& Other(double cost) {
    reference_.others.push_back(cost);
    return *this;
  }
  operator ReferenceProblem() const { return reference_; }  // NOLINT: the end of a chain

  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

 private:
  template <class Function>
  SmallProblem& Rows(const char* name, int outputs, LossBounds bounds, Function function) {
    return Add(name, outputs, RangeLoss(bounds, 1.0, 1.0), Role::kConstraint, function);
  }
  template <class Function>
  SmallProblem& Add(const char* name, int outputs, const FunctionTerm::Loss& loss, Role role,
                    Function function) {
    const FunctionShape shape{.block_size = static_cast<int>(reference_.start.size()),
                              .outputs = outputs};
    problem_->AddTerm(std::make_shared<FunctionTerm>(TermInfo{.name = name}, shape, loss, function),
                      role);
    return *this;
  }

  EqualityForm form_;
  std::vector<double> lower_, upper_;
  std::shared_ptr<Problem> problem_;
  ReferenceProblem reference_;
};

}  // namespace touchdown::solvers
