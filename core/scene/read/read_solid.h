#pragma once

#include <string>

#include "core/contact/surface/felt_body.h"
#include "core/scene/field.h"
#include "core/scene/read/number_source.h"

namespace haptrial::scene {

/// Reads how one table [objects.NAME] is felt, as a field (core/scene/surface/rigid_object.h). Keys
/// in brackets are optional; all numbers may be formulas. Problems are noted in the table.
///
///     stiffness [N/m], damping [N·s/m]
///     [centre]       of the body's origin in W, 0 if left out [m]
///     [turn]         of its axes: axis times angle [rad]
///     [scale]        of its size, 1 if left out
///     [friction]     { static, dynamic }: coefficients, static at least dynamic
///     [shading]      crease angle of force shading, 0 to pi / 2 [rad]; none if left out
///     [resolution]   of voxel and distance field: cells along the longest side, 64 if left out
///     [tool_radius]  of the sphere that stands for the hand, at most 0.05 [m]; a point if left out
///     [renderer]     "proxy", or for comparison "ruspini", "penalty", "voxel", "distance field"
///     [limit], [fade_in], [fade_out]  as of every field
///
/// @param body  that its shape describes; null: it is not known yet, nothing is felt
Field read_solid(Table& table, std::string name, const contact::SharedBody& body,
                 const NumberSource& source = {});

}  // namespace haptrial::scene
