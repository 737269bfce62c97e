#include "protocols/bone_drilling/definition/cavity.h"

#include <fmt/format.h>

#include "core/base/definition/table_vector.h"

namespace haptrial::protocols {

subject::CavityParameters read_cavity_parameters(Table& table) {
  subject::CavityParameters p;
  const auto number = [&](const char* key, double& value, const Bounds& bounds, const char* unit) {
    value = table.number_or(key, value, bounds, unit);
  };
  if (table.has("inward")) {
    p.inward = read_direction(table, "inward");
  }
  p.beside = table.has("beside") ? table.text("beside") : p.beside;
  p.offset_B = table.has("offset")
                   ? read_vector(table, "offset", {-1.0, 1.0}, "m", Eigen::Vector3d::UnitY())
                   : p.offset_B;
  number("radius", p.radius, {1e-4, 0.02}, "m");
  number("slope", p.slope, {0.0, 5.0}, "");
  number("margin", p.margin, {0.0, 0.01}, "m");
  if (table.has("structures") || table.has("margins")) {
    p.structures = table.texts("structures");
    p.margins = table.numbers("margins", {0.0, 0.01}, "m");
    if (p.margins.size() != p.structures.size()) {
      table.reject("margins", fmt::format("has {} numbers; write one for each of the {} structures",
                                          p.margins.size(), p.structures.size()));
      p.margins.resize(p.structures.size(), 0.0);
    }
  }
  return p;
}

}  // namespace haptrial::protocols
