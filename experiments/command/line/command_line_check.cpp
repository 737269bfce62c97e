#include "experiments/command/line/command_line_check_internal.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/nearest.h"

namespace haptrial::experiments {
namespace {

/// The subcommand that was typed, and what follows it.
struct Typed {
  const CLI::App* app;
  std::string name;  // "haptrial bone make"
  std::span<char* const> rest;
};

std::vector<const CLI::App*> subcommands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

Typed typed_subcommand(const CLI::App& app, std::span<char* const> words) {
  Typed typed{&app, app.get_name(), words};
  for (bool found = true; found && !typed.rest.empty();) {
    found = false;
    for (const CLI::App* sub : subcommands_of(*typed.app)) {
      if (sub->get_name() == typed.rest[0]) {
        typed = {sub, typed.name + " " + sub->get_name(), typed.rest.subspan(1)};
        found = true;
        break;
      }
    }
  }
  return typed;
}

void check_subcommand(const Typed& typed) {
  std::vector<std::string> known;
  for (const CLI::App* sub : subcommands_of(*typed.app)) {
    known.push_back(sub->get_name());
  }
  const bool optional = typed.app->get_require_subcommand_min() == 0;  // as of haptrial power t
  if (known.empty() || optional || (!typed.rest.empty() && typed.rest[0][0] == '-')) {
    return;
  }
  const std::string allowed = fmt::format("{}", fmt::join(known, ", "));
  if (typed.rest.empty()) {
    throw InputError(fmt::format("{} needs a subcommand; allowed: {}", typed.name, allowed));
  }
  const std::string hint = did_you_mean(typed.rest[0], known);
  throw InputError(fmt::format("'{}' is not a subcommand of {}{} allowed: {}", typed.rest[0],
                               typed.name, hint.empty() ? ";" : hint, allowed));
}

/// "--device" of "--device=mouse"; empty unless the word is an option.
std::string option_in(std::string_view word) {
  const bool letter =
      word.size() > 1 && word[0] == '-' &&
      (word[1] == '-' || (word[1] >= 'A' && word[1] <= 'Z') || (word[1] >= 'a' && word[1] <= 'z'));
  return letter && word != "--" ? std::string(word.substr(0, word.find('='))) : "";
}

void check_options(const Typed& typed) {
  std::vector<std::string> known;
  std::vector<std::string> every;  // with the short ones
  for (const CLI::Option* option : typed.app->get_options()) {
    for (const std::string& name : option->get_lnames()) {
      known.push_back("--" + name);
    }
    for (const std::string& name : option->get_snames()) {
      every.push_back("-" + name);
    }
  }
  every.insert(every.end(), known.begin(), known.end());
  for (const char* word : typed.rest) {
    if (std::string_view(word) == "--") {
      return;  // nothing after it is an option
    }
    const std::string option = option_in(word);
    if (option.empty() || std::find(every.begin(), every.end(), option) != every.end()) {
      continue;
    }
    const std::string hint = did_you_mean(option, known);
    throw InputError(fmt::format("{} is not an option of {}{} see {} --help", option, typed.name,
                                 hint.empty() ? ";" : hint, typed.name));
  }
}

/// An empty word, as a script's unset variable leaves it, would stand for the default.
void check_for_empty_words(const Typed& typed) {
  std::string option;  // that the word before this one is
  for (const std::string_view word : typed.rest) {
    const std::string own = option_in(word);
    const bool joined = !own.empty() && word == own + "=";
    if (joined || (word.empty() && !option.empty())) {
      throw InputError(fmt::format("{} is empty; write a value after it", joined ? own : option));
    }
    if (word.empty()) {
      throw InputError(
          fmt::format("an empty word follows {}; leave it out, or write a value", typed.name));
    }
    option = own;
  }
}

/// "a whole number", where the option's type says so.
std::string form_of(const CLI::App& app, const std::string& option) {
  const CLI::Option* found = app.get_option_no_throw(option);
  const std::string type = found == nullptr ? "" : found->get_type_name();
  return type == "UINT"
             ? fmt::format("a whole number from 0 to {}", std::numeric_limits<std::uint32_t>::max())
         : type == "INT"   ? "a whole number"
         : type == "FLOAT" ? "a number"
                           : "";
}

}  // namespace

void check_words(const CLI::App& app, std::span<char* const> words) {
  const Typed typed = typed_subcommand(app, words);
  check_subcommand(typed);
  check_options(typed);
  check_for_empty_words(typed);
}

std::string sentence_of(const CLI::App& app, std::span<char* const> words,
                        const CLI::ParseError& error) {
  const Typed typed = typed_subcommand(app, words);
  std::string what = error.what();
  constexpr std::string_view kUnread = "Could not convert: ";
  constexpr std::string_view kTwice = ": At Most 1 required but received ";
  if (const auto equals = what.find(" = "); what.starts_with(kUnread) && equals != what.npos) {
    const std::string option = what.substr(kUnread.size(), equals - kUnread.size());
    if (const std::string form = form_of(*typed.app, option); !form.empty()) {
      what = fmt::format("{} is '{}'; allowed: {}", option, what.substr(equals + 3), form);
    }
  } else if (const auto required = what.find(": 1 required "); required != what.npos) {
    what = fmt::format("{} has no value; write one after it", what.substr(0, required));
  } else if (const auto most = what.find(kTwice); most != what.npos) {
    what = fmt::format("{} is given {} times; give it once", what.substr(0, most),
                       what.substr(most + kTwice.size()));
  } else if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    if (const auto end = what.find(" is required"); end != what.npos) {
      what = fmt::format("{} is missing", what.substr(0, end));
    }
  }
  return fmt::format("{}; see {} --help", what, typed.name);
}

}  // namespace haptrial::experiments
