#include "experiments/command/line/command_line.h"

#include <fmt/format.h>

#include "experiments/command/line/command_line_internal.h"

namespace haptrial::experiments {

CLI::App* subcommand(CLI::App& app, const char* name, const char* what, const char* example,
                     const HelpNotes& notes) {
  CLI::App* sub = app.add_subcommand(name, what);
  std::string footer = fmt::format("Example:\n  {}\n", example);
  if (*notes.writes != '\0') {
    footer += fmt::format("\nWrites {}.", notes.writes);
  }
  if (*notes.page != '\0') {
    footer += fmt::format("\nDocumentation: docs/{}", notes.page);
  }
  footer += "\nExit status: 0 done, 1 failed, 2 bad input.";
  sub->footer(footer);
  return sub;
}

void declare_subcommands(CLI::App& app, int& status) {
  add_examples(app, status);
  add_new(app, status);
  add_doctor(app, status);
  add_dry_run(app, status);
  add_run(app, status);
  add_secret(app, status);
  add_roster(app, status);
  add_analyze(app, status);
  add_export(app, status);
  add_align(app, status);
  add_evaluate(app, status);
  add_compare(app, status);
  add_statistics(app, status);
  add_info(app, status);
  add_recover(app, status);
  add_replay(app, status);
  add_validate(app, status);
  add_keys(app, status);
  add_power(app, status);
  add_devices(app, status);
  add_device_test(app, status);
  add_mesh(app, status);
  add_bone(app, status);
  add_deform(app, status);
  add_spectrum(app, status);
  add_rate(app, status);
}

}  // namespace haptrial::experiments
