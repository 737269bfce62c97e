#pragma once

#include <string>

namespace haptrial::experiments {

// Each subcommand prints to standard output and returns an exit status. Bad input and failures come
// as InputError and RunError.

struct KeysOptions {
  std::string word;         // a protocol, or a word to search for; empty: all keys
  bool json_schema{false};  // of the protocol that `word` names
};

/// The keys of definitions.
int keys(const KeysOptions& options);

}  // namespace haptrial::experiments
