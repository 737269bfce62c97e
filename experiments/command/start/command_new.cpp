#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "experiments/command/start/examples.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {
namespace {

struct NewOptions {
  std::string file;
  std::string from{"first_experiment"};
};

std::filesystem::path definition_file(const std::string& given) {
  std::filesystem::path file(given);
  if (file.extension().empty()) {
    file += ".toml";
  }
  if (file.extension() != ".toml" || file.stem().empty()) {
    throw InputError(fmt::format("FILE is '{}'; allowed: a name that ends in .toml", given));
  }
  const bool plain = std::ranges::all_of(file.stem().string(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
  if (!plain) {
    throw InputError(
        fmt::format("FILE is '{}', whose name is to be that of the study; allowed: letters, "
                    "digits, '-' and '_'",
                    given));
  }
  return file;
}

int new_definition(const NewOptions& options) {
  const std::filesystem::path file = definition_file(options.file);
  const Example& example = example_named(options.from);
  const std::string text = renamed(example, file.stem().string());
  const Experiment experiment = parse_experiment(text, file.string());
  WholeFile out(file);
  out.write(text);
  out.finish();
  fmt::print("{}: a copy of {}, to be changed; haptrial keys {} lists every key\n", file.string(),
             example.name, experiment.study->protocol().name());
  fmt::print("next: haptrial validate {0}\n      haptrial dry-run {0} --subjects 2\n",
             file.string());
  return 0;
}

}  // namespace

void add_new(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "new", "Begin a definition of one's own from a shipped one",
                             "haptrial new my_study.toml --from stiffness_discrimination",
                             {"FILE", "guide-own-experiment.md"});
  auto& o = options_of<NewOptions>(*sub, status, new_definition);
  sub->add_option("FILE", o.file, "The definition to be written (.toml)")->required();
  sub->add_option("--from", o.from, with_default("One that haptrial examples lists", o.from));
}

}  // namespace haptrial::experiments
