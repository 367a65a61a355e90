// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/sliding_mean.h"

namespace touchdown::evaluation {
namespace {

constexpr double kWindow = 1.0;  // [s]

}  // namespace

void SlidingMean::Add(double t, const Eigen::Vector3d& value) {
  values_.emplace_back(t, value);
  while (values_.front().first < t - kWindow) values_.pop_front();
}

Eigen::Vector3d SlidingMean::Mean() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [t, value] : values_) sum += value;
  return values_.empty() ? sum : Eigen::Vector3d(sum / static_cast<double>(values_.size()));
}

}  // namespace touchdown::evaluation
