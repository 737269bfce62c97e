#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "experiments/command/start/examples.h"
#include "experiments/command/start/start_commands.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {
namespace {

std::filesystem::path definition_file(const std::string& given) {
  std::filesystem::path file(given);
  if (file.extension().empty()) {
    file += ".toml";
  }
  if (file.extension() != ".toml" || file.stem().empty()) {
    throw InputError(fmt::format("FILE is '{}'; allowed: a name that ends in .toml", given));
  }
  return file;
}

}  // namespace

int new_definition(const NewOptions& options) {
  const std::filesystem::path file = definition_file(options.file);
  const Example& example = example_named(options.from);
  const std::string text = renamed(example, file.stem().string());
  const Experiment experiment = parse_experiment(text, file.string());  // the name may be none
  WholeFile out(file);
  out.write(text);
  out.finish();
  fmt::print("{}: a copy of {}, to be changed; haptrial keys {} lists every key\n", file.string(),
             example.name, experiment.study->protocol().name());
  fmt::print("next: haptrial validate {0}\n      haptrial dry-run {0} --subjects 2\n",
             file.string());
  return 0;
}

}  // namespace haptrial::experiments
