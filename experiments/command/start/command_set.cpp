#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <span>
#include <string>

#include "core/base/definition/given_values.h"
#include "core/base/definition/removed_keys.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct SetOptions {
  std::string file;
  GivenKey given;
  bool remove{false};
  bool add{false};
  std::string output;
};

/// The text after the one edit that the line asks for.
std::string edited(const SetOptions& o, const std::string& text) {
  if ((o.given.value.empty() ? 0 : 1) + (o.remove ? 1 : 0) + (o.add ? 1 : 0) != 1) {
    throw InputError(fmt::format("{}: give a value, --remove or --add", o.given.key));
  }
  if (o.remove) {
    return without_key(text, o.file, o.given.key);
  }
  return o.add ? with_new_entry(text, o.file, o.given.key)
               : with_values(text, o.file, std::span(&o.given, 1));
}

int set(const SetOptions& options) {
  const std::string text = edited(options, file_text(options.file));
  if (options.output == "-") {
    fmt::print("{}", text);
  } else {
    write_whole(options.output.empty() ? options.file : options.output, text);
  }
  return 0;
}

}  // namespace

void add_set(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "set", "Change one key of a definition; every other byte stays",
                 "haptrial set my_study.toml design.participants 24",
                 {"FILE", "guide-own-experiment.md#change-one-key"});
  auto& o = options_of<SetOptions>(*sub, status, set);
  sub->add_option("FILE", o.file, "The definition (.toml)")->required();
  sub->add_option("KEY", o.given.key,
                  "Path of the key, with the name or number (from 1) of an entry: "
                  "blocks.hard.shift")
      ->required();
  sub->add_option("VALUE", o.given.value,
                  "As the definition writes it: 24, 0.05, true, '\"a text\"', '[1, 2]'");
  sub->add_flag("--remove", o.remove, "Remove the key, table or entry; comments stay");
  sub->add_flag("--add", o.add, "Add an empty entry to the array of tables KEY");
  sub->add_option("--output", o.output, "Write another file; - prints the text (default: FILE)");
}

}  // namespace haptrial::experiments
