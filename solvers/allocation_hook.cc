// SPDX-License-Identifier: BSD-3-Clause
// The library touchdown_allocations counts allocations in front of the C library's allocator, where operator new,
// Eigen and other libraries all end. Our programs are not linked with it: a program that wants to count preloads it,
// the tests link it. Needs glibc's own names for its allocator.

#include <cerrno>
#include <cstddef>

#if !defined(TOUCHDOWN_SANITIZED)

namespace {

// Its place is fixed when the program starts. Otherwise finding it could allocate.
__attribute__((tls_model("initial-exec"))) thread_local long allocations = 0;

}  // namespace

extern "C" {
/// Of this thread. solvers/allocation_count.cc looks for it by its name.
long touchdown_allocation_count() noexcept { return allocations; }

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
