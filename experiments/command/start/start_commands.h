#pragma once

#include <string>

namespace haptrial::experiments {

// Each subcommand prints to standard output and returns an exit status. Bad input and failures come
// as InputError and RunError.

/// The shipped definitions.
int list_examples();

struct NewOptions {
  std::string file;
  std::string from{"first_experiment"};  // of the shipped definitions
};
int new_definition(const NewOptions& options);

/// What this machine can do. @param folder  where session files are to go
/// @returns 0 if sessions can run, else 1
int doctor(const std::string& folder);

}  // namespace haptrial::experiments
