// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/solvers/allocation_count.h"

#ifndef __EMSCRIPTEN__
#include <dlfcn.h>
#endif

namespace touchdown::solvers {
namespace {

using Counter = long (*)() noexcept;
#ifdef __EMSCRIPTEN__
constexpr Counter counter = nullptr;  // nothing is preloaded in a browser
#else
const auto counter = reinterpret_cast<Counter>(dlsym(RTLD_DEFAULT, "touchdown_allocation_count"));
#endif

}  // namespace

long AllocationCount() noexcept { return counter != nullptr ? counter() : -1; }

}  // namespace touchdown::solvers
