#pragma once

#include <functional>
#include <source_location>
#include <string>

namespace haptrial::test {

/// Waits until the condition holds, for as long as it takes: a busy machine is slow, and a hang is
/// ended by the test runner's time limit. Says on standard error once a minute where it waits.
/// @param condition  asked every 10 ms  @param state  what it says besides; may be empty
void wait_until(const std::function<bool()>& condition,
                const std::source_location& where = std::source_location::current(),
                const std::function<std::string()>& state = {});

/// Watches for something that must not happen. A slow machine may miss it, so that a test may
/// expect false, never true.
/// @returns whether the condition held at any time during these seconds
bool happens_within(double seconds, const std::function<bool()>& condition);

}  // namespace haptrial::test
