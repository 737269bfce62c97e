#include "core/scene/read/read_deformable.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/error.h"
#include "core/deformable/touch/tissue.h"
#include "core/scene/read/object_keys_internal.h"

namespace haptrial::scene {
namespace {

constexpr Bounds kYoungBounds{0.0, 1e9, true};  // [Pa]
constexpr double kDecay = 10.0;                 // of what moves [1/s]

const Schema<deformable::Inclusion>& inclusion_schema() {
  using I = deformable::Inclusion;
  static const auto schema =
      Schema<I>()
          .vector("centre", &I::centre, kPlaceBounds, "m",
                  "Centre of a ball of another stiffness, from the body's origin")
          .required()
          .number("radius", &I::radius, {0.0, 1.0}, "m",
                  "Radius of a ball of another stiffness; 0: it is not there")
          .required()
          .number("young", &I::young, kYoungBounds, "Pa",
                  "Young's modulus of a ball of another stiffness")
          .required();
  return schema;
}

const Schema<deformable::Tissue>& tissue_schema() {
  using T = deformable::Tissue;
  static const auto schema =
      Schema<T>()
          .number("young", &T::young, kYoungBounds, "Pa", "Young's modulus of the body")
          .required()
          .number("poisson", &T::poisson, {0.0, deformable::kMostPoisson}, "",
                  "Poisson's ratio of the body")
          .required()
          .check([](Table& table, T& tissue) {
            if (!table.has("inclusions")) {
              return;
            }
            Table inclusions = table.table("inclusions");
            for (const std::string& name : inclusions.keys()) {
              Table own = inclusions.table(name);
              tissue.inclusions.push_back(inclusion_schema().read(own));
              tissue.inclusions.back().name = name;
            }
          });
  return schema;
}

void read_constants(Table& table, const std::string& key, deformable::SpringTissue& springs) {
  const Eigen::Vector3d constants = read_vector(table, key, {0.0, 1e6}, "J");
  springs.constants = {constants[0], constants[1], constants[2]};
  if (!(springs.constants.length > 0.0)) {
    table.reject(key, fmt::format("[{}, {}, {}] J", constants[0], constants[1], constants[2]),
                 "a number above 0 for the edges, and at least 0 for faces and tetrahedra");
  }
}

/// Parts of a body that moves, of springs or of elements.
const Schema<deformable::SpringTissue>& moving_schema() {
  using S = deformable::SpringTissue;
  static const auto schema =
      Schema<S>()
          .number("density", &S::density, {0.0, 1e5, true}, "kg/m³", "Density of a body that moves")
          .required()
          .number("decay", &S::decay, {0.0, 1e4}, "1/s",
                  "Rate at which a free motion of a body that moves dies down: exp(-decay t)");
  return schema;
}

deformable::SpringTissue read_springs(Table& table) {
  deformable::SpringTissue springs;
  springs.decay = kDecay;
  table.describe({"calibrated",
                  "File of constants of springs that haptrial deform calibrate made, beside the "
                  "definition",
                  "needed, or constants", false});
  if (table.has("calibrated")) {
    table.text("calibrated");
  } else {
    table.describe({"constants",
                    "Constants of every edge, face and tetrahedron of a body of springs", "",
                    true});
    read_constants(table, "constants", springs);
  }
  moving_schema().read(table, springs);
  return springs;
}

deformable::ImplicitTissue read_implicit(Table& table) {
  deformable::SpringTissue moving;
  moving.decay = kDecay;
  moving_schema().read(table, moving);
  deformable::ImplicitTissue implicit{tissue_schema().read(table), moving.decay};
  implicit.tissue.density = moving.density;
  return implicit;
}

const Schema<deformable::TouchOptions>& touch_schema() {
  using T = deformable::TouchOptions;
  static const auto schema =
      Schema<T>()
          .number("tool_radius", &T::radius, {0.0, 0.05}, "m",
                  "Radius of the ball that stands for the hand; 0: a point")
          .number("spring", &T::stiffness, {0.0, kStiffnessBounds.high, true}, "N/m",
                  "Stiffness of the spring between the hand and the ball that presses a body that "
                  "gives way");
  return schema;
}

/// The material: elements, at rest or in motion, or springs.
void read_material(Table& table, DeformableObjectParameters& p) {
  table.describe({"model",
                  "What a body that gives way is made of: elements that rest on every tick, "
                  "springs that move, or elements that move by implicit steps",
                  "elements", false});
  const std::string model =
      table.has("model") ? table.choice("model", {"elements", "springs", "implicit"}) : "elements";
  if (model == "springs") {
    p.springs = read_springs(table);
  } else if (model == "implicit") {
    p.implicit = read_implicit(table);
    p.tissue = p.implicit->tissue;
  } else {
    p.tissue = tissue_schema().read(table);
    return;
  }
  table.describe({"rate",
                  "Motions of a body that moves a second, if it moves less often than it is felt",
                  "the loop's", false});
  p.rate = table.has("rate") ? table.number("rate", {0.0, 1e5, true}, "Hz") : 0.0;
}

}  // namespace

Field read_deformable(Table& table, std::string name, const deformable::SharedHapticMesh& mesh,
                      std::shared_ptr<const deformable::SpringConstants> calibrated) {
  Field field;
  field.name = std::move(name);
  read_limits(table, field);
  DeformableObjectParameters p;
  p.mesh = mesh;
  read_material(table, p);
  if (p.springs) {
    p.springs->calibrated = std::move(calibrated);
  }
  p.pose = read_pose(table);
  touch_schema().read(table, p.tool);
  p.tool.friction = read_contact_friction(table);
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
