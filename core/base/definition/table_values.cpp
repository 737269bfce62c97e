// The values that readers ask of a table, and the texts that people are shown.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/base/definition/number_source.h"
#include "core/base/definition/table.h"
#include "core/base/definition/table_internal.h"
#include "core/base/definition/table_words_internal.h"
#include "core/base/error.h"
#include "core/base/nearest.h"

namespace haptrial {

namespace {

double fallback(const Bounds& b) {
  if (std::isfinite(b.low)) {
    return b.open_low ? std::nextafter(b.low, b.high) : b.low;
  }
  return std::isfinite(b.high) ? b.high : 0.0;
}

/// A number within bounds that no reader minds.
double harmless(const Bounds& b) {
  if (within(1.0, b)) {
    return 1.0;
  }
  return std::isfinite(b.low) && std::isfinite(b.high) ? 0.5 * (b.low + b.high) : fallback(b);
}

}  // namespace

/// The value under `key`, or nothing with the problem noted. @param any  other values of the type
/// may do as well, so that the sentence can say how to write the value
template <class T>
std::optional<T> Table::get(std::string_view key, std::string_view allowed, bool any) {
  if (node_->table == nullptr) {
    return std::nullopt;
  }
  node_->read.emplace(key);
  const toml::node* node = node_->table->get(key);
  if (node == nullptr) {
    note(line_of(node_->table),
         fmt::format("{} is missing; allowed: {}", node_->full(key), allowed));
    return std::nullopt;
  }
  std::optional<T> value;
  if constexpr (std::is_same_v<T, double>) {
    value = node->value<double>();
    value = node->is_number() ? value : std::nullopt;
  } else {
    value = node->value_exact<T>();
  }
  if (!value) {
    const std::string hint = any ? rewritten(*node, key, wanted<T>()) : "";
    if (hint.empty()) {
      refuse(key, shown(*node), allowed);
    } else {
      note(line_of(node),
           fmt::format("{} is {}; {}", node_->full(key), shown_with_kind(*node), hint));
    }
  }
  return value;
}

/// Lists of keys show the units that readers ask for.
void Table::state_in(const AngularUnits& units) {
  if (exploration() != nullptr) {
    return;
  }
  document_->units.insert_or_assign(node_->path, units);
}

std::optional<AngularUnits::GivenUnit> Table::given_for(std::string_view unit) const {
  const auto units = document_->units.find(node_->path);
  return units == document_->units.end() ? std::nullopt : units->second.given_for(unit);
}

std::optional<double> Table::worth(std::string_view key, std::string_view text,
                                   const Bounds& bounds, std::string_view unit) {
  if (const auto given = given_for(unit)) {
    const auto value = worth(key, text, given->bounds(bounds), given->unit);
    return value ? std::optional(given->factor * *value) : std::nullopt;
  }
  std::optional<double> value;
  try {
    value = numbers_ == nullptr ? std::nullopt : numbers_->value_of(text);
  } catch (const InputError& error) {
    reject(key, fmt::format("is \"{}\": {}", text, error.what()));
    return std::nullopt;
  }
  if (!value) {
    reject(key, fmt::format("the text \"{}\"", text), words(bounds, unit));
  } else if (!within(*value, bounds)) {
    reject(key, fmt::format("{} (\"{}\")", *value, text), words(bounds, unit));
    return std::nullopt;
  }
  return value;
}

double Table::number(std::string_view key, const Bounds& bounds, std::string_view unit) {
  if (const auto given = given_for(unit)) {
    return given->factor * number(key, given->bounds(bounds), given->unit);
  }
  if (numbers_ != nullptr) {
    if (const auto text = whole_text(key)) {
      return worth(key, *text, bounds, unit).value_or(fallback(bounds));
    }
  }
  const std::string allowed = words(bounds, unit);
  if (exploration() != nullptr) {
    tell(key, {"number", bounds, {}}, allowed, unit);
    const double usual = exploration()->default_of(node_->path, key).value_or(harmless(bounds));
    return states(key) ? node_->table->get(key)->value<double>().value_or(usual) : usual;
  }
  const auto value = get<double>(key, allowed);
  if (value && !within(*value, bounds)) {
    refuse(key, fmt::format("{}", *value), allowed);
    return fallback(bounds);
  }
  return value.value_or(fallback(bounds));
}

long Table::integer(std::string_view key, long low, long high) {
  const std::string allowed = fmt::format("a whole number from {} to {}", low, high);
  if (exploration() != nullptr) {
    tell(key, {"whole number", {static_cast<double>(low), static_cast<double>(high)}, {}}, allowed);
    return states(key) ? node_->table->get(key)->value<long>().value_or(low)
                       : std::clamp(1L, low, high);
  }
  const auto value = get<std::int64_t>(key, allowed);
  if (value && (*value < low || *value > high)) {
    refuse(key, fmt::format("{}", *value), allowed);
    return low;
  }
  return value.value_or(low);
}

bool Table::boolean(std::string_view key) {
  if (exploration() != nullptr) {
    tell(key, {"true or false", {}, {}}, "true or false");
    return exploration()->is_there(node_->path, key, "true", true);
  }
  return get<bool>(key, "true or false").value_or(false);
}

std::string Table::text(std::string_view key) {
  if (exploration() != nullptr) {
    tell(key, {"text", {}, {}}, "a text in quotes that is not empty");
    return states(key) ? node_->table->get(key)->value<std::string>().value_or("NAME") : "NAME";
  }
  auto value = get<std::string>(key, "a text in quotes that is not empty");
  if (value && value->empty()) {
    refuse(key, "an empty text", "a text in quotes that is not empty");
  }
  return value.value_or("");
}

std::string Table::choice(std::string_view key, const std::vector<std::string>& allowed) {
  if (exploration() != nullptr) {
    tell(key, {"choice", {}, allowed}, joined(allowed));
    return exploration()->choose(
        node_->path, key, allowed,
        states(key) ? node_->table->get(key)->value_or(std::string()) : "");
  }
  if (allowed.empty()) {  // the caller's own list has no word
    if (const auto found = get<std::string>(key, "no value; leave it out", false)) {
      refuse(key, fmt::format("'{}'", *found), "no value; leave it out");
    }
    return "";
  }
  const auto value = get<std::string>(key, joined(allowed), false);
  if (value && std::find(allowed.begin(), allowed.end(), *value) == allowed.end()) {
    note(line(key), not_allowed(node_->full(key), shown(*node_->table->get(key)), allowed));
    return allowed.front();
  }
  return value.value_or(allowed.front());
}

/// Every element of the array under `key` as T; elements of another type are noted.
template <class T>
std::vector<T> Table::array(std::string_view key, const std::string& allowed) {
  std::vector<T> values;
  if (node_->table == nullptr) {
    return values;
  }
  node_->read.emplace(key);
  const toml::node* node = node_->table->get(key);
  if (node == nullptr) {
    note(line_of(node_->table),
         fmt::format("{} is missing; allowed: {}", node_->full(key), allowed));
    return values;
  }
  const toml::array* array = node->as_array();
  if (const bool good = node->is_string() || node->is_number();
      good && array == nullptr && node->value_exact<T>()) {
    note(line_of(node), fmt::format("{} is {}; write it in brackets: {} = [{}]", node_->full(key),
                                    shown_with_kind(*node), key, shown(*node)));
    return values;
  }
  if (array == nullptr || array->empty()) {
    refuse(key, array == nullptr ? shown(*node) : "an empty array", allowed);
    return values;
  }
  for (const toml::node& element : *array) {
    if (const auto value = element.value<T>()) {
      values.push_back(*value);
    } else {
      note(line_of(&element), fmt::format("{} is an array with {}; allowed: {}", node_->full(key),
                                          shown_with_kind(element), allowed));
    }
  }
  return values;
}

std::vector<double> Table::numbers(std::string_view key, const Bounds& bounds,
                                   std::string_view unit) {
  if (const auto given = given_for(unit)) {
    std::vector<double> values = numbers(key, given->bounds(bounds), given->unit);
    for (double& value : values) {
      value *= given->factor;
    }
    return values;
  }
  const std::string allowed = fmt::format("an array, each {}", words(bounds, unit));
  if (exploration() != nullptr) {
    tell(key, {"list of numbers", bounds, {}}, allowed, unit);
    constexpr std::size_t kOfAVector = 3;
    return std::vector<double>(kOfAVector, harmless(bounds));
  }
  auto values = array<double>(key, allowed);
  for (const double value : values) {
    if (!within(value, bounds)) {
      refuse(key, fmt::format("an array with {}", value), allowed);
    }
  }
  return values;
}

std::vector<std::string> Table::texts(std::string_view key) {
  if (exploration() != nullptr) {
    tell(key, {"list of texts", {}, {}}, "an array of texts in quotes");
    return {"NAME"};
  }
  return array<std::string>(key, "an array of texts in quotes");
}

std::vector<std::vector<NumberOrText>> Table::rows(std::string_view key, std::string_view allowed) {
  std::vector<std::vector<NumberOrText>> rows;
  if (exploration() != nullptr) {
    tell(key, {"list", {}, {}}, allowed);
    return {{{1.0, ""}, {1.0, ""}, {1.0, ""}}};
  }
  if (node_->table == nullptr) {
    return rows;
  }
  node_->read.emplace(key);
  const toml::node* node = node_->table->get(key);
  if (node == nullptr) {
    note(line_of(node_->table),
         fmt::format("{} is missing; allowed: {}", node_->full(key), allowed));
    return rows;
  }
  const toml::array* outer = node->as_array();
  if (outer == nullptr || outer->empty()) {
    refuse(key, outer == nullptr ? shown(*node) : "an empty array", allowed);
    return rows;
  }
  const bool nested = outer->get(0)->is_array();
  for (std::size_t i = 0; i < (nested ? outer->size() : 1); ++i) {
    const toml::array* inner = nested ? outer->get(i)->as_array() : outer;
    if (inner == nullptr) {
      refuse(key, fmt::format("an array with {}", shown(*outer->get(i))), allowed);
    }
    rows.emplace_back();
    for (std::size_t j = 0; inner != nullptr && j < inner->size(); ++j) {
      const toml::node& entry = *inner->get(j);
      const bool good = entry.is_number() || entry.is_string();
      if (!good) {
        refuse(key, fmt::format("an array with {}", shown(entry)), allowed);
      }
      rows.back().push_back({entry.is_string() ? std::nullopt : entry.value<double>(),
                             entry.value<std::string>().value_or("")});
    }
  }
  return rows;
}

std::optional<std::string> Table::whole_text(std::string_view key) const {
  if (exploration() != nullptr && !states(key)) {
    const std::string word = exploration()->chosen(node_->path, key);
    exploration()->note_text(node_->path, key);
    return word.empty() ? std::nullopt : std::optional(word);
  }
  const toml::node* node = node_->table == nullptr ? nullptr : node_->table->get(key);
  if (node == nullptr || !node->is_string()) {
    return std::nullopt;
  }
  node_->read.emplace(key);
  return node->value<std::string>();
}

bool Table::has_text(std::string_view key) const {
  if (exploration() != nullptr && !states(key)) {
    exploration()->note_text(node_->path, key);
    return false;
  }
  const toml::node* node = node_->table == nullptr ? nullptr : node_->table->get(key);
  const std::function<bool(const toml::node*)> within_it = [&](const toml::node* each) {
    const toml::array* array = each == nullptr ? nullptr : each->as_array();
    return array == nullptr
               ? each != nullptr && each->is_string()
               : std::any_of(array->begin(), array->end(),
                             [&](const toml::node& entry) { return within_it(&entry); });
  };
  return within_it(node);
}

std::string Table::shown_text(std::string_view key) {
  const bool absent = node_->table == nullptr && exploration() == nullptr;
  return absent ? "" : shown_as(key, text(key));
}

std::string Table::shown_text(std::string_view key, std::string_view otherwise) {
  return shown_as(key, has(key) ? text(key) : std::string(otherwise));
}

std::string Table::shown_as(std::string_view key, std::string text) {
  const std::string name = node_->full_name(key);
  const std::string* found = document_->translations.of(name, text);
  std::vector<ShownText>& all = document_->shown;
  ShownText entry{name, found != nullptr ? *found : text, found != nullptr};
  const auto known =
      std::find_if(all.begin(), all.end(), [&](const ShownText& each) { return each.key == name; });
  if (known == all.end()) {
    all.push_back(entry);
  } else {
    *known = entry;
  }
  return entry.text;
}

void Table::note_placeholders(std::string_view key, const std::vector<std::string>& words) {
  for (ShownText& each : document_->shown) {
    if (each.key == node_->full_name(key)) {
      each.placeholders = words;
    }
  }
}

void Table::translate(const Translations& translations) { document_->translations = translations; }

std::vector<ShownText> Table::shown_texts() const { return document_->shown; }

void Table::note_tunable(const KeyDescription& key, double value, const Bounds& bounds,
                         std::string_view unit) {
  if (key.tunable) {
    document_->tunable.push_back(
        {node_->full(key.name), key.text, bounds, std::string(unit), value});
  }
}

const std::vector<TunableKey>& Table::tunable_keys() const { return document_->tunable; }

void Table::name_entry(std::string_view name) {
  const std::size_t dot = node_->named.rfind('.');
  node_->named = node_->named.substr(0, dot == std::string::npos ? 0 : dot + 1) + std::string(name);
}

}  // namespace haptrial
