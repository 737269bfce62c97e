#pragma once

#include <sched.h>

namespace haptrial {

/// Keeps its thread, and the threads that it starts meanwhile, on the processor on which it runs.
/// For threads that hand over to each other all the time: on one processor each is woken at once,
/// while on two of a busy machine each handover waits for its turn. Without effect where the
/// system refuses.
class OneProcessor {
 public:
  OneProcessor() noexcept;
  ~OneProcessor();
  OneProcessor(const OneProcessor&) = delete;
  OneProcessor& operator=(const OneProcessor&) = delete;

 private:
  cpu_set_t before_{};
  bool kept_{false};
};

}  // namespace haptrial
