#include "protocols/psychophysics/definition/names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/base/definition/table.h"
#include "core/base/error.h"

namespace haptrial::protocols {
namespace {

/// A text that names a variable and nothing else: "$name".
bool is_name(std::string_view text) {
  return text.size() > 1 && text.front() == '$' &&
         std::all_of(text.begin() + 1, text.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '.'; });
}

std::string quoted_word(const std::string& word) { return "'" + word + "'"; }

/// A number or a text as a formula.
std::string formula_of(Table& table, const std::string& key) {
  if (const auto text = table.whole_text(key)) {
    return *text;
  }
  return fmt::format("{}", table.number(key, {}, ""));
}

}  // namespace

void Names::read(Table& root) {
  if (root.has("variables")) {
    Table table = root.table("variables");
    for (const std::string& name : table.keys()) {
      read_variable(table, name);
    }
  }
  if (root.has("places")) {
    Table table = root.table("places");
    for (const std::string& name : table.keys()) {
      read_place(table, name);
    }
  }
}

void Names::read_variable(Table& table, const std::string& name) {
  table.describe({name, "Value of the variable NAME: a number, formula or quoted word", "", true});
  std::string formula;
  if (table.is_table(name)) {  // by the word of another
    Table choice = table.table(name);
    choice.describe({"from", "Name whose word chooses the value of the variable", "", true});
    const std::string from = choice.text("from");
    std::string tail = fmt::format("${}", from);  // a word without an entry: stays a word
    for (const std::string& word : choice.keys()) {
      if (word != "from") {
        choice.describe({word,
                         "Value of the variable while the name of `from` stands for the word NAME",
                         "", true});
        tail = fmt::format("(${} == {}) ? ({}) : ({})", from, quoted_word(word),
                           formula_of(choice, word), tail);
      }
    }
    formula = tail;
  } else {
    formula = formula_of(table, name);
  }
  try {
    variables_.define(name, Expression(formula, labels_));
    stated_.push_back(name);
  } catch (const InputError& error) {
    table.reject(name, fmt::format("is \"{}\": {}", formula, error.what()));
  }
}

void Names::read_place(Table& table, const std::string& name) {
  table.describe(
      {name, "Coordinates x, y and z of the place: three numbers or formulas", "", true});
  const auto rows = table.rows(name, "three numbers or formulas, x, y and z [m]");
  std::vector<Expression> place;
  if (rows.size() != 1 || rows[0].size() != 3) {
    table.reject(name, "an array of another size", "three numbers or formulas, x, y and z [m]");
    return;
  }
  for (const NumberOrText& entry : rows[0]) {
    try {
      place.push_back(entry.number ? Expression(*entry.number) : Expression(entry.text, labels_));
    } catch (const InputError& error) {
      table.reject(name, fmt::format("has \"{}\": {}", entry.text, error.what()));
      return;
    }
  }
  places_.emplace(name, std::move(place));
}

const Expression& Names::formula(const std::string& text) const {
  const auto found = formulas_.find(text);
  return found != formulas_.end()
             ? found->second
             : formulas_.emplace(text, Expression(text, labels_)).first->second;
}

double Names::value(const std::string& text) const { return variables_.value(formula(text)); }

std::string Names::word(const std::string& text) const {
  if (!is_name(text)) {
    return text;
  }
  const double value = variables_.value(text.substr(1));
  const auto word = labels_.word_of(value);
  return word ? *word : fmt::format("{:g}", value);
}

std::vector<std::string> Names::places() const {
  std::vector<std::string> names;
  for (const auto& [name, coordinates] : places_) {
    names.push_back(name);
  }
  return names;
}

Eigen::Vector3d Names::place(const std::string& name) const {
  const auto found = places_.find(name);
  if (found == places_.end()) {
    std::vector<std::string> known;
    for (const auto& [each, place] : places_) {
      known.push_back(each);
    }
    throw InputError(fmt::format("there is no place {}; {}", name,
                                 known.empty()
                                     ? "the definition has no [places]"
                                     : fmt::format("allowed: {}", fmt::join(known, ", "))));
  }
  Eigen::Vector3d place;
  for (int axis = 0; axis < 3; ++axis) {
    place[axis] = variables_.value(found->second[static_cast<std::size_t>(axis)]);
  }
  return place;
}

std::optional<double> Names::value_of(std::string_view text) const {
  const double value = this->value(std::string(text));
  if (const auto word = labels_.word_of(value)) {
    throw InputError(fmt::format("it is the word '{}', not a number", *word));
  }
  return value;
}

