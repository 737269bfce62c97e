#include "core/base/definition/table_vector.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace haptrial {

Eigen::Vector3d read_vector(Table& table, std::string_view key, const Bounds& bounds,
                            std::string_view unit, const Eigen::Vector3d& otherwise) {
  const std::vector<double> numbers = table.numbers(key, bounds, unit);
  if (numbers.size() != 3) {
    table.reject(key, fmt::format("a list of {} numbers", numbers.size()),
                 "three numbers: x, y, z");
    return otherwise;
  }
  return {numbers[0], numbers[1], numbers[2]};
}

Eigen::Vector3d read_direction(Table& table, std::string_view key) {
  const Eigen::Vector3d vector = read_vector(table, key, {-1.0, 1.0}, "", Eigen::Vector3d::UnitY());
  if (!(vector.norm() > 0.0)) {
    table.reject(key, "is zero; write a direction");
    return Eigen::Vector3d::UnitY();
  }
  return vector.normalized();
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
