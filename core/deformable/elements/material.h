#pragma once

#include <string>
#include <string_view>

namespace haptrial::deformable {

/// An isotropic material, by what a handbook says of it.
/// Source: Morris 2006, §5.3.2 ("constitutive elastic properties").
struct Material {
  double young{};          // Young's modulus E > 0 [Pa]
  double poisson{};        // Poisson's ratio, -1 < nu < 0.5
  double density{1000.0};  // > 0 [kg/m³]
};

/// Resistance to a change of form and to a change of volume:
///
///     shear = E / (2 (1 + nu)),  bulk = E / (3 (1 - 2 nu))
struct Moduli {
  double shear{};  // mu [Pa]
  double bulk{};   // K [Pa]
};

Moduli moduli(const Material& material);

/// @param name  of the material, as a message calls it
/// @throws InputError naming the value that breaks its bound.
void check_material(const Material& material, const std::string& name);

/// How stress follows from strain (tet_laws.h has the formulae).
enum class Law {
  kLinear,        // small strains and small turns
  kCorotational,  // small strains, large turns
  kNeoHookean,    // large strains and turns
};

std::string_view name_of(Law law);

}  // namespace haptrial::deformable
