#pragma once

#include <sched.h>

#include <string>

namespace haptrial::realtime {

/// Real-time treatment that the system granted to a thread that asked for it.
struct RealTimeStatus {
  bool fifo{false};           // SCHED_FIFO: ordinary threads do not delay this one
  bool memory_locked{false};  // no page that is in memory now will be paged out
  std::string notice;         // what was refused and how to permit it; empty when all was granted
};

/// Scope of real-time treatment: the constructing thread runs under SCHED_FIFO if the system
/// permits, and wakes from a sleep without the 50 µs that the system may add for other threads. The
/// destructor gives back the previous scheduling. Memory is locked for the whole process and stays
/// locked. The thread that constructed the scope destroys it.
class RealTimeScope {
 public:
  static constexpr int kPriority = 80;  // below the kernel's own urgent threads

  explicit RealTimeScope(int priority = kPriority);
  ~RealTimeScope();
  RealTimeScope(const RealTimeScope&) = delete;
  RealTimeScope& operator=(const RealTimeScope&) = delete;

  const RealTimeStatus& status() const noexcept { return status_; }

 private:
  int previous_policy_{SCHED_OTHER};
  sched_param previous_param_{};
  int previous_slack_{-1};  // [ns]; negative when unknown
  RealTimeStatus status_;
};

}  // namespace haptrial::realtime
