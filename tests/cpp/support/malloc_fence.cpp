// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "support/malloc_fence.hpp"

#include <Eigen/Core>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#if defined(__SANITIZE_ADDRESS__)
#define WAKELINE_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define WAKELINE_ADDRESS_SANITIZER
#endif
#endif

namespace {
constinit thread_local long allocation_count = 0;
}

#if defined(WAKELINE_ADDRESS_SANITIZER)

// The sanitizer owns malloc and reports every call.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void*,
                                                                             std::size_t),
                                                         void (*free_hook)(const volatile void*));
namespace {
[[maybe_unused]] const int hooks_installed = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { ++allocation_count; }, [](const volatile void*) {});
}  // namespace

#elif defined(__GLIBC__)

// The program's own malloc replaces the C library's everywhere and hands on to it; operator new
// ends here too.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  ++allocation_count;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocation_count;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  ++allocation_count;
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocation_count;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  ++allocation_count;
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}
}

#else
#error "Counting heap allocations needs glibc or the address sanitizer."
#endif

namespace wakeline::test {

NoHeap::NoHeap()
    : start_(allocation_count), eigen_was_allowed_(Eigen::internal::is_malloc_allowed()) {
  Eigen::internal::set_is_malloc_allowed(false);
}

NoHeap::~NoHeap() { Eigen::internal::set_is_malloc_allowed(eigen_was_allowed_); }

long NoHeap::allocations() const { return allocation_count - start_; }

}  // namespace wakeline::test
