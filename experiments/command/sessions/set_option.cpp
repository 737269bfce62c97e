#include "experiments/command/sessions/set_option.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "core/base/error.h"

namespace haptrial::experiments {

void declare_set_option(CLI::App& app, std::vector<std::string>& set) {
  app.add_option("--set", set,
                 "KEY=VALUE: a key of the definition that has another value, as a definition "
                 "writes it, such as observer.lapse=0.05; may be repeated")
      ->expected(1)
      ->take_all();
}

std::vector<GivenKey> given_keys(const std::vector<std::string>& set) {
  std::vector<GivenKey> given;
  for (const std::string& each : set) {
    const std::size_t at = each.find('=');
    if (at == 0 || at == std::string::npos) {
      throw InputError(
          fmt::format("--set is \"{}\"; allowed: KEY=VALUE, such as observer.reaction=0.5", each));
    }
    given.push_back({each.substr(0, at), each.substr(at + 1)});
  }
  return given;
}

}  // namespace haptrial::experiments
