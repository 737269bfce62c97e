#include "core/base/definition/removed_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "core/base/definition/given_values.h"
#include "core/base/definition/text_places_internal.h"
#include "core/base/definition/toml_text_internal.h"
#include "core/base/error.h"

namespace haptrial {
namespace {

struct Span {
  std::size_t begin;
  std::size_t end;
};

/// Widens a statement to its whole line; a comment behind it stays as a line of its own.
Span line_of(std::string_view text, Span span) {
  while (span.begin > byte_of(text, {1, 1}) && text[span.begin - 1] != '\n') {
    --span.begin;
  }
  while (span.end < text.size() && (text[span.end] == ' ' || text[span.end] == '\t')) {
    ++span.end;
  }
  if (span.end < text.size() && text[span.end] != '#') {
    span.end = next_line(text, span.end);
  }
  return span;
}

/// Widens a statement or entry within brackets by one comma.
Span with_comma(std::string_view text, Span span) {
  constexpr const char* kBlanks = " \t\r\n";
  const std::size_t next = text.find_first_not_of(kBlanks, span.end);
  if (next != std::string_view::npos && text[next] == ',') {
    span.end = std::min(text.find_first_not_of(" \t", next + 1), text.size());
    return span;
  }
  const std::size_t before = span.begin == 0 ? 0 : text.find_last_not_of(kBlanks, span.begin - 1);
  if (text[before] == ',') {
    span.begin = before;
  }
  return span;
}

/// The bytes of every line that states something of a node: values, and headers of tables.
void add_lines(std::string_view text, const toml::node& node, std::vector<Span>& spans) {
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& entry : *array) {
      add_lines(text, entry, spans);
    }
    return;
  }
  const toml::table& table = *node.as_table();
  const std::size_t begin = byte_of(text, table.source().begin);
  if (has_header(text, table)) {
    spans.push_back(line_of(text, {begin, header_end(text, begin)}));
  }
  for (const Statement& each : own_statements(text, table)) {
    spans.push_back(line_of(
        text, {byte_of(text, each.key->source().begin), byte_of(text, each.value->source().end)}));
  }
  for (const auto& [key, value] : table) {
    const toml::table* inner = value.as_table();
    const toml::array* array = value.as_array();
    if ((inner != nullptr && !inner->is_inline()) || (array != nullptr && has_headers(*array))) {
      add_lines(text, value, spans);
    }
  }
}

/// Whether the last step of a path stands within braces or brackets.
bool is_enclosed(const KeyPath& path) {
  for (std::size_t i = 0; i + 1 < path.steps.size(); ++i) {
    const toml::table* table = path.steps[i].node->as_table();
    const toml::array* array = path.steps[i].node->as_array();
    if ((table != nullptr && table->is_inline()) || (array != nullptr && !has_headers(*array))) {
      return true;
    }
  }
  return false;
}

bool has_lines(const toml::node& node) {
  const toml::array* array = node.as_array();
  const toml::table* table = node.as_table();
  return (table != nullptr && !table->is_inline()) || (array != nullptr && has_headers(*array));
}

/// The start of a statement with a dotted key: behind the brace or comma before it.
std::size_t statement_begin(std::string_view text, std::size_t key) {
  const std::size_t before = text.find_last_of("{,", key);
  return before == std::string_view::npos ? key : text.find_first_not_of(" \t", before + 1);
}

Span enclosed(std::string_view text, const KeyPath& path) {
  const PathStep& last = path.steps.back();
  const std::size_t end = byte_of(text, last.node->source().end);
  const std::size_t begin = last.key == nullptr
                                ? byte_of(text, last.node->source().begin)
                                : statement_begin(text, byte_of(text, last.key->source().begin));
  return with_comma(text, {begin, end});
}

std::string with_entry_in_brackets(std::string_view text, std::string_view file_name,
                                   const std::string& key, const toml::array& array) {
  const bool tables = std::all_of(array.begin(), array.end(),
                                  [](const toml::node& each) { return each.is_table(); });
  if (!tables) {
    throw InputError(fmt::format("{}: {} is a list of values; set the whole list", file_name, key));
  }
  std::string changed(text);
  if (array.empty()) {
    return changed.insert(byte_of(text, array.source().begin) + 1, "{}");
  }
  return changed.insert(byte_of(text, array.back().source().end), ", {}");
}

/// The place below an array of tables; for a new array, below the entry that shall have it.
std::size_t end_of_section(std::string_view text, const KeyPath& path) {
  std::size_t step = path.steps.size() - 1;
  if (!path.missing.empty()) {
    while (step > 0 && path.steps[step].key != nullptr) {
      --step;
    }
  }
  if (step == 0) {
    return text.size();
  }
  std::vector<Span> spans;
  add_lines(text, *path.steps[step].node, spans);
  std::size_t end = 1;
  for (const Span& span : spans) {
    end = std::max(end, span.end);
  }
  return next_line(text, end - 1);
}

}  // namespace

std::string without_key(std::string_view text, std::string_view file_name, const std::string& key) {
  const toml::table root = parse_toml(text, file_name);
  const KeyPath path = follow_path(root, file_name, key);
  if (!path.missing.empty()) {
    throw InputError(
        fmt::format("{}: there is no key {} to remove; give a key of the text", file_name, key));
  }
  const PathStep& last = path.steps.back();
  std::vector<Span> spans;
  if (has_lines(*last.node) && is_enclosed(path)) {
    throw InputError(
        fmt::format("{}: {} is several keys within braces; remove each of them", file_name, key));
  }
  if (is_enclosed(path)) {
    spans.push_back(enclosed(text, path));
  } else if (has_lines(*last.node)) {
    add_lines(text, *last.node, spans);
  } else {
    spans.push_back(line_of(
        text, {byte_of(text, last.key->source().begin), byte_of(text, last.node->source().end)}));
  }
  std::sort(spans.begin(), spans.end(),
            [](const Span& a, const Span& b) { return a.begin > b.begin; });
  const auto same = [](const Span& a, const Span& b) { return a.begin == b.begin; };
  spans.erase(std::unique(spans.begin(), spans.end(), same), spans.end());  // of dotted keys
  std::string changed(text);
  for (const Span& span : spans) {
    changed.erase(span.begin, span.end - span.begin);
  }
  return changed;
}

std::string with_new_entry(std::string_view text, std::string_view file_name,
                           const std::string& key) {
  const toml::table root = parse_toml(text, file_name);
  const KeyPath path = follow_path(root, file_name, key);
  const toml::node& node = *path.steps.back().node;
  const toml::array* array = node.as_array();
  const toml::table* table = node.as_table();
  if (path.missing.empty() ? array == nullptr : table == nullptr) {
    throw InputError(fmt::format("{}: {} is no array of tables; only such an array has entries",
                                 file_name, key));
  }
  const bool whole = path.missing.empty() && has_headers(*array);
  if (path.missing.empty() && !whole) {
    return with_entry_in_brackets(text, file_name, key, *array);
  }
  if (!whole && path.steps.size() > 1 && !has_header(text, *table) && !is_implied(text, *table)) {
    const GivenKey given{key, "[{}]"};
    return with_values(text, file_name, std::span(&given, 1));
  }
  const std::size_t at = end_of_section(text, path);
  const std::string line = line_ending(text);
  const std::string open = at > 0 && text[at - 1] != '\n' ? line : "";
  std::string changed(text);
  return changed.insert(
      at, fmt::format("{}{}[[{}]]{}", open, line, dotted_name(header_names(path)), line));
}

}  // namespace haptrial
