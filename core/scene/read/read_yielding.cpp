#include "core/scene/read/read_yielding.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/error.h"
#include "core/deformable/touch/tissue.h"
#include "core/scene/read/field_reader.h"
#include "core/scene/read/object_keys_internal.h"

namespace haptrial::scene {
namespace {

constexpr Bounds kYoungBounds{0.0, 1e9, true};  // [Pa]
constexpr double kDecay = 10.0;                 // of springs [1/s]

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

deformable::SpringTissue read_springs(const FieldReader& read) {
  deformable::SpringTissue springs;
  if (read.table.has("calibrated")) {
    read.table.text("calibrated");
  } else {
    const Eigen::Vector3d constants = read.vector("constants", {0.0, 1e6}, "J");
    springs.constants = {constants[0], constants[1], constants[2]};
    if (!(springs.constants.length > 0.0)) {
      read.table.reject("constants",
                        fmt::format("[{}, {}, {}] J", constants[0], constants[1], constants[2]),
                        "a number above 0 for the edges, and at least 0 for faces and tetrahedra");
    }
  }
  springs.density = read.number("density", {0.0, 1e5, true}, "kg/m³");
  springs.decay = read.number_or(kDecay, "decay", {0.0, 1e4}, "1/s");
  return springs;
}

}  // namespace

Field read_yielding(Table& table, std::string name, const deformable::SharedFeltMesh& mesh,
                    const NumberSource& source,
                    std::shared_ptr<const deformable::SpringConstants> calibrated) {
  const FieldReader read{table, source};
  Field field;
  field.name = std::move(name);
  read_limits(read, field);
  DeformableObjectParameters p;
  p.mesh = mesh;
  if (table.has("model") && table.choice("model", {"elements", "springs"}) == "springs") {
    p.springs = read_springs(read);
    p.springs->calibrated = std::move(calibrated);
    p.rate = table.has("rate") ? read.number("rate", {0.0, 1e5, true}, "Hz") : 0.0;
  } else {
    p.tissue = read_tissue(read);
  }
  p.pose = read_pose(read);
  p.tool.radius = read.number_or(p.tool.radius, "tool_radius", {0.0, 0.05}, "m");
  p.tool.stiffness =
      read.number_or(p.tool.stiffness, "spring", {0.0, kStiffnessBounds.high, true}, "N/m");
  p.tool.friction = read_contact_friction(read);
  if (mesh && !p.springs && p.tissue.young > 0.0) {
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
