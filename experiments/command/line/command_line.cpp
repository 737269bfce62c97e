#include "experiments/command/line/command_line.h"

#include <CLI/CLI.hpp>
#include <string>

#include "experiments/command/start/examples.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {

namespace {

/// Wherever a definition is asked for, a shipped one may be named.
void accept_examples(CLI::App& app) {
  for (CLI::App* sub : app.get_subcommands({})) {
    accept_examples(*sub);
  }
  for (CLI::Option* option : app.get_options()) {
    if (option->get_name() == "DEFINITION") {
      option->transform(CLI::Validator(
          [](std::string& given) {
            given = definition_or_example(given);
            return std::string();
          },
          ""));
    }
  }
}

}  // namespace

void declare_subcommands(CLI::App& app, int& status) {
  add_examples(app, status);
  add_new(app, status);
  add_set(app, status);
  add_texts(app, status);
  add_doctor(app, status);
  add_studio(app, status);
  add_dry_run(app, status);
  add_start(app, status);
  add_run(app, status);
  add_secret(app, status);
  add_roster(app, status);
  add_next(app, status);
  add_withdraw(app, status);
  add_analyze(app, status);
  add_export(app, status);
  add_import(app, status);
  add_align(app, status);
  add_evaluate(app, status);
  add_exam(app, status);
  add_compare(app, status);
  add_judge(app, status);
  add_statistics(app, status);
  add_info(app, status);
  add_record(app, status);
  add_recover(app, status);
  add_replay(app, status);
  add_validate(app, status);
  add_show(app, status);
  add_plan(app, status);
  add_keys(app, status);
  add_power(app, status);
  add_devices(app, status);
  add_device_test(app, status);
  add_mesh(app, status);
  add_bone(app, status);
  add_deform(app, status);
  add_spectrum(app, status);
  add_rate(app, status);
  accept_examples(app);
}

}  // namespace haptrial::experiments
