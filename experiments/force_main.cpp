// haptrial with the force studies alone: what quickstart.sh builds first.
#include <CLI/CLI.hpp>

#include "experiments/command/line/command_lines.h"
#include "experiments/command/line/run_line.h"
#include "experiments/studies/force/force_study.h"
#include "experiments/studies/registry.h"

namespace {

using namespace haptrial::experiments;

void declare(CLI::App& app, int& status) {
  app.name("haptrial_forces");
  app.description(
      "Run studies of force training, record them and analyse the results; haptrial has every "
      "other experiment, too.");
  add_dry_run(app, status);
  add_run(app, status);
  add_analyze(app, status);
  add_export(app, status);
  add_info(app, status);
  add_recover(app, status);
  add_replay(app, status);
  add_validate(app, status);
}

}  // namespace

int main(int argc, char** argv) {
  return exit_status([&] {
    add_study(force_study());
    return run_line({argv, static_cast<std::size_t>(argc)}, declare);
  });
}
