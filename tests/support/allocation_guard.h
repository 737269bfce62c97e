#pragma once

#include <cstddef>

namespace haptrial::test {

/// Counts the heap allocations of the current thread while the guard lives: every form of operator
/// new, and the C allocation calls of every object linked into the test (Eigen calls malloc).
class AllocationGuard {
 public:
  AllocationGuard();
  ~AllocationGuard();
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;
  std::size_t count() const;

 private:
  std::size_t start_;
  bool outer_;
};

}  // namespace haptrial::test
