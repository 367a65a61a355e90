// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::solvers {

/// Heap allocations of this thread so far, by new, malloc or anything above them; -1 where a
/// sanitizer owns the heap and nothing is counted.
long AllocationCount();

}  // namespace touchdown::solvers
