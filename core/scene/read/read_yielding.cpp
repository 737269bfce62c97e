#include "core/scene/read/read_yielding.h"

#include <utility>

#include "core/base/error.h"
#include "core/deformable/touch/tissue.h"
#include "core/scene/read/field_reader.h"
#include "core/scene/read/object_keys_internal.h"

namespace haptrial::scene {
namespace {

constexpr Bounds kYoungBounds{0.0, 1e9, true};  // [Pa]

deformable::Inclusion read_inclusion(Table& table, std::string name, const NumberSource& source) {
  const FieldReader read{table, source};
  return {std::move(name), read.place("centre"), read.number("radius", {0.0, 1.0}, "m"),
          read.number("young", kYoungBounds, "Pa")};
}

deformable::Tissue read_tissue(const FieldReader& read) {
  deformable::Tissue tissue;
  tissue.young = read.number("young", kYoungBounds, "Pa");
  tissue.poisson = read.number("poisson", {0.0, deformable::kMostPoisson}, "");
  if (read.table.has("inclusions")) {
    Table inclusions = read.table.table("inclusions");
    for (const std::string& name : inclusions.keys()) {
      Table own = inclusions.table(name);
      tissue.inclusions.push_back(read_inclusion(own, name, read.source));
    }
  }
  return tissue;
}

}  // namespace

Field read_yielding(Table& table, std::string name, const deformable::SharedFeltMesh& mesh,
                    const NumberSource& source) {
  const FieldReader read{table, source};
  Field field;
  field.name = std::move(name);
  read_limits(read, field);
  YieldingParameters p;
  p.mesh = mesh;
  p.tissue = read_tissue(read);
  p.pose = read_pose(read);
  p.tool.radius = read.number_or(p.tool.radius, "tool_radius", {0.0, 0.05}, "m");
  p.tool.stiffness =
      read.number_or(p.tool.stiffness, "spring", {0.0, kStiffnessBounds.high, true}, "N/m");
  p.tool.friction = read_contact_friction(read);
  if (mesh && p.tissue.young > 0.0) {
    try {
      deformable::check_tissue(*mesh, p.tissue);
    } catch (const InputError& error) {
      table.reject("young", std::string("cannot be felt: ") + error.what());
    }
  }
  field.kind = std::move(p);
  return field;
}

}  // namespace haptrial::scene
