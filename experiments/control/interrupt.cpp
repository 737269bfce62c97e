#include "experiments/control/interrupt.h"

#include <atomic>
#include <csignal>

#include "experiments/control/keyboard.h"
#include "experiments/control/last_stop.h"

namespace haptrial::experiments {
namespace {

std::atomic<bool> asked{false};
std::atomic<void (*)(void*)> hook{nullptr};
std::atomic<void*> hook_with{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free);  // so that a signal handler may set it

extern "C" void on_signal(int signal) {
  interrupt();
  restore_terminal();
  if (signal != SIGHUP) {  // a shell and the system may both tell of a closed terminal
    std::signal(signal, stop_and_die);
  }
}

}  // namespace

void watch_for_interrupt() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) {
    std::signal(SIGHUP, SIG_IGN);  // nohup: the session is to outlive its terminal
  }
}

bool interrupted() noexcept { return asked.load(); }

void interrupt() noexcept {
  asked.store(true);
  if (const auto call = hook.load()) {
    call(hook_with.load());
  }
}

void call_on_interrupt(void (*call)(void*), void* with) noexcept {
  hook.store(nullptr);
  hook_with.store(with);
  hook.store(call);
}

}  // namespace haptrial::experiments
