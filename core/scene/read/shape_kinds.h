#pragma once

#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/scene/shape.h"

namespace haptrial::scene {

/// One kind of shape: of a region, and of a field that is felt as its surface, which has the keys
/// of a surface (stiffness, damping, felt_from) beside those of the shape.
struct KindOfShape {
  std::string word;             // `type` of a region
  Shape (*read)(Table& table);  // keys but `type`; problems are noted in the table
  std::string surface{};        // `type` of the field; empty: the same word

  const std::string& field_word() const { return surface.empty() ? word : surface; }
};

/// Every kind that read_region() knows:
///
///     half_space   point, normal                       inside: where normal does not point to
///     sphere       centre, radius
///     box          centre, size, turn (optional)       turn: axis times angle [rad]
///     cylinder     centre, axis, radius, length (optional; else endless)
///
/// A wall is the field of a half space; those of the others have their words. Call before threads
/// are started.
const std::vector<KindOfShape>& kinds_of_shape();

/// Adds a kind of a program's own, and the kind of field that is felt as its surface; its read()
/// gives a RegisteredShape.
/// @throws std::invalid_argument for a word that a shape or a field has
void add_kind_of_shape(const KindOfShape& kind);

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
