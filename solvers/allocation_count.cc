// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/solvers/allocation_count.h"

#include <dlfcn.h>

namespace touchdown::solvers {
namespace {

using Counter = long (*)() noexcept;
const auto counter = reinterpret_cast<Counter>(dlsym(RTLD_DEFAULT, "touchdown_allocation_count"));

}  // namespace

long AllocationCount() noexcept { return counter != nullptr ? counter() : -1; }

}  // namespace touchdown::solvers
