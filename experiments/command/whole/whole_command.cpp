#include "experiments/command/whole/whole_command.h"

#include <cstdlib>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "experiments/command/line/run_line.h"
#include "experiments/command/whole/command_line.h"
#include "experiments/plugin/load_plugin.h"
#include "experiments/studies/registry.h"
#include "experiments/studies/shipped/shipped_studies.h"

namespace haptrial::experiments {
namespace {

/// The line without --plugin FILE, wherever it stands: plug-ins are loaded before the other words
/// are read, since they decide what may stand there.
std::vector<char*> load_named_plugins(int argc, char** argv) {
  if (const char* folder = std::getenv("HAPTRIAL_PLUGINS"); folder != nullptr && *folder != '\0') {
    load_plugins(folder);
  }
  constexpr std::string_view kJoined = "--plugin=";
  std::vector<char*> rest;
  for (int i = 0; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--") {
      rest.insert(rest.end(), argv + i, argv + argc);
      break;
    }
    if (word != "--plugin" && !word.starts_with(kJoined)) {
      rest.push_back(argv[i]);
      continue;
    }
    const std::string_view next = i + 1 < argc ? argv[i + 1] : "";
    const std::string_view file = word == "--plugin" ? next : word.substr(kJoined.size());
    i += word == "--plugin" ? 1 : 0;
    if (file.empty()) {
      throw InputError("--plugin has no value; write a file (.so) after it");
    }
    load_plugin(file);
  }
  return rest;
}

}  // namespace

int whole_command(int argc, char** argv, std::span<const Study* const> own) {
  return exit_status([&] {
    add_shipped_studies();
    for (const Study* study : own) {
      add_study(*study);
    }
    return run_line(load_named_plugins(argc, argv), declare_subcommands);
  });
}

}  // namespace haptrial::experiments
