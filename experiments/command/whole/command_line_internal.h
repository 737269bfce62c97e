#pragma once

namespace CLI {
class App;
}

namespace haptrial::experiments {

// Who adds the subcommands that no protocol's sessions need, as in command_lines.h.

// command_line_start.cpp: before the first session
void add_examples(CLI::App& app, int& status);
void add_new(CLI::App& app, int& status);
void add_doctor(CLI::App& app, int& status);
void add_keys(CLI::App& app, int& status);

void add_evaluate(CLI::App& app, int& status);  // command_line_contact.cpp
void add_mesh(CLI::App& app, int& status);      // command_line_mesh.cpp
void add_bone(CLI::App& app, int& status);      // command_line_bone.cpp
void add_deform(CLI::App& app, int& status);    // command_line_deform.cpp
void add_spectrum(CLI::App& app, int& status);  // command_line_sound.cpp
void add_rate(CLI::App& app, int& status);      // command_line_rating.cpp

// command_line_power.cpp: subcommands of power
void add_simulated_power(CLI::App& power, int& status);

}  // namespace haptrial::experiments
