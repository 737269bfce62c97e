#include "core/scene/read/number_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/definition/table.h"
#include "core/base/definition/table_vector.h"
#include "core/base/error.h"

namespace haptrial::scene {
namespace {

bool is_within(double x, const Bounds& b) {
  return std::isfinite(x) && (b.open_low ? x > b.low : x >= b.low) && x <= b.high;
}

std::string range(const Bounds& b, std::string_view unit) {
  return fmt::format("a number {} {} and at most {}{}", b.open_low ? "above" : "of at least", b.low,
                     b.high, unit.empty() ? "" : fmt::format(" [{}]", unit));
}

constexpr const char* kRowsAllowed =
    "three rows of three numbers, [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]]";

}  // namespace

std::optional<double> NumberSource::value_of(std::string_view) const { return std::nullopt; }
std::optional<Eigen::Vector3d> NumberSource::vector_of(std::string_view) const {
  return std::nullopt;
}

/// The worth of one text; nothing, with the problem noted, if it has none or is out of bounds.
std::optional<double> NumberSource::entry(Table& table, std::string_view key, std::string_view text,
                                          const Bounds& bounds, std::string_view unit) const {
  std::optional<double> value;
  try {
    value = value_of(text);
  } catch (const InputError& error) {
    table.reject(key, fmt::format("is \"{}\": {}", text, error.what()));
    return std::nullopt;
  }
  if (!value) {
    table.reject(key, fmt::format("the text \"{}\"", text), range(bounds, unit));
  } else if (!is_within(*value, bounds)) {
    table.reject(key, fmt::format("{} (\"{}\")", *value, text), range(bounds, unit));
    return std::nullopt;
  }
  return value;
}

double NumberSource::number(Table& table, std::string_view key, const Bounds& bounds,
                            std::string_view unit) const {
  if (const auto text = table.whole_text(key); text && takes_texts()) {
    const double otherwise = bounds.open_low ? bounds.high : bounds.low;
    return entry(table, key, *text, bounds, unit).value_or(otherwise);
  }
  return table.number(key, bounds, unit);
}

/// The place that one text stands for; nothing, with the problem noted, if there is none.
std::optional<Eigen::Vector3d> NumberSource::place(Table& table, std::string_view key,
                                                   std::string_view text, const Bounds& bounds,
                                                   std::string_view allowed) const {
  std::optional<Eigen::Vector3d> found;
  try {
    found = vector_of(text);
  } catch (const InputError& error) {
    table.reject(key, fmt::format("is \"{}\": {}", text, error.what()));
    return std::nullopt;
  }
  if (!found || !is_within(found->minCoeff(), bounds) || !is_within(found->maxCoeff(), bounds)) {
    table.reject(key, fmt::format("the text \"{}\"", text), allowed);
    return std::nullopt;
  }
  return found;
}

/// The place of three entries; nothing, with the problem noted, if they are no place.
std::optional<Eigen::Vector3d> NumberSource::row(Table& table, std::string_view key,
                                                 const std::vector<NumberOrText>& entries,
                                                 const Bounds& bounds, std::string_view unit,
                                                 std::string_view allowed) const {
  if (entries.size() != 3) {
    table.reject(key, "an array of another size", allowed);
    return std::nullopt;
  }
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const NumberOrText& each = entries[static_cast<std::size_t>(i)];
    const auto value = each.number ? each.number : entry(table, key, each.text, bounds, unit);
    vector[i] = value.value_or(0.0);
    if (value && !is_within(*value, bounds)) {
      table.reject(key, fmt::format("an array with {}", *value), allowed);
    }
  }
  return vector;
}

Eigen::Vector3d NumberSource::vector(Table& table, std::string_view key, const Bounds& bounds,
                                     std::string_view unit) const {
  if (!table.has_text(key)) {
    return read_vector(table, key, bounds, unit);
  }
  const std::string allowed =
      fmt::format("three numbers, x, y and z, each {}", range(bounds, unit));
  std::optional<Eigen::Vector3d> found;
  if (const auto whole = table.whole_text(key)) {
    found = place(table, key, *whole, bounds, allowed);
  } else if (const auto rows = table.rows(key, allowed); rows.size() == 1) {
    found = row(table, key, rows.front(), bounds, unit, allowed);
  } else {
    table.reject(key, "an array of another size", allowed);
  }
  return found.value_or(Eigen::Vector3d::Zero());
}

std::vector<Eigen::Vector3d> NumberSource::vectors(Table& table, std::string_view key,
                                                   const Bounds& bounds,
                                                   std::string_view unit) const {
  const std::string allowed =
      fmt::format("a list of places, [[x, y, z], …], each number {}", range(bounds, unit));
  std::vector<Eigen::Vector3d> places;
  const auto add = [&](const std::optional<Eigen::Vector3d>& found) {
    if (found) {
      places.push_back(*found);
    }
  };
  const auto rows = table.rows(key, allowed);
  const bool named = rows.size() == 1 && !table.is_nested(key);
  for (const auto& entries : rows) {
    if (!named) {
      add(row(table, key, entries, bounds, unit, allowed));
      continue;
    }
    for (const NumberOrText& each : entries) {
      if (each.number) {
        table.reject(key, fmt::format("a list with {}", *each.number), allowed);
        return places;
      }
      add(place(table, key, each.text, bounds, allowed));
    }
  }
  return places;
}

Eigen::Matrix3d NumberSource::matrix(Table& table, std::string_view key, const Bounds& bounds,
                                     std::string_view unit) const {
  const auto rows = table.rows(key, kRowsAllowed);
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  const bool square =
      rows.size() == 3 &&
      std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.size() == 3; });
  if (!square) {
    table.reject(key, fmt::format("an array of {}", rows.size()), kRowsAllowed);
    return matrix;
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      const NumberOrText& each = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      const auto value = each.number ? each.number : entry(table, key, each.text, bounds, unit);
      matrix(i, j) = value.value_or(0.0);
      if (value && !is_within(*value, bounds)) {
        table.reject(key, fmt::format("an array with {}", *value), range(bounds, unit));
      }
    }
  }
  return matrix;
}

}  // namespace haptrial::scene
