// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/solvers/problem/view.h"

namespace touchdown::solvers {

/// What storage, sparsity or a refusal depends on: sizes, terms, their rows' bounds, which variables have bounds.
/// Views that only differ in parameters have the same structure. By default it is empty, and no view has it.
class ViewStructure {
 public:
  ViewStructure() = default;
  explicit ViewStructure(const View& view);

  bool empty() const { return numbers_.empty(); }

  /// Does not allocate.
  bool IsOf(const View& view) const;

 private:
  std::vector<double> numbers_;
};

}  // namespace touchdown::solvers
