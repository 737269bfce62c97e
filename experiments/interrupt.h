#pragma once

namespace haptrial::experiments {

/// From now on SIGINT and SIGTERM ask the program to stop; a second one ends it at once.
void watch_for_interrupt();
bool interrupted() noexcept;  // any thread

}  // namespace haptrial::experiments
