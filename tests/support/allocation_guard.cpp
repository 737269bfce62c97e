#include "tests/support/allocation_guard.h"

#include <cstdlib>
#include <new>

namespace {
thread_local std::size_t allocations = 0;
thread_local bool counting = false;

void note() {
  if (counting) {
    ++allocations;
  }
}

void* taken(std::size_t size, std::size_t alignment) noexcept {
  return alignment <= alignof(std::max_align_t)
             ? std::malloc(size ? size : 1)
             : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

void* counted(std::size_t size, std::size_t alignment) {
  void* p = taken(size, alignment);
  if (p == nullptr) {
    throw std::bad_alloc();
  }
  return p;
}
}  // namespace

// The linker sends the C allocation calls of every object of a test here (--wrap).
extern "C" {
void* __real_malloc(std::size_t);
void* __real_calloc(std::size_t, std::size_t);
void* __real_realloc(void*, std::size_t);
void* __real_aligned_alloc(std::size_t, std::size_t);
int __real_posix_memalign(void**, std::size_t, std::size_t);
void* __wrap_malloc(std::size_t size) { return note(), __real_malloc(size); }
void* __wrap_calloc(std::size_t n, std::size_t size) { return note(), __real_calloc(n, size); }
void* __wrap_realloc(void* p, std::size_t size) { return note(), __real_realloc(p, size); }
void* __wrap_aligned_alloc(std::size_t a, std::size_t size) {
  return note(), __real_aligned_alloc(a, size);
}
int __wrap_posix_memalign(void** p, std::size_t a, std::size_t size) {
  return note(), __real_posix_memalign(p, a, size);
}
}

void* operator new(std::size_t size) { return counted(size, 1); }
void* operator new[](std::size_t size) { return counted(size, 1); }
void* operator new(std::size_t size, std::align_val_t a) {
  return counted(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a) {
  return counted(size, static_cast<std::size_t>(a));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return taken(size, 1); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return taken(size, 1); }
void* operator new(std::size_t size, std::align_val_t a, const std::nothrow_t&) noexcept {
  return taken(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a, const std::nothrow_t&) noexcept {
  return taken(size, static_cast<std::size_t>(a));
}
void operator delete(void* p, const std::nothrow_t&) noexcept { std::free(p); }
void operator delete[](void* p, const std::nothrow_t&) noexcept { std::free(p); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace haptrial::test {

AllocationGuard::AllocationGuard() : start_(allocations), outer_(counting) { counting = true; }
AllocationGuard::~AllocationGuard() { counting = outer_; }
std::size_t AllocationGuard::count() const { return allocations - start_; }

}  // namespace haptrial::test
