#pragma once

namespace haptrial::experiments {

/// Whether the program was asked to stop. Any thread.
bool interrupted() noexcept;
/// Asks it to stop, as a signal does (signals.h). Any thread.
void interrupt() noexcept;

/// Sets a callback that the signal's handler calls as well, with `with`: only what a handler may do
/// (an atomic store). Null: nobody. Any thread.
void call_on_interrupt(void (*call)(void*), void* with) noexcept;

}  // namespace haptrial::experiments
