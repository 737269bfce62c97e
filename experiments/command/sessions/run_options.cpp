#include "experiments/command/sessions/run_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "core/base/error.h"
#include "experiments/study/session_name.h"
#include "protocols/definition/definition.h"
#include "protocols/definition/room.h"

namespace haptrial::experiments {

std::string session_folder(const RunOptions& options) {
  return !options.out.empty() ? options.out : options.teach ? "out/teaching" : "out/sessions";
}

std::filesystem::path session_file(const RunOptions& options, const protocols::Definition& setup) {
  return std::filesystem::path(session_folder(options)) /
         session_file_name(options.subject, options.session.value_or(1), setup.sessions());
}

std::string backup_folder(const RunOptions& options, const protocols::Definition& setup) {
  return options.backup.empty() ? protocols::room_of(setup.root()).backup : options.backup;
}

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
