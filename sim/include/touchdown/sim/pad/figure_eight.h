// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

#include "touchdown/sim/pad/curvature_chain.h"

namespace touchdown::sim {

/// A closed figure of eight in arc length.
class FigureEight {
 public:
  /// Starts at the end of a loop, where the turn is tightest: `curvature` [1/m], not 0, left positive.
  FigureEight(const Eigen::Vector2d& start, double heading, double curvature);

  /// Any s [m], periodic. Does not allocate.
  PathPoint At(double s) const noexcept;
  PathBounds bounds() const;
  double length() const { return length_; }  ///< [m]

 private:
  static constexpr int kTerms = 12;
  Eigen::Vector2d start_;
  double heading_;
  double length_;
  double sense_;  ///< +1 if the first loop is to the left, else -1
  std::array<double, kTerms> along_{};
  std::array<double, kTerms> across_{};
};

}  // namespace touchdown::sim
