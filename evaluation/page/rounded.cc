// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/page/rounded.h"

#include <cmath>

namespace touchdown::evaluation {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

Json Rounded(double x, int decimals) {
  if (!std::isfinite(x)) return nullptr;
  const double scale = std::pow(10.0, decimals);
  const double scaled = std::round(x * scale);
  if (scaled == 0.0) return 0;  // also for a negative one, and short
  return scaled / scale;
}

Json RoundedPoint(const Eigen::Vector3d& p_W) {
  return {Rounded(p_W.x(), kMilli), Rounded(p_W.y(), kMilli), Rounded(p_W.z(), kMilli)};
}

Json RoundedPoints(const Eigen::Ref<const Eigen::Matrix3Xd>& points_W) {
  Json json = Json::array();
  for (const auto& p : points_W.colwise()) {
    for (const double x : p) json.push_back(Rounded(x, kMilli));
  }
  return json;
}

}  // namespace touchdown::evaluation
