// SPDX-License-Identifier: BSD-3-Clause
// Storage of a term's evaluation: sized once for the most windows the term can have.

#include "touchdown/solvers/term.h"

namespace touchdown::solvers {

void TermBlock::Resize(const TermShape& shape) {
  const std::size_t windows_max = static_cast<std::size_t>(shape.max_windows);
  const std::size_t outputs = windows_max * static_cast<std::size_t>(shape.outputs);
  const std::size_t v = static_cast<std::size_t>(shape.window * shape.block_size);
  windows = 0;
  first_block.assign(windows_max, 0);
  for (auto* array : {&u, &du_dh, &rho, &drho, &d2rho, &r, &dr}) array->assign(outputs, 0.0);
  du.assign(outputs * v, 0.0);
}

}  // namespace touchdown::solvers
