#pragma once

#include <functional>
#include <memory>
#include <string>

namespace CLI {
class App;
}

namespace haptrial::experiments {

// A subcommand is one file, command_NAME.cpp: the struct of its options with their defaults, the
// function that does the work, and add_NAME(), which gives its name, help and options. Bad input
// and failures come as InputError and RunError. `status` is that of declare_subcommands().

/// Notes of the help below the options, apart from the example.
struct HelpNotes {
  const char* writes{""};  // files: "Writes WRITES."
  const char* page{""};    // below docs/
};

/// @param example  a line that may be typed, below the options in the help of the subcommand
CLI::App* subcommand(CLI::App& app, const char* name, const char* what, const char* example,
                     const HelpNotes& notes = {});

/// Runs `command` once a line with the subcommand was read; `status` becomes what it returns.
void run_when_read(CLI::App& sub, int& status, std::function<int()> command);

/// Options that live as long as the subcommand that fills them; the command gets them once the
/// line was read.
template <class Options, class Command>
Options& options_of(CLI::App& sub, int& status, Command command) {
  auto options = std::make_shared<Options>();
  run_when_read(sub, status, [options, command] { return command(*options); });
  return *options;
}

/// "Step [s] (default: 0.001)": the help of an option with the default that its struct has.
std::string with_default(const std::string& help, const std::string& value);
std::string with_default(const std::string& help, double value);

// Every subcommand, by folder.

// start: before the first session
void add_examples(CLI::App& app, int& status);
void add_new(CLI::App& app, int& status);
void add_set(CLI::App& app, int& status);
void add_texts(CLI::App& app, int& status);
void add_doctor(CLI::App& app, int& status);
void add_keys(CLI::App& app, int& status);
void add_show(CLI::App& app, int& status);
void add_plan(CLI::App& app, int& status);
void add_studio(CLI::App& app, int& status);

// sessions: to run them, look into them, mend and show them; definitions and devices
void add_dry_run(CLI::App& app, int& status);
void add_start(CLI::App& app, int& status);
void add_run(CLI::App& app, int& status);
void add_secret(CLI::App& app, int& status);
void add_roster(CLI::App& app, int& status);
void add_next(CLI::App& app, int& status);
void add_withdraw(CLI::App& app, int& status);
void add_info(CLI::App& app, int& status);
void add_record(CLI::App& app, int& status);
void add_recover(CLI::App& app, int& status);
void add_replay(CLI::App& app, int& status);
void add_validate(CLI::App& app, int& status);
void add_devices(CLI::App& app, int& status);
void add_device_test(CLI::App& app, int& status);

// analysis, curves: recorded data, of here or elsewhere; sizes of studies
void add_analyze(CLI::App& app, int& status);
void add_export(CLI::App& app, int& status);
void add_import(CLI::App& app, int& status);
void add_evaluate(CLI::App& app, int& status);
void add_exam(CLI::App& app, int& status);
void add_exam_make(CLI::App& exam, int& status);
void add_exam_run(CLI::App& exam, int& status);
void add_exam_score(CLI::App& exam, int& status);
void add_statistics(CLI::App& app, int& status);
void add_align(CLI::App& app, int& status);
void add_compare(CLI::App& app, int& status);
void add_judge(CLI::App& app, int& status);
void add_power(CLI::App& app, int& status);
void add_power_simulate(CLI::App& power, int& status);
void add_power_merge(CLI::App& power, int& status);
void add_power_status(CLI::App& power, int& status);
void add_power_plan(CLI::App& power, int& status);

// tools: surface meshes, sounds of drills
void add_mesh(CLI::App& app, int& status);
void add_spectrum(CLI::App& app, int& status);

// bone: bones, and drillings in them
void add_bone(CLI::App& app, int& status);
void add_bone_import(CLI::App& bone, int& status);
void add_bone_atlas(CLI::App& bone, int& status);
void add_bone_info(CLI::App& bone, int& status);
void add_bone_structures(CLI::App& bone, int& status);
void add_bone_export(CLI::App& bone, int& status);
void add_bone_make(CLI::App& bone, int& status);
void add_bone_picture(CLI::App& bone, int& status);
void add_bone_stages(CLI::App& bone, int& status);
void add_bone_place(CLI::App& bone, int& status);
void add_bone_page(CLI::App& bone, int& status);
void add_bone_safe(CLI::App& bone, int& status);
void add_bone_score(CLI::App& bone, int& status);
void add_bone_fit_feel(CLI::App& bone, int& status);
void add_bone_phases(CLI::App& bone, int& status);
void add_bone_class(CLI::App& bone, int& status);
void add_rate(CLI::App& app, int& status);
void add_rate_simulate(CLI::App& rate, int& status);

// deform: bodies that give way
void add_deform(CLI::App& app, int& status);
void add_deform_info(CLI::App& deform, int& status);
void add_deform_reference(CLI::App& deform, int& status);
void add_deform_calibrate(CLI::App& deform, int& status);
void add_deform_simulate(CLI::App& deform, int& status);
void add_deform_skin(CLI::App& deform, int& status);

}  // namespace haptrial::experiments
