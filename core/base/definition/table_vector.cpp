#include "core/base/definition/table_vector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/base/definition/number_source.h"
#include "core/base/definition/table_words_internal.h"
#include "core/base/error.h"

namespace haptrial {
namespace {

using Eigen::Vector3d;

constexpr const char* kMatrix =
    "three rows of three numbers, [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]]";

/// The key, bounds and unit that every number of a value has.
struct Allowed {
  std::string_view key;
  const Bounds& bounds;
  std::string_view unit;
  std::string words;  // of the whole value
};

/// The place that one text stands for; nothing, with the problem noted, if there is none.
std::optional<Vector3d> place(Table& table, const Allowed& allowed, std::string_view text) {
  std::optional<Vector3d> found;
  try {
    found = table.numbers() == nullptr ? std::nullopt : table.numbers()->vector_of(text);
  } catch (const InputError& error) {
    table.reject(allowed.key, fmt::format("is \"{}\": {}", text, error.what()));
    return std::nullopt;
  }
  if (!found || !within(found->minCoeff(), allowed.bounds) ||
      !within(found->maxCoeff(), allowed.bounds)) {
    table.reject(allowed.key, fmt::format("the text \"{}\"", text), allowed.words);
    return std::nullopt;
  }
  return found;
}

/// A number, or the worth of a text; zero, with the problem noted, if it is not allowed.
double entry(Table& table, const Allowed& allowed, const NumberOrText& each,
             const std::string& words) {
  const auto value =
      each.number ? each.number : table.worth(allowed.key, each.text, allowed.bounds, allowed.unit);
  if (value && !within(*value, allowed.bounds)) {
    table.reject(allowed.key, fmt::format("an array with {}", *value), words);
  }
  return value.value_or(0.0);
}

/// The place of three entries; nothing, with the problem noted, if they are not three.
std::optional<Vector3d> row(Table& table, const Allowed& allowed,
                            const std::vector<NumberOrText>& entries) {
  if (entries.size() != 3) {
    table.reject(allowed.key, "an array of another size", allowed.words);
    return std::nullopt;
  }
  return Vector3d(entry(table, allowed, entries[0], allowed.words),
                  entry(table, allowed, entries[1], allowed.words),
                  entry(table, allowed, entries[2], allowed.words));
}

/// A vector that is a text, or has texts among its numbers.
Vector3d vector_with_texts(Table& table, std::string_view key, const Bounds& bounds,
                           std::string_view unit, const Vector3d& otherwise) {
  const Allowed allowed{key, bounds, unit,
                        fmt::format("three numbers, x, y and z, each {}", words(bounds, unit))};
  if (const auto whole = table.whole_text(key)) {
    return place(table, allowed, *whole).value_or(otherwise);
  }
  const auto rows = table.rows(key, allowed.words);
  if (rows.size() != 1) {
    table.reject(key, "an array of another size", allowed.words);
    return otherwise;
  }
  return row(table, allowed, rows.front()).value_or(otherwise);
}

}  // namespace

Eigen::Vector3d read_vector(Table& table, std::string_view key, const Bounds& bounds,
                            std::string_view unit, const Eigen::Vector3d& otherwise) {
  if (const auto given = table.given_for(unit)) {
    return given->factor *
           read_vector(table, key, given->bounds(bounds), given->unit, otherwise / given->factor);
  }
  if (table.numbers() != nullptr && table.has_text(key)) {
    return vector_with_texts(table, key, bounds, unit, otherwise);
  }
  const std::vector<double> numbers = table.numbers(key, bounds, unit);
  if (numbers.size() != 3) {
    table.reject(key, fmt::format("a list of {} numbers", numbers.size()),
                 "three numbers: x, y, z");
    return otherwise;
  }
  return {numbers[0], numbers[1], numbers[2]};
}

Eigen::Vector3d read_any_direction(Table& table, std::string_view key) {
  const Vector3d found = read_vector(table, key, {-1e3, 1e3}, "", Vector3d::Zero());
  if (!(found.norm() > 0.0)) {
    table.reject(key, "is zero; write a direction");
    return Vector3d::UnitY();
  }
  return found;
}

std::vector<Eigen::Vector3d> read_vectors(Table& table, std::string_view key, const Bounds& bounds,
                                          std::string_view unit) {
  if (const auto given = table.given_for(unit)) {
    std::vector<Vector3d> places = read_vectors(table, key, given->bounds(bounds), given->unit);
    for (Vector3d& place : places) {
      place *= given->factor;
    }
    return places;
  }
  const Allowed allowed{
      key, bounds, unit,
      fmt::format("a list of places, [[x, y, z], …], each number {}", words(bounds, unit))};
  std::vector<Vector3d> places;
  const auto add = [&](const std::optional<Vector3d>& found) {
    if (found) {
      places.push_back(*found);
    }
  };
  const auto rows = table.rows(key, allowed.words);
  const bool named = rows.size() == 1 && !table.is_nested(key);
  for (const auto& entries : rows) {
    if (!named) {
      add(row(table, allowed, entries));
      continue;
    }
    for (const NumberOrText& each : entries) {
      if (each.number) {
        table.reject(key, fmt::format("a list with {}", *each.number), allowed.words);
        return places;
      }
      add(place(table, allowed, each.text));
    }
  }
  return places;
}

Eigen::Matrix3d read_matrix(Table& table, std::string_view key, const Bounds& bounds,
                            std::string_view unit) {
  if (const auto given = table.given_for(unit)) {
    return given->factor * read_matrix(table, key, given->bounds(bounds), given->unit);
  }
  const auto rows = table.rows(key, kMatrix);
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  const bool square =
      rows.size() == 3 &&
      std::all_of(rows.begin(), rows.end(), [](const auto& each) { return each.size() == 3; });
  if (!square) {
    table.reject(key, fmt::format("an array of {}", rows.size()), kMatrix);
    return matrix;
  }
  const Allowed allowed{key, bounds, unit, words(bounds, unit)};
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      const auto& each = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      matrix(i, j) = entry(table, allowed, each, allowed.words);
    }
  }
  return matrix;
}

Eigen::Vector3d read_direction(Table& table, std::string_view key) {
  const Eigen::Vector3d vector = read_vector(table, key, {-1.0, 1.0}, "", Eigen::Vector3d::UnitY());
  if (!(vector.norm() > 0.0)) {
    table.reject(key, "is zero; write a direction");
    return Eigen::Vector3d::UnitY();
  }
  return vector.normalized();
}

std::uint64_t read_seed(Table& table, std::string_view key) {
  const double found = table.number(key, {0.0, 9007199254740992.0}, "");
  if (found != std::floor(found)) {
    table.reject(key, fmt::format("{}", found), "a whole number");
  }
  return static_cast<std::uint64_t>(found);
}

std::uint32_t read_bits(Table& table, std::string_view key) {
  constexpr double kLast = 30.0;
  std::uint32_t mask = 0;
  for (const double number : table.numbers(key, {0.0, kLast}, "")) {
    if (number != std::floor(number)) {
      table.reject(key, fmt::format("a list with {}", number),
                   "whole numbers, such as those of buttons from 0");
    } else {
      mask |= std::uint32_t{1} << static_cast<unsigned>(number);
    }
  }
  return mask;
}

}  // namespace haptrial
