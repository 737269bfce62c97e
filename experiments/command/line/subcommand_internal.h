#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

namespace haptrial::experiments {

// How a file that adds subcommands describes them. `status` is that of declare_subcommands().

/// Notes of the help below the options, apart from the example.
struct HelpNotes {
  const char* writes{""};  // files: "Writes WRITES."
  const char* page{""};    // below docs/
};

/// @param example  a line that may be typed, below the options in the help of the subcommand
CLI::App* subcommand(CLI::App& app, const char* name, const char* what, const char* example,
                     const HelpNotes& notes = {});

/// Options that live as long as the subcommand that fills them; the command gets them once the
/// line was read.
template <class Options, class Command>
Options& options_of(CLI::App& sub, int& status, Command command) {
  auto options = std::make_shared<Options>();
  sub.callback([options, &status, command] { status = command(*options); });
  return *options;
}

}  // namespace haptrial::experiments
