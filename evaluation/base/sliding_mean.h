// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <utility>

#include <Eigen/Core>

namespace touchdown::evaluation {

/// Mean over the last second of what is added, one value per call.
class SlidingMean {
 public:
  void Add(double t, const Eigen::Vector3d& value);
  Eigen::Vector3d Mean() const;  ///< zero before the first value

 private:
  std::deque<std::pair<double, Eigen::Vector3d>> values_;
};

}  // namespace touchdown::evaluation
