// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::solvers {

/// Heap allocations of this thread so far, by new, malloc or anything above them, libraries
/// included. -1 where the program does not count. A program counts if it is linked with
/// touchdown::allocations, or started with it in LD_PRELOAD, and no sanitizer owns the heap. Does
/// not allocate.
long AllocationCount() noexcept;

}  // namespace touchdown::solvers
