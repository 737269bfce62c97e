#pragma once

namespace CLI {
class App;
}

namespace haptrial::experiments {

// Each function adds a subcommand. Parsing a line runs the one that it gives.
// @param status  becomes its exit status; outlives app

// command_line_start.cpp: before the first session
void add_examples(CLI::App& app, int& status);
void add_new(CLI::App& app, int& status);
void add_texts(CLI::App& app, int& status);
void add_doctor(CLI::App& app, int& status);
void add_keys(CLI::App& app, int& status);

// command_line_sessions.cpp: to run sessions, look into them, mend and show them
void add_dry_run(CLI::App& app, int& status);
void add_run(CLI::App& app, int& status);
void add_secret(CLI::App& app, int& status);
void add_roster(CLI::App& app, int& status);
void add_info(CLI::App& app, int& status);
void add_recover(CLI::App& app, int& status);
void add_replay(CLI::App& app, int& status);
void add_validate(CLI::App& app, int& status);
void add_devices(CLI::App& app, int& status);
void add_device_test(CLI::App& app, int& status);

// command_line_analysis.cpp: what was recorded, here or elsewhere
void add_analyze(CLI::App& app, int& status);
void add_export(CLI::App& app, int& status);
void add_align(CLI::App& app, int& status);
void add_compare(CLI::App& app, int& status);
void add_statistics(CLI::App& app, int& status);
void add_power(CLI::App& app, int& status);

void add_evaluate(CLI::App& app, int& status);  // command_line_contact.cpp
void add_mesh(CLI::App& app, int& status);      // command_line_mesh.cpp
void add_bone(CLI::App& app, int& status);      // command_line_bone.cpp
void add_deform(CLI::App& app, int& status);    // command_line_deform.cpp
void add_spectrum(CLI::App& app, int& status);  // command_line_sound.cpp
void add_rate(CLI::App& app, int& status);      // command_line_rating.cpp

// command_line_power.cpp: subcommands of power
void add_simulated_power(CLI::App& power, int& status);

}  // namespace haptrial::experiments
