#include "experiments/control/interrupt.h"

#include <atomic>

namespace haptrial::experiments {
namespace {

std::atomic<bool> asked{false};
std::atomic<void (*)(void*)> hook{nullptr};
std::atomic<void*> hook_with{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free);  // so that a signal handler may set it

}  // namespace

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
