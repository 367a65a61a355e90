// SPDX-License-Identifier: BSD-3-Clause
// Counts allocations by standing in front of the C library's allocator: operator new, Eigen and
// shared libraries all end there. Compiled into an executable, never into a library: what is linked
// decides whether a program counts. Needs glibc's own names for its allocator.

#include <cerrno>
#include <cstddef>

#include "touchdown/solvers/allocation_count.h"

#if !defined(TOUCHDOWN_SANITIZED)

namespace {

thread_local long allocations = 0;

long Count() noexcept { return allocations; }

[[maybe_unused]] const bool registered = [] {
  touchdown::solvers::SetAllocationCounter(&Count);
  return true;
}();

}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

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
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  if (alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0 || alignment == 0) {
    return EINVAL;
  }
  ++allocations;
  void* const got = __libc_memalign(alignment, size);
  if (got == nullptr) return ENOMEM;
  *block = got;
  return 0;
}
}

#endif
