#pragma once

#include <string>
#include <vector>

#include "core/deformable/body/load_case.h"
#include "core/deformable/elements/elastic_body.h"

namespace haptrial::deformable::calculix {

/// Displacements by CalculiX, of the same mesh of C3D4 elements and one material: *ELASTIC for the
/// linear law, *HYPERELASTIC, NEO HOOKE with NLGEOM for the neo-Hookean one.
/// @param increments  of the load where it is nonlinear
Vectors displacements(const ElasticBody& body, const LoadCase& load, int increments = 1);

}  // namespace haptrial::deformable::calculix
