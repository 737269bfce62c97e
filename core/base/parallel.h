#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>

namespace haptrial {

/// The number of threads; as many as the machine has processors if `threads` is 0 or less.
int threads_or_all(int threads);

/// Items 0 .. count - 1 that threads take in order as they become free, each item once. When an
/// item fails, those begun are finished and no other is begun, so that the failure of the lowest
/// number is the same on any number of threads. Made, watched and ended by one thread.
class SharedWork {
 public:
  using Work = std::function<void(std::size_t item)>;

  /// Starts up to `threads` threads, which is none for 0. Each calls make() for a work of its own.
  SharedWork(std::size_t count, int threads, std::function<Work()> make);
  /// Begins no other item and waits for those begun.
  ~SharedWork();
  SharedWork(const SharedWork&) = delete;
  SharedWork& operator=(const SharedWork&) = delete;

  /// The calling thread takes items too, until none is left.
  void help();
  /// Waits until the threads have ended, at most for this time. @returns whether they have.
  bool ended_within(std::chrono::milliseconds time);
  /// Waits until all items are done. @throws what the failed item of the lowest number threw.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Calls work(0) .. work(count - 1), each once, on `threads` threads, this one among them.
/// @throws what the failed item of the lowest number threw, see SharedWork.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

/// Calls work(first, count) for groups of up to `group` of the items 0 .. items - 1, each once, on
/// up to `jobs` threads, this one among them. Every thread calls make() for a work of its own.
/// @throws what the failed group of the lowest number threw; std::invalid_argument for jobs
/// below 1.
template <class Make>
void in_groups(std::size_t items, std::size_t group, int jobs, Make make) {
  if (jobs < 1) {
    throw std::invalid_argument("jobs must be at least 1");
  }
  SharedWork shared((items + group - 1) / group, jobs - 1, [&]() -> SharedWork::Work {
    // Shared, as a work with buffers of its own may not be copied.
    const auto work = std::make_shared<decltype(make())>(make());
    return [work, items, group](std::size_t g) {
      (*work)(g * group, std::min(group, items - g * group));
    };
  });
  shared.help();
  shared.finish();
}

}  // namespace haptrial
