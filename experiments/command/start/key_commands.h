#pragma once

#include <string>

namespace haptrial::experiments {

// Each subcommand prints to standard output and returns an exit status. Bad input and failures come
// as InputError and RunError.

/// The keys of definitions.
/// @param word  a protocol, or a word to search for; empty: all keys
int keys(const std::string& word);

}  // namespace haptrial::experiments
