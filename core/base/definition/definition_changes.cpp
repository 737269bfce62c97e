#include "core/base/definition/definition_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "core/base/definition/toml_text_internal.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/base/utf8.h"

namespace haptrial {
namespace {

constexpr const char* kAbsent = "absent";
using Values = std::map<std::string, std::string>;  // by the key's full path

/// Whether a key is that of a name, or in the table of that name. '*' in the name is any part.
bool is_within(std::string_view key, std::string_view name) {
  const std::string_view part = name.substr(0, name.find('.'));
  const std::string_view own = key.substr(0, key.find('.'));
  if (part != "*" && part != own) {
    return false;
  }
  if (part.size() == name.size()) {
    return true;
  }
  return own.size() < key.size() &&
         is_within(key.substr(own.size() + 1), name.substr(part.size() + 1));
}

bool is_one_of(std::string_view key, const std::vector<std::string>& names) {
  return std::ranges::any_of(names, [&](const std::string& name) { return is_within(key, name); });
}

/// In one form: 1, 1.0 and 1e0 are the same number.
std::string normal(const toml::node& node) {
  if (const auto* array = node.as_array()) {
    std::string all;
    for (const toml::node& element : *array) {
      all += (all.empty() ? "" : ", ") + normal(element);
    }
    return "[" + all + "]";
  }
  if (const auto* table = node.as_table()) {  // within an array
    std::string all;
    for (const auto& [key, value] : *table) {
      all += (all.empty() ? "" : ", ") + fmt::format("{} = {}", key.str(), normal(value));
    }
    return "{" + all + "}";
  }
  if (const auto* number = node.as_floating_point()) {
    return fmt::format("{}", number->get());
  }
  if (const auto* text = node.as_string()) {
    return "\"" + text->get() + "\"";
  }
  std::ostringstream out;
  node.visit([&](const auto& value) {
    if constexpr (!toml::is_table<decltype(value)> && !toml::is_array<decltype(value)>) {
      out << value;
    }
  });
  return out.str();
}

void flatten(const toml::table& table, const std::string& path, Values& into) {
  for (const auto& [key, value] : table) {
    const std::string name = path.empty() ? std::string(key.str()) : path + "." + std::string(key);
    if (const auto* inner = value.as_table()) {
      flatten(*inner, name, into);
    } else {
      into[name] = normal(value);
    }
  }
}

/// A table's keys in the order of the text, as the value of the table itself.
void add_order(const toml::table& root, const std::string& table, Values& into) {
  std::vector<std::pair<toml::source_position, std::string>> names;
  if (const auto* keys = root[table].as_table()) {
    for (const auto& [key, value] : *keys) {
      names.emplace_back(key.source().begin, key.str());
    }
  }
  std::sort(names.begin(), names.end());
  std::string all;
  for (const auto& [position, name] : names) {
    all += (all.empty() ? "" : ", ") + name;
  }
  if (!all.empty()) {
    into[table] = all;
  }
}

/// Left out or written, a known default is the same.
void fill_in(Values& values, const std::vector<BoundKey>& bound) {
  for (const BoundKey& each : bound) {
    if (!each.absent.empty()) {
      values.emplace(each.key, each.absent);
    }
  }
}

Values values_of(std::string_view text, const DefinitionRules& rules) {
  const toml::table root = parse_toml(text, "definition");
  Values values;
  flatten(root, "", values);
  for (const std::string& table : rules.ordered) {
    add_order(root, table, values);
  }
  fill_in(values, rules.bound);
  return values;
}

/// Short enough for a sentence, on one line. @param from  what comes before it is left out
std::string shown(std::string text, std::size_t from) {
  constexpr std::size_t kLongest = 60;
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  from = whole_characters(text, from);
  const std::size_t end = whole_characters(text, from + kLongest);
  return (from > 0 ? "..." : "") + text.substr(from, end - from) + (end < text.size() ? "..." : "");
}

/// Both values, long ones from shortly before the place where they part.
DefinitionChange change_of(const std::string& key, const std::string& was, const std::string& is) {
  constexpr std::size_t kBefore = 20;
  const auto part = static_cast<std::size_t>(
      std::mismatch(was.begin(), was.end(), is.begin(), is.end()).first - was.begin());
  const std::size_t from = part > 2 * kBefore ? part - kBefore : 0;
  return {key, shown(was, from), shown(is, from)};
}

}  // namespace

bool DefinitionRules::may_change(std::string_view key) const {
  return is_one_of(key, free) &&
         std::none_of(bound.begin(), bound.end(),
                      [&](const BoundKey& exception) { return is_within(key, exception.key); });
}

void DefinitionRules::add(const DefinitionRules& more) {
  free.insert(free.end(), more.free.begin(), more.free.end());
  bound.insert(bound.end(), more.bound.begin(), more.bound.end());
  ordered.insert(ordered.end(), more.ordered.begin(), more.ordered.end());
  kept.insert(kept.end(), more.kept.begin(), more.kept.end());
}

DefinitionChanges definition_changes(std::string_view before, std::string_view after,
                                     const DefinitionRules& rules) {
  DefinitionChanges changes;
  if (before == after) {
    return changes;
  }
  changes.same_text = false;
  Values first;
  Values second;
  try {
    first = values_of(before, rules);
    second = values_of(after, rules);
  } catch (const InputError&) {
    changes.binding.push_back(change_of("the text", std::string(before), std::string(after)));
    return changes;
  }
  Values all = first;
  all.insert(second.begin(), second.end());
  const auto value_in = [](const Values& values, const std::string& key) {
    const auto at = values.find(key);
    return at == values.end() ? std::string(kAbsent) : at->second;
  };
  for (const auto& [key, ignored] : all) {
    const std::string was = value_in(first, key);
    const std::string is = value_in(second, key);
    if (was != is) {
      const bool is_another = was != kAbsent && is != kAbsent;
      const bool may = rules.may_change(key) && !(is_another && is_one_of(key, rules.kept));
      auto& into = may ? changes.free : changes.binding;
      into.push_back(change_of(key, was, is));
    }
  }
  return changes;
}

std::map<std::string, std::string> definition_values(std::string_view definition,
                                                     std::span<const std::string> names) {
  Values values = values_of(definition, {});
  std::erase_if(values, [&](const auto& value) {
    return std::none_of(names.begin(), names.end(),
                        [&](const std::string& name) { return is_within(value.first, name); });
  });
  return values;
}

std::string binding_text(std::string_view definition, const DefinitionRules& rules) {
  std::string text;
  for (const auto& [key, value] : values_of(definition, rules)) {
    if (!rules.may_change(key)) {
      text += fmt::format("{} = {}\n", key, value);
    }
  }
  return text;
}

std::optional<std::uint64_t> table_fingerprint(std::string_view definition,
                                               std::string_view table) {
  Values values;
  try {
    values = values_of(definition, {});
  } catch (const InputError&) {
    return std::nullopt;
  }
  const std::string prefix = std::string(table) + ".";
  std::string all;
  for (const auto& [key, value] : values) {
    if (key.starts_with(prefix)) {
      all += key + " = " + value + "\n";
    }
  }
  return all.empty() ? std::nullopt : std::optional(derived_seed(0, all));
}

std::string sentence_of(const std::vector<DefinitionChange>& changes) {
  constexpr std::size_t kMost = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, changes.size()); ++i) {
    const auto& [key, before, after] = changes[i];
    text += fmt::format("{}{} was {}, is {}", i > 0 ? "; " : "", key, before, after);
  }
  return changes.size() > kMost ? fmt::format("{}; and {} more", text, changes.size() - kMost)
                                : text;
}

}  // namespace haptrial
