#include "core/deformable/elements/material.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/base/error.h"

namespace haptrial::deformable {
Moduli moduli(const Material& material) {
  return {material.young / (2 * (1 + material.poisson)),
          material.young / (3 * (1 - 2 * material.poisson))};
}

void check_material(const Material& material, const std::string& name) {
  if (!(material.young > 0) || !std::isfinite(material.young)) {
    throw InputError(
        fmt::format("{}: Young's modulus is {} Pa; allowed: above 0", name, material.young));
  }
  if (!(material.poisson > -1 && material.poisson < 0.5)) {
    throw InputError(fmt::format("{}: Poisson's ratio is {}; allowed: above -1 and below 0.5", name,
                                 material.poisson));
  }
  if (!(material.density > 0) || !std::isfinite(material.density)) {
    throw InputError(
        fmt::format("{}: the density is {} kg/m³; allowed: above 0", name, material.density));
  }
}

std::string_view name_of(Law law) {
  constexpr std::array<std::string_view, 3> kNames{"linear", "corotational", "neo-hookean"};
  return kNames[static_cast<std::size_t>(law)];
}

}  // namespace haptrial::deformable
