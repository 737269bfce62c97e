#include "experiments/command/whole/whole_command.h"

#include "experiments/command/line/run_line.h"
#include "experiments/command/whole/command_line.h"
#include "experiments/studies/shipped/shipped_studies.h"

namespace haptrial::experiments {

int whole_command(int argc, char** argv, const std::function<void()>& add_own) {
  return exit_status([&] {
    add_shipped_studies();
    if (add_own) {
      add_own();
    }
    return run_line({argv, static_cast<std::size_t>(argc)}, declare_subcommands);
  });
}

}  // namespace haptrial::experiments