std::optional<Eigen::Vector3d> Names::vector_of(std::string_view text) const {
  const bool named = !text.empty() && text.front() == '$';
  return place(std::string(named ? text.substr(1) : text));
}

void Names::check(Table& root) const {
  const auto each = [&](const char* table_name, const std::string& name,
                        const Expression& formula) {
    try {
      variables_.check(formula);
    } catch (const InputError& error) {
      root.table(table_name)
          .reject(name, fmt::format("is \"{}\": {}", formula.text(), error.what()));
    }
  };
  for (const std::string& name : stated_) {
    each("variables", name, formula("$" + name));
  }
  for (const auto& [name, place] : places_) {
    for (const Expression& part : place) {
      each("places", name, part);
    }
  }
}

namespace {

void refuse_circle(const std::string& name, const std::vector<std::string>& way) {
  const auto first = std::ranges::find(way, name);
  if (first != way.end()) {
    throw InputError(
        fmt::format("{} depends on itself, by way of {}", name, fmt::join(first, way.end(), ", ")));
  }
}

}  // namespace

void Variables::define(const std::string& name, Expression meaning) {
  if (meanings_.contains(name)) {
    throw InputError(fmt::format("there is a variable {} already", name));
  }
  meanings_.emplace(name, std::move(meaning));
  declare(name);
}

void Variables::declare(const std::string& name) {
  given_.emplace(name, std::numeric_limits<double>::quiet_NaN());
}

bool Variables::knows(const std::string& name) const { return given_.contains(name); }

std::vector<std::string> Variables::names() const {
  std::vector<std::string> names;
  for (const auto& [name, value] : given_) {
    names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

void Variables::refuse(const std::string& name) const {
  throw InputError(
      fmt::format("there is no variable {}; allowed: {}", name, fmt::join(names(), ", ")));
}

void Variables::check(const std::string& name, std::vector<std::string>& way) const {
  refuse_circle(name, way);
  const auto found = meanings_.find(name);
  if (found == meanings_.end()) {
    if (given_.contains(name)) {
      return;
    }
    refuse(name);
  }
  way.push_back(name);
  for (const std::string& each : found->second.names()) {
    check(each, way);
  }
  way.pop_back();
}

void Variables::check(const Expression& expression) const {
  std::vector<std::string> way;
  for (const std::string& name : expression.names()) {
    check(name, way);
  }
}

void Variables::set(const std::string& name, double value) {
  const auto found = given_.find(name);
  if (found == given_.end()) {
    throw std::invalid_argument("Variables::set: " + name + " is not declared");
  }
  found->second = value;
}

void Variables::forget_given() {
  for (auto& [name, value] : given_) {
    value = std::numeric_limits<double>::quiet_NaN();
  }
}

std::map<std::string, double> Variables::known() const {
  std::map<std::string, double> known;
  for (const auto& [name, given] : given_) {
    try {
      known.emplace(name, value(name));
    } catch (const InputError&) {  // waits for a value, such as an answer
    }
  }
  return known;
}

double Variables::value(const std::string& name, std::vector<std::string>& way) const {
  refuse_circle(name, way);
  read_.insert(name);
  const auto given = given_.find(name);
  if (given != given_.end() && !std::isnan(given->second)) {
    return given->second;
  }
  const auto found = meanings_.find(name);
  if (found == meanings_.end()) {
    if (given != given_.end()) {
      throw InputError(fmt::format(
          "{0} has no value yet; write {0} = VALUE in the block, or let a factor give it", name));
    }
    refuse(name);
  }
  way.push_back(name);
  const double result =
      found->second.value([&](const std::string& each) { return value(each, way); });
  way.pop_back();
  return result;
}

double Variables::value(const std::string& name) const {
  std::vector<std::string> way;
  return value(name, way);
}

double Variables::value(const Expression& expression) const {
  return expression.value([this](const std::string& name) { return value(name); });
}

std::unique_ptr<Names> NamesPool::take() {
  {
    const std::lock_guard lock(mutex_);
    if (!spare_.empty()) {
      std::unique_ptr<Names> names = std::move(spare_.back());
      spare_.pop_back();
      return names;
    }
  }
  return std::make_unique<Names>(original_);
}

void NamesPool::give_back(std::unique_ptr<Names> names) {
  names->forget_given();
  const std::lock_guard lock(mutex_);
  spare_.push_back(std::move(names));
}

}  // namespace haptrial::protocols
