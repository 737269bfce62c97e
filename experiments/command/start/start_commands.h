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

struct TextsOptions {
  std::string definition;
  std::string language;
};
/// Writes the file of a definition's texts in a language, to be filled in.
int write_texts(const TextsOptions& options);

/// Prints what this machine can do. @param where  a folder for session files, or a definition whose
/// sessions are to run here, into files below the working folder
/// @returns 0 if sessions can run, else 1
int doctor(const std::string& where);

}  // namespace haptrial::experiments
