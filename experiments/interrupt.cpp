#include "experiments/interrupt.h"

#include <atomic>
#include <csignal>

namespace haptrial::experiments {
namespace {

std::atomic<bool> asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // so that a signal handler may set it

extern "C" void on_signal(int signal) {
  asked.store(true);
  std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_for_interrupt() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupted() noexcept { return asked.load(); }

}  // namespace haptrial::experiments
