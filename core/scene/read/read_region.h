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

/// Reads one table [regions.NAME]: `type` and the keys of its kind (shape_kinds.h). Problems are
/// noted in the table.
Region read_region(Table& table, std::string name);

/// Every table of [regions].
std::vector<Region> read_regions(Table& regions);

}  // namespace haptrial::scene
