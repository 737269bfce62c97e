#pragma once

#include <cstddef>

namespace haptrial::test {

/// Counts what the current thread takes from operator new while the guard lives; every form of
/// operator new is replaced in the test binary.
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
