#include "experiments/command/subcommand.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <utility>

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

void run_when_read(CLI::App& sub, int& status, std::function<int()> command) {
  sub.callback([&status, command = std::move(command)] { status = command(); });
}

std::string with_default(const std::string& help, const std::string& value) {
  return fmt::format("{} (default: {})", help, value);
}

std::string with_default(const std::string& help, double value) {
  return with_default(help, fmt::format("{}", value));
}

}  // namespace haptrial::experiments
