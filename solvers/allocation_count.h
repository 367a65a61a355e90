// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::solvers {

/// Heap allocations of this thread so far, by new, malloc or anything above them, libraries
/// included; -1 where nobody counts: a program counts if it compiles in allocation_hook.cc and no
/// sanitizer owns the heap. Does not allocate.
long AllocationCount() noexcept;

/// Names who counts. allocation_hook.cc does before main.
void SetAllocationCounter(long (*counter)() noexcept) noexcept;

}  // namespace touchdown::solvers
