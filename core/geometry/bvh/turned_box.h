#pragma once

#include <span>

#include "core/geometry/bvh/bvh_data.h"
#include "core/geometry/mesh/four.h"

namespace haptrial::geometry {

/// Puts a box into a place: the box as it is.
void write_upright(const FourBox& box, TurnedBoxes& boxes, int place);

/// A box around triangles, turned so that its third axis is along the mean normal and its first
/// where the corners spread most; upright where that has less surface.
/// @param corners  three to a triangle
void write_turned(std::span<const Four> corners, const FourBox& box, TurnedBoxes& boxes, int place);

/// A place without a box: infinitely far from every point.
void leave_empty(TurnedBoxes& boxes, int place);

}  // namespace haptrial::geometry
