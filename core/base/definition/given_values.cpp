#include "core/base/definition/given_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/base/definition/text_places_internal.h"
#include "core/base/definition/toml_text_internal.h"
#include "core/base/error.h"

namespace haptrial {
namespace {

/// The last byte of what a table states itself; behind its header, or at the start of the text.
std::size_t end_of(std::string_view text, const toml::table& table, bool root) {
  std::size_t end = root ? byte_of(text, {1, 1}) : byte_of(text, table.source().begin);
  if (!root) {
    end = table.is_inline() ? end + 1 : header_end(text, end);
  }
  for (const Statement& each : own_statements(text, table)) {
    end = std::max(end, byte_of(text, each.value->source().end));
  }
  return end;
}

/// The line of a header, or of the first of the comments that stand right above it.
std::size_t begin_with_comments(std::string_view text, std::size_t header) {
  const auto line_before = [&](std::size_t at) {
    const std::size_t end = at < 2 ? std::string_view::npos : text.rfind('\n', at - 2);
    return end == std::string_view::npos ? 0 : end + 1;
  };
  std::size_t at = header == 0 ? 0 : text.rfind('\n', header - 1) + 1;
  while (at > 0 && text[line_before(at)] == '#') {
    at = line_before(at);
  }
  return at;
}

/// Adds a table with one key: above the table that implies it, else at the end of the text.
std::string with_new_table(std::string text, const KeyPath& path, const std::string& value,
                           bool implied) {
  std::vector<std::string> names = header_names(path);
  const std::string name = written_name(names.back());
  names.pop_back();
  const std::string line = line_ending(text);
  const std::string table =
      fmt::format("[{}]{}{} = {}{}", dotted_name(names), line, name, value, line);
  if (implied) {
    const std::size_t header = byte_of(text, path.steps.back().node->source().begin);
    return text.insert(begin_with_comments(text, header), table + line);
  }
  return text + (text.empty() || text.ends_with('\n') ? "" : line) + line + table;
}

std::string with_new_key(std::string text, const KeyPath& path, const std::string& value) {
  const auto table_at = [&](std::size_t i) { return path.steps[i].node->as_table(); };
  std::size_t owner = path.steps.size() - 1;
  while (owner > 0 && (table_at(owner) == nullptr ||
                       (!table_at(owner)->is_inline() && !has_header(text, *table_at(owner))))) {
    --owner;
  }
  const bool deepest = owner + 1 == path.steps.size();
  const bool implied = !deepest && is_implied(text, *table_at(path.steps.size() - 1));
  const bool entry = std::any_of(path.steps.begin(), path.steps.end(),
                                 [](const PathStep& step) { return step.node->is_array(); });
  const toml::table& table = *table_at(owner);
  if (implied || (deepest && path.missing.size() > 1 && !entry && !table.is_inline())) {
    return with_new_table(std::move(text), path, value, implied);
  }
  std::vector<std::string> names = path.missing;
  for (std::size_t i = path.steps.size() - 1; i > owner; --i) {
    names.insert(names.begin(), path.steps[i].name);
  }
  const std::string statement = fmt::format("{} = {}", dotted_name(names), value);
  std::size_t at = end_of(text, table, owner == 0);
  if (owner > 0 && table.is_inline()) {
    return text.insert(at, table.empty() ? fmt::format(" {} ", statement) : ", " + statement);
  }
  const std::string line = line_ending(text);
  if (owner == 0 && table.empty()) {
    return text.insert(at, statement + line);
  }
  const bool first = owner == 0 && own_statements(text, table).empty();
  at = first ? at : next_line(text, at);
  const bool open = !first && at == text.size() && !text.ends_with('\n');
  return text.insert(at, (open ? line : "") + statement + line);
}

/// A value of one line would otherwise be able to bring keys of its own.
void refuse_other_than_value(std::string_view file_name, const GivenKey& given) {
  const std::string line = "value = " + given.value;
  const auto refuse = [&] {
    throw InputError(fmt::format(
        "{}: {} is given {}; allowed: one value as a definition writes it, such as 12, 0.05, true, "
        "\"a text\" or [1, 2]",
        file_name, given.key, given.value.empty() ? "nothing" : given.value));
  };
  toml::table table;
  try {
    table = parse_toml(line, file_name);
  } catch (const InputError&) {
    refuse();
  }
  if (table.size() != 1 || byte_of(line, table.begin()->second.source().end) != line.size()) {
    refuse();
  }
}

std::string with_value(std::string text, std::string_view file_name, const GivenKey& given) {
  refuse_other_than_value(file_name, given);
  const toml::table root = parse_toml(text, file_name);
  const KeyPath path = follow_path(root, file_name, given.key);
  const toml::node& value = *path.steps.back().node;
  if (!path.missing.empty()) {
    if (!value.is_table()) {
      throw InputError(fmt::format("{}: {} is no table; give a key of the definition", file_name,
                                   path.steps.back().name));
    }
    return with_new_key(std::move(text), path, given.value);
  }
  const toml::array* array = value.as_array();
  const bool entry = path.steps.back().key == nullptr;
  if (entry || (array != nullptr && has_headers(*array)) ||
      (value.is_table() && !value.as_table()->is_inline())) {
    throw InputError(fmt::format("{}: {} is a table; give a key of it", file_name, given.key));
  }
  const std::size_t begin = byte_of(text, value.source().begin);
  return text.replace(begin, byte_of(text, value.source().end) - begin, given.value);
}

}  // namespace

std::string with_values(std::string_view text, std::string_view file_name,
                        std::span<const GivenKey> given) {
  std::string changed(text);
  for (const GivenKey& each : given) {
    changed = with_value(std::move(changed), file_name, each);
  }
  return changed;
}

}  // namespace haptrial
