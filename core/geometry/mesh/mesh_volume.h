#pragma once

#include "core/geometry/mesh/mesh.h"

namespace haptrial::geometry {

/// Volume of the region that a closed, oriented mesh bounds, negative if faces look inwards; for
/// any other mesh the integral of x·n / 3 about the middle of its box [m³].
double signed_volume(const Mesh& mesh);

}  // namespace haptrial::geometry
