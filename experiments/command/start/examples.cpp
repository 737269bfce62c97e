#include "experiments/command/start/examples.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/base/whole_file.h"

namespace haptrial::experiments {
namespace {

/// Text after the comment's sign; the line is one of a comment.
std::string_view comment_words(std::string_view line) {
  const std::size_t first = line.find_first_not_of("# ");
  return first == std::string_view::npos ? std::string_view() : line.substr(first);
}

/// Without its stop; a question keeps its mark.
std::string first_sentence(const std::string& text) {
  const std::size_t question = text.find("? ");
  const std::size_t stop = std::min(text.find(". "), text.size() - (text.ends_with('.') ? 1 : 0));
  return text.substr(0, question < stop ? question + 1 : stop);
}

}  // namespace

const Example& example_named(std::string_view name) {
  const auto all = examples();
  const auto found = std::ranges::find(all, name, &Example::name);
  if (found != all.end()) {
    return *found;
  }
  std::vector<std::string> names;
  for (const Example& example : all) {
    names.emplace_back(example.name);
  }
  const auto first_word_is_near = [&](const std::string& each) {
    return nearest(name, {each.substr(0, each.find('_'))}).has_value();
  };
  const auto near = std::ranges::find_if(names, first_word_is_near);
  const std::string hint =
      near != names.end() && !nearest(name, names) ? fmt::format("; did you mean {}?", *near) : "";
  throw InputError(not_allowed("--from", fmt::format("'{}'", name), names) + hint);
}

std::string definition_or_example(const std::string& given) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const std::string name = fs::path(given).stem().string();
  const std::string copy = name + ".toml";
  if (fs::exists(given, ignored)) {
    return given;
  }
  if (given == name && fs::exists(copy, ignored)) {
    return copy;
  }
  const auto all = examples();
  const auto found = std::ranges::find(all, name, &Example::name);
  if (found == all.end()) {
    return given;  // who reads it says that there is no such file
  }
  if (given != name) {
    throw InputError(
        fmt::format("{}: there is no such file; {} is a shipped definition: write its name alone",
                    given, name));
  }
  WholeFile out((fs::path(copy)));
  out.write(std::string(found->text));
  out.finish();
  fmt::print("{}: a copy of the shipped definition {}\n", copy, name);
  return copy;
}

std::string what_of(const Example& example) {
  std::string comment;
  std::string_view rest = example.text;
  while (rest.starts_with('#')) {
    const std::size_t end = std::min(rest.find('\n'), rest.size() - 1);
    comment += (comment.empty() ? "" : " ") + std::string(comment_words(rest.substr(0, end)));
    rest.remove_prefix(end + 1);
  }
  return first_sentence(comment);
}

std::string renamed(const Example& example, std::string_view name) {
  std::string text(example.text);
  const std::string key = "\nname = \"";
  const std::size_t first = text.find(key, text.find("[experiment]")) + key.size();
  return text.replace(first, text.find('"', first) - first, name);
}

}  // namespace haptrial::experiments
