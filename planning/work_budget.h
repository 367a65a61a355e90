// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::planning {

/// What a step may still do, in counted work: the same scene gives the same plan on every machine. The costs are in
/// the ratio of the times that were measured (docs/replan_study.md): a unit takes about 0.14 us.
class WorkBudget {
 public:
  static constexpr int kSpan = 1;     ///< that a search expands
  static constexpr int kPair = 5;     ///< of a solve: bound and evaluated
  static constexpr int kSegment = 2;  ///< of a curve, each time that it is evaluated or checked ...
  static constexpr int kSegmentOfFreeArrival = 3;  ///< ... where the arrival is free

  void Refill(int work) { whole_ = left_ = work; }
  int left() const { return left_; }
  int done() const { return whole_ - left_; }

  void Take(int work) { left_ -= work; }
  /// A share for what comes later, which takes it by GiveBack.
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
