#include "protocols/psychophysics/definition/variables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/nearest.h"

namespace haptrial::protocols {
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

}  // namespace haptrial::protocols
