#pragma once

#include <string>
#include <vector>

#include "core/scene/shape.h"

namespace haptrial {
class Table;
}

namespace haptrial::scene {

/// A part of space that stages ask about: "until inside", "hidden beyond".
struct Region {
  std::string name;  // of the table [regions.NAME]
  Shape shape;
};

/// Reads one table [regions.NAME]: `type` and the keys of its kind. Problems are noted in the
/// table.
///
///     half_space   point, normal                       inside: where normal does not point to
///     sphere       centre, radius
///     box          centre, size, turn (optional)       turn: axis times angle [rad]
///     cylinder     centre, axis, radius, length (optional; else endless)
Region read_region(Table& table, std::string name);

/// Every table of [regions].
std::vector<Region> read_regions(Table& regions);

/// The keys of a shape without its `type`. @param kind  one of the words above
Shape read_shape(Table& table, const std::string& kind);

}  // namespace haptrial::scene
