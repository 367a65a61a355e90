// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::solvers {
namespace {
long (*counter_in_use)() noexcept = nullptr;
}

long AllocationCount() noexcept { return counter_in_use ? counter_in_use() : -1; }

void SetAllocationCounter(long (*counter)() noexcept) noexcept { counter_in_use = counter; }

}  // namespace touchdown::solvers
