// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace touchdown::evaluation {

/// Detects that a flight stands: for a while it stayed in one place and made no new plan, although a depth image came.
/// A flight that waits for an image may still see a way, so it does not stand.
class StandWatch {
 public:
  /// A flight within this distance stays in one place [m]. Less is drift in a gust, not a flown
  /// way.
  static constexpr double kPlace = 0.5;

  /// `limit` in [s]; 0: no flight stands.
  explicit StandWatch(double limit) : limit_(limit) {}

  void Image() { seen_ = true; }        ///< a depth image came into the map
  void Planned() { started_ = false; }  ///< a new plan was made

  /// Call at every step, t rising. `p_WB` is where the vehicle truly is.
  bool Stands(double t, const Eigen::Vector3d& p_WB) {
    if (limit_ <= 0.0) return false;
    if (!started_ || (p_WB - place_).norm() > kPlace) {
      started_ = true;
      seen_ = false;
      since_ = t;
      place_ = p_WB;
    }
    return seen_ && t - since_ >= limit_;
  }

 private:
  double limit_;
  bool started_ = false;
  bool seen_ = false;
  double since_ = 0.0;  ///< [s]
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();
};

}  // namespace touchdown::evaluation
