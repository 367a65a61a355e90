// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::planning {

/// The remaining work of a step, counted: no clock decides what is planned. The costs have the
/// ratio of measured times, so a step's time is nearly proportional to its work. Of 250 slow steps of
/// hostile flights the 99 % quantile of time over work is 1.5 times the median
/// (docs/results/replan/tables.md).
class WorkBudget {
 public:
  static constexpr int kSpan = 1;     ///< that a search expands
  static constexpr int kSegment = 2;  ///< of a curve, each time that a solve evaluates it
  static constexpr int kEvaluationsOfSetUp = 2;  ///< what the rest of a solve takes: set-up, checks
  static constexpr int kPair = 5;                ///< of a solve: bound and evaluated

  static constexpr int kAtRest = 4;  ///< times the budget has a vehicle that rests: it is not late

  // The first user does not get all of it.
  static constexpr double kKeptShare = 0.25;   ///< is for the committed plan, where it may be kept
  static constexpr double kSearchShare = 0.5;  ///< of what is left is the most for a search: of the
                                               ///< committed way, or beside a closed one
  static constexpr int kLeastEvaluations = 12;  ///< a search leaves, of a curve along its way

  void Refill(int work) { whole_ = left_ = work; }
  int left() const { return left_; }
  int done() const { return whole_ - left_; }

  void Take(int work) { left_ -= work; }

  /// Keeps a share of what is left back while it lives. @pre No Refill then.
  class [[nodiscard]] SetAside {
   public:
    SetAside(double share, WorkBudget* budget)
        : budget_(budget), aside_(static_cast<int>(share * budget->left_)) {
      budget_->left_ -= aside_;
    }
    ~SetAside() { budget_->left_ += aside_; }
    SetAside(const SetAside&) = delete;
    SetAside& operator=(const SetAside&) = delete;

   private:
    WorkBudget* budget_;
    int aside_;
  };

 private:
  int whole_ = 0;
  int left_ = 0;
};

}  // namespace touchdown::planning
