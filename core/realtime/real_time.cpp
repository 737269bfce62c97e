#include "core/realtime/real_time.h"

#include <pthread.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

namespace haptrial::realtime {
namespace {

bool set_fifo(int priority) {
  sched_param param{};
  param.sched_priority = priority;
  // Threads that the task starts must not inherit the priority.
  return pthread_setschedparam(pthread_self(), SCHED_FIFO | SCHED_RESET_ON_FORK, &param) == 0;
}

// The highest priority that is permitted, up to the one asked for.
bool enter_fifo(int priority) {
  if (set_fifo(priority)) {
    return true;
  }
  rlimit limit{};
  if (getrlimit(RLIMIT_RTPRIO, &limit) != 0 || limit.rlim_cur < 1) {
    return false;
  }
  return set_fifo(
      static_cast<int>(std::min<rlim_t>(limit.rlim_cur, static_cast<rlim_t>(priority))));
}

// The main thread's stack grows page by page; these pages must be there before they are locked.
void touch_stack() {
  std::array<std::byte, 256 * 1024> stack;
  std::memset(stack.data(), 0, stack.size());
  asm volatile("" : : "r"(stack.data()) : "memory");
}

// Locks only memory that exists now: the servo thread allocates nothing later, and a limit on
// locked memory would make later allocations of other threads fail.
bool lock_memory() {
  touch_stack();
  return mlockall(MCL_CURRENT) == 0;
}

}  // namespace

RealTimeScope::RealTimeScope(int priority) {
  pthread_getschedparam(pthread_self(), &previous_policy_, &previous_param_);
  previous_slack_ = prctl(PR_GET_TIMERSLACK, 0, 0, 0, 0);
  prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0);
  status_.memory_locked = lock_memory();
  status_.fifo = enter_fifo(priority);
  if (!status_.fifo) {
    status_.notice =
        "The servo loop runs without real-time priority, so other programs can delay it; permit "
        "it with `ulimit -r 80` (rtprio in /etc/security/limits.conf) or CAP_SYS_NICE.";
  }
  if (!status_.memory_locked) {
    status_.notice += status_.notice.empty() ? "" : " ";
    status_.notice +=
        "The memory of the servo loop is not locked, so a page fault can delay it; permit it with "
        "`ulimit -l unlimited` (memlock in /etc/security/limits.conf) or CAP_IPC_LOCK.";
  }
}

RealTimeScope::~RealTimeScope() {
  if (status_.fifo &&
      pthread_setschedparam(pthread_self(), previous_policy_, &previous_param_) != 0) {
    // Taking the flag back needs a privilege that a user with an rtprio limit does not have.
    pthread_setschedparam(pthread_self(), previous_policy_ | SCHED_RESET_ON_FORK, &previous_param_);
  }
  if (previous_slack_ > 0) {
    prctl(PR_SET_TIMERSLACK, static_cast<unsigned long>(previous_slack_), 0, 0, 0);
  }
}

}  // namespace haptrial::realtime
