#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "core/tutoring/secret.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

int make_secret(const std::string& file) {
  tutoring::Secret::make(file);
  fmt::print(
      "{}: a new secret; copy it to the other machine by a way that nobody else can read, and keep "
      "it out of folders of results\n",
      file);
  return 0;
}

}  // namespace

void add_secret(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "secret", "Make the secret that two linked sessions share",
                 "haptrial secret tutoring.secret",
                 {"a file that only you may read; copy it to the other machine by a safe way",
                  "guide-experimenter.md"});
  auto& file = options_of<std::string>(*sub, status, make_secret);
  sub->add_option("FILE", file, "New file")->required();
}

}  // namespace haptrial::experiments
