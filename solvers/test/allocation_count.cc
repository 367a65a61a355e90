// SPDX-License-Identifier: BSD-3-Clause
// Counts by standing in front of the C library's malloc: operator new and Eigen both end there.

#include "touchdown/solvers/test/allocation_count.h"

#include <cstddef>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

namespace touchdown::solvers {
long AllocationCount() { return -1; }
}  // namespace touchdown::solvers

#else

namespace {
thread_local long allocations = 0;
}

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  ++allocations;
  return __libc_realloc(block, size);
}
}

namespace touchdown::solvers {
long AllocationCount() { return allocations; }
}  // namespace touchdown::solvers

#endif
