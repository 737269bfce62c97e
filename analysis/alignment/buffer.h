#pragma once

#include <cstddef>
#include <memory>
#include <new>

namespace haptrial::analysis {

/// Scratch memory on a cache line's boundary that grows and never shrinks. Growing drops what it
/// held, and nothing is initialised.
template <class T>
class WorkBuffer {
 public:
  T* at_least(std::size_t count) {
    if (count > count_) {
      memory_.reset();
      count_ = 0;
      memory_.reset(static_cast<T*>(::operator new(count * sizeof(T), kAlignment)));
      count_ = count;
    }
    return memory_.get();
  }

 private:
  static constexpr std::align_val_t kAlignment{64};
  struct Free {
    void operator()(T* memory) const { ::operator delete(memory, kAlignment); }
  };
  std::unique_ptr<T, Free> memory_;
  std::size_t count_{0};
};

}  // namespace haptrial::analysis
