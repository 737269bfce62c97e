#pragma once

#include <filesystem>

#include "core/base/error.h"

namespace haptrial::experiments {

/// @param sessions  a session file, or a folder of them; files that are no sessions are passed over
/// @throws InputError for the first session whose definition this program cannot read, as when the
///         program of a lab recorded it with kinds of its own; the sentence names the missing kind
void check_recorded_kinds(const std::filesystem::path& sessions);

/// Returns what action() returns. If it refuses the sessions and kinds of their definitions are
/// missing, the sentence says which.
template <class Action>
auto with_recorded_kinds(const std::filesystem::path& sessions, Action action) {
  try {
    return action();
  } catch (const InputError&) {
    check_recorded_kinds(sessions);
    throw;
  }
}

}  // namespace haptrial::experiments
