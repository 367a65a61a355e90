// SPDX-License-Identifier: BSD-3-Clause
#include "sim/pad/tag_model.h"

namespace touchdown::sim {

double At(const TagModel& model, const std::array<double, TagModel::kKnots>& table, double size) {
  if (size <= model.size.front()) return table.front();
  for (std::size_t i = 1; i < TagModel::kKnots; ++i) {
    if (size > model.size[i]) continue;
    const double share = (size - model.size[i - 1]) / (model.size[i] - model.size[i - 1]);
    return (1.0 - share) * table[i - 1] + share * table[i];
  }
  return table.back();
}

}  // namespace touchdown::sim
