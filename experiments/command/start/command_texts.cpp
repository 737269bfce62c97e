#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/experiment.h"
#include "protocols/definition/languages.h"

namespace haptrial::experiments {
namespace {

struct TextsOptions {
  std::string definition;
  std::string language;
};

/// A text in quotes. The escapes of JSON are among those of TOML.
std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }

/// "response.choices.\"a b\".label": the parts of a key that are no bare keys stand in quotes.
std::string toml_key(const std::string& key) {
  std::vector<std::string> parts;
  for (std::size_t from = 0; from <= key.size();) {
    const std::size_t to = std::min(key.find('.', from), key.size());
    const std::string part = key.substr(from, to - from);
    const bool bare = !part.empty() && std::ranges::all_of(part, [](unsigned char c) {
      return c < 0x80 && (std::isalnum(c) != 0 || c == '-' || c == '_');
    });
    parts.push_back(bare ? part : quoted(part));
    from = to + 1;
  }
  return fmt::format("{}", fmt::join(parts, "."));
}

int write_texts(const TextsOptions& options) {
  protocols::check_language(options.language);
  const std::filesystem::path definition(options.definition);
  if (const auto there = protocols::language_file(definition, options.language); !there.empty()) {
    throw InputError(fmt::format(
        "{}: exists already; haptrial validate names each text that it lacks", there.string()));
  }
  const Experiment experiment = load_experiment(definition);
  const auto own_words = protocols::program_words(options.language);
  std::string text = fmt::format(
      "# What participants of {} read, in another language: haptrial run … --language {}\n"
      "# Translate a text and take the # before it away. One that keeps its # is shown as the\n"
      "# definition has it.\n",
      experiment.definition->name, options.language);
  std::size_t count = 0;
  for (const ShownText& shown : experiment.shown) {
    if (!own_words.contains(shown.text)) {
      text += fmt::format("# {} = {}\n", toml_key(shown.key), quoted(shown.text));
      ++count;
    }
  }
  WholeFile out(protocols::own_language_file(definition, options.language));
  out.write(text);
  out.finish();
  fmt::print("{}: {} texts to translate\n", out.file().string(), count);
  fmt::print("next: haptrial validate {}\n", options.definition);
  return 0;
}

}  // namespace

void add_texts(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(app, "texts", "Begin the file of a definition's texts in a language",
                             "haptrial texts first_experiment --language ja",
                             {"DEFINITION.texts.LANGUAGE.toml, to be filled in",
                              "guide-own-experiment.md#pages-and-languages"});
  auto& o = options_of<TextsOptions>(*sub, status, write_texts);
  sub->add_option("DEFINITION", o.definition, "Experiment definition (.toml)")->required();
  sub->add_option("--language", o.language, "Language, such as ja or pt-BR")->required();
}

}  // namespace haptrial::experiments
