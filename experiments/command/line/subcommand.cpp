#include "experiments/command/line/subcommand_internal.h"

#include <fmt/format.h>

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

}  // namespace haptrial::experiments
