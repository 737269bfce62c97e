#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "experiments/command/commands.h"

namespace haptrial::experiments {

// What only the files command_line*.cpp share: who adds which subcommand, and how. `status` is that
// of declare_subcommands().

// command_line_start.cpp: before the first session
void add_examples(CLI::App& app, int& status);
void add_new(CLI::App& app, int& status);
void add_doctor(CLI::App& app, int& status);

// command_line_sessions.cpp: to run sessions, look into them, mend and show them
void add_dry_run(CLI::App& app, int& status);
void add_run(CLI::App& app, int& status);
void add_secret(CLI::App& app, int& status);
void add_roster(CLI::App& app, int& status);
void add_info(CLI::App& app, int& status);
void add_recover(CLI::App& app, int& status);
void add_replay(CLI::App& app, int& status);
void add_validate(CLI::App& app, int& status);
void add_keys(CLI::App& app, int& status);
void add_devices(CLI::App& app, int& status);
void add_device_test(CLI::App& app, int& status);

// command_line_analysis.cpp: what was recorded, here or elsewhere
void add_analyze(CLI::App& app, int& status);
void add_export(CLI::App& app, int& status);
void add_align(CLI::App& app, int& status);
void add_evaluate(CLI::App& app, int& status);
void add_compare(CLI::App& app, int& status);
void add_statistics(CLI::App& app, int& status);
void add_power(CLI::App& app, int& status);
// command_line_power.cpp: subcommands of it
void add_simulated_power(CLI::App& power, int& status);

void add_mesh(CLI::App& app, int& status);      // command_line_mesh.cpp
void add_bone(CLI::App& app, int& status);      // command_line_bone.cpp
void add_deform(CLI::App& app, int& status);    // command_line_deform.cpp
void add_spectrum(CLI::App& app, int& status);  // command_line_sound.cpp
void add_rate(CLI::App& app, int& status);      // command_line_rating.cpp

/// What the help says below the options, apart from the example.
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
