// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::planning {

/// What a step may still do, in counted work: no clock decides what is planned. The costs are in
/// the ratio of times that were measured, and make them nearly proportional to the work: of 250 slow steps of
/// hostile flights the 99 % quantile of time over work is 1.5 times the median (docs/replan_study.md).
class WorkBudget {
 public:
  static constexpr int kSpan = 1;     ///< that a search expands
  static constexpr int kSegment = 2;  ///< of a curve, each time that a solve evaluates it
  static constexpr int kEvaluationsOfSetUp = 2;  ///< what the rest of a solve takes: set-up, checks
  static constexpr int kPair = 5;                ///< of a solve: bound and evaluated

  void Refill(int work) { whole_ = left_ = work; }
  int left() const { return left_; }
  int done() const { return whole_ - left_; }

  void Take(int work) { left_ -= work; }
  /// Keeps this share back, and returns it; GiveBack puts it in again.
  int SetAside(double share) {
    const int aside = static_cast<int>(share * left_);
    left_ -= aside;
    return aside;
  }
  void GiveBack(int aside) { left_ += aside; }

 private:
  int whole_ = 0;
  int left_ = 0;
};

}  // namespace touchdown::planning
