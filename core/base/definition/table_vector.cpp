#include "core/base/definition/table_vector.h"

#include <fmt/format.h>

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

}  // namespace haptrial
