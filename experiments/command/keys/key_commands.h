#pragma once

#include <string>

namespace haptrial::experiments {

// Each subcommand prints to standard output and returns an exit status. Bad input and failures come
// as InputError and RunError.

/// The keys of definitions.
/// @param protocol  empty: all
int keys(const std::string& protocol);

}  // namespace haptrial::experiments
