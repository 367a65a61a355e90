// SPDX-License-Identifier: BSD-3-Clause
// Storage of a term's evaluation: sized once for the most windows the term can have.

#include "touchdown/solvers/problem/term.h"

namespace touchdown::solvers {

void TermBlock::Resize(const TermShape& shape) {
  outputs_ = shape.outputs;
  variables_ = shape.variables();
  max_windows_ = shape.max_windows;
  const auto rows = static_cast<std::size_t>(max_windows_ * outputs_);
  windows = 0;
  first_block.assign(static_cast<std::size_t>(max_windows_), 0);
  for (auto* array : {&u, &du_dh, &rho, &drho, &d2rho, &r, &dr}) array->assign(rows, 0.0);
  du.assign(rows * static_cast<std::size_t>(variables_), 0.0);
}

bool TermBlock::Fits(const TermShape& shape) const {
  return outputs_ == shape.outputs && variables_ == shape.variables() &&
         max_windows_ == shape.max_windows;
}

}  // namespace touchdown::solvers
