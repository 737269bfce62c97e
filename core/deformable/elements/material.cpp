#include "core/deformable/elements/material.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/base/error.h"

namespace haptrial::deformable {
namespace {

constexpr std::array<std::string_view, 3> kLawNames{"linear", "corotational", "neo-hookean"};

}  // namespace

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

std::string_view name_of(Law law) { return kLawNames[static_cast<std::size_t>(law)]; }

Law law_named(std::string_view name) {
  for (std::size_t i = 0; i < kLawNames.size(); ++i) {
    if (kLawNames[i] == name) {
      return static_cast<Law>(i);
    }
  }
  throw InputError(fmt::format("the law is '{}'; allowed: {}", name,
                               fmt::join(kLawNames.begin(), kLawNames.end(), ", ")));
}

}  // namespace haptrial::deformable
