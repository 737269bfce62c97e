#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "core/scene/read/field_reader.h"

namespace haptrial::scene {

Eigen::Vector3d FieldReader::direction(std::string_view key) const {
  const Eigen::Vector3d found = vector(key, kDirectionBounds, "");
  if (!(found.norm() > 0.0)) {
    table.reject(key, "is zero; write a direction");
    return Eigen::Vector3d::UnitY();
  }
  return found;
}

control::PdGains FieldReader::gains() const {
  return {number("stiffness", kStiffnessBounds, "N/m"), number("damping", kDampingBounds, "N·s/m")};
}

double FieldReader::frequency(std::string_view key) const {
  const double found = number(key, kFilterBounds, "Hz");
  if (!(found < 0.5 * rate)) {
    table.reject(key, fmt::format("{} Hz", found),
                 fmt::format("a number below half the servo loop's rate, {} Hz", 0.5 * rate));
    return 0.25 * rate;
  }
  return found;
}

std::uint64_t FieldReader::seed() const {
  const double found = number("seed", {0.0, 9007199254740992.0}, "");
  if (found != std::floor(found)) {
    table.reject("seed", fmt::format("{}", found), "a whole number");
  }
  return static_cast<std::uint64_t>(found);
}

}  // namespace haptrial::scene
