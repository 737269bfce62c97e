#include "core/base/big_array.h"

#include <sys/mman.h>

#include <cstdlib>

namespace haptrial {

void* take_pages(std::size_t bytes) {
  constexpr std::size_t kLine = 64;
  constexpr std::size_t kLargePage = std::size_t{2} << 20;
  constexpr std::size_t kLarge = 2 * kLargePage;
  const std::size_t alignment = bytes >= kLarge ? kLargePage : kLine;
  if (bytes > static_cast<std::size_t>(-1) - alignment) {
    throw std::bad_alloc();
  }
  const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, whole);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  if (bytes >= kLarge) {
    madvise(memory, whole, MADV_HUGEPAGE);  // a wish: small pages do as well, at more page faults
  }
  return memory;
}

void give_pages(void* memory) noexcept { std::free(memory); }

}  // namespace haptrial
