#pragma once

namespace haptrial::experiments {

/// From now on SIGINT, SIGTERM and a closed terminal (SIGHUP, unless it was ignored) ask the
/// program to stop; a second SIGINT or SIGTERM ends it at once, once the force is zero.
void watch_for_interrupt();
bool interrupted() noexcept;  // any thread
/// As such a signal does. Any thread.
void interrupt() noexcept;

/// Called from the signal's handler as well, with `with`: only what a handler may do (an atomic
/// store). Null: nobody. Any thread.
void call_on_interrupt(void (*call)(void*), void* with) noexcept;

}  // namespace haptrial::experiments
