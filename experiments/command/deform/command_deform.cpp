#include <CLI/CLI.hpp>

#include "experiments/command/subcommand.h"

namespace haptrial::experiments {

void add_deform(CLI::App& app, int& status) {
  CLI::App* deform = subcommand(app, "deform", "Compute, calibrate and move bodies that give way",
                                "haptrial deform info gear.toml", {"", "guide-deformable.md"});
  deform->require_subcommand(1);
  add_deform_info(*deform, status);
  add_deform_reference(*deform, status);
  add_deform_calibrate(*deform, status);
  add_deform_simulate(*deform, status);
  add_deform_skin(*deform, status);
}

}  // namespace haptrial::experiments
