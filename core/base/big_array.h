#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace haptrial {

/// Memory that begins at a cache line; from 4 MB on in large pages where the system has them.
/// @throws std::bad_alloc
void* take_pages(std::size_t bytes);
void give_pages(void* memory) noexcept;

/// Leaves elements without a value until they are written: resize() costs nothing but memory.
template <class T>
struct PageAllocator {
  using value_type = T;
  PageAllocator() = default;
  template <class U>
  PageAllocator(const PageAllocator<U>&) {}  // NOLINT: rebinding is implicit
  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) {
      throw std::bad_array_new_length();
    }
    return static_cast<T*>(take_pages(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t) noexcept { give_pages(memory); }
  template <class U>
  void construct(U* place) noexcept {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
  bool operator==(const PageAllocator&) const = default;
};

/// A vector for what is large and written whole.
template <class T>
using BigArray = std::vector<T, PageAllocator<T>>;

}  // namespace haptrial
