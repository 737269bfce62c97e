#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "core/base/definition/given_values.h"
#include "core/base/definition/removed_keys.h"
#include "core/base/definition/stated_keys.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/experiment.h"
#include "protocols/definition/lab_file.h"

namespace haptrial::experiments {
namespace {

struct SetOptions {
  std::string file;
  GivenKey given;
  bool remove{false};
  bool add{false};
  bool list{false};
  bool json{false};
  std::string output;
};

/// Every key that the definition states, a line each, or as JSON.
void print_keys(const SetOptions& o, const std::string& text) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const StatedKey& each : stated_keys(text, o.file)) {
    if (o.json) {
      all.push_back(
          {{"key", each.key}, {"value", each.value}, {"line", each.line}, {"table", each.table}});
    } else if (!each.table) {
      fmt::print("{}: {} = {}\n", each.line, each.key, each.value);
    }
  }
  if (o.json) {
    fmt::print("{}\n", all.dump());
  }
}

/// The text after the one edit that the line asks for.
std::string edited(const SetOptions& o, const std::string& text) {
  if (o.given.key.empty()) {
    throw InputError("give KEY and VALUE, or --list");
  }
  if ((o.given.value.empty() ? 0 : 1) + (o.remove ? 1 : 0) + (o.add ? 1 : 0) != 1) {
    throw InputError(fmt::format("{}: give a value, --remove or --add", o.given.key));
  }
  if (const std::filesystem::path lab = protocols::lab_with(o.file, o.given.key); !lab.empty()) {
    throw InputError(
        fmt::format("{}: the table of {} stands in its lab file; change it there: "
                    "haptrial set {} ...",
                    o.file, o.given.key, lab.string()));
  }
  if (o.remove) {
    return without_key(text, o.file, o.given.key);
  }
  return o.add ? with_new_entry(text, o.file, o.given.key)
               : with_values(text, o.file, std::span(&o.given, 1));
}

/// The problem that keeps the file from being an experiment; empty: there is none.
std::string problem_of(const std::string& file) {
  try {
    load_experiment(file);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// Writes the text, and says what was in order before and is no longer. A change in several steps
/// may pass through such a file, so that it is written all the same.
void write_edited(const SetOptions& o, const std::string& text) {
  const std::string file = o.output.empty() ? o.file : o.output;
  const bool was_valid = problem_of(o.file).empty();
  write_whole(file, text);
  const std::string problem = was_valid ? problem_of(file) : "";
  if (!problem.empty()) {
    fmt::print(stderr, "haptrial: {}\nhaptrial: {} is written, and is not valid any more\n",
               problem, file);
  }
}

int set(const SetOptions& options) {
  if (options.list) {
    print_keys(options, file_text(options.file));
    return 0;
  }
  const std::string text = edited(options, file_text(options.file));
  if (options.output == "-") {
    fmt::print("{}", text);
  } else {
    write_edited(options, text);
  }
  return 0;
}

}  // namespace

void add_set(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "set", "Change one key of a definition; every other byte stays",
                             "haptrial set my_study.toml design.participants 24",
                             {"FILE", "guide-own-experiment.md#change-one-key"});
  auto& o = options_of<SetOptions>(*sub, status, set);
  sub->add_option("FILE", o.file, "The definition (.toml)")->required();
  sub->add_option("KEY", o.given.key,
                  "Path of the key, with the name or number (from 1) of an entry: "
                  "blocks.hard.shift");
  sub->add_option("VALUE", o.given.value,
                  "As the definition writes it: 24, 0.05, true, '\"a text\"', '[1, 2]'");
  sub->add_flag("--remove", o.remove, "Remove the key, table or entry; comments stay");
  sub->add_flag("--add", o.add, "Add an empty entry to the array of tables KEY");
  auto* list = sub->add_flag("--list", o.list, "Print every key that the definition states")
                   ->excludes("KEY");
  sub->add_flag("--json", o.json, "Print the list as JSON, with lines and tables")->needs(list);
  sub->add_option("--output", o.output, "Write another file; - prints the text (default: FILE)");
}

}  // namespace haptrial::experiments
