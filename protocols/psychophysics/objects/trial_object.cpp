#include "protocols/psychophysics/objects/trial_object.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/fnv.h"
#include "core/deformable/springs/constants_table.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/procedural.h"

namespace haptrial::protocols {
namespace {

constexpr Bounds kSide{0.0, 1.0, true};  // [m]
constexpr int kSphereFrequency = 32;     // 20,480 triangles: 3 µm off at a radius of 25 mm
constexpr int kAround = 256;             // 2 µm off at a radius of 25 mm
constexpr int kAcross = 96;              // of a torus's tube

double read_side(Table& table, const char* key, const char* description) {
  table.describe({key, description, "", true});
  return table.number(key, kSide, "m");
}

double read_radius(Table& table) {
  return read_side(table, "radius",
                   "Radius of the object's body; of a torus that of the circle in its middle");
}

Eigen::Vector3d read_size(Table& table) {
  table.describe({"size", "Lengths of the object's body along x, y and z", "", true});
  return read_vector(table, "size", kSide, "m", Eigen::Vector3d::Constant(0.01));
}

geometry::Mesh read_frustum(Table& table, double share_at_top) {
  const double radius = read_radius(table);
  const double length =
      read_side(table, "length", "Length of the object's body along z; a cone points to +z");
  return geometry::make_frustum(radius, share_at_top * radius, length, kAround);
}

geometry::Mesh read_ellipsoid(Table& table) {
  geometry::Mesh mesh = geometry::make_sphere(0.5, kSphereFrequency);
  const Eigen::Vector3d size = read_size(table);
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = vertex.cwiseProduct(size).eval();
  }
  return mesh;
}

geometry::Mesh read_torus(Table& table) {
  const double radius = read_radius(table);
  double tube = read_side(table, "tube", "Radius of the tube of a torus, which lies around z");
  if (tube >= radius) {
    table.reject("tube", fmt::format("{} m", tube),
                 fmt::format("a number below radius, {} m", radius));
    tube = 0.5 * radius;
  }
  return geometry::make_torus(radius, tube, kAround, kAcross);
}

struct KindOfShape {
  const char* word;
  geometry::Mesh (*read)(Table&);
};

constexpr KindOfShape kShapes[] = {
    {"sphere", [](Table& t) { return geometry::make_sphere(read_radius(t), kSphereFrequency); }},
    {"ellipsoid", read_ellipsoid},
    {"box", [](Table& t) { return geometry::make_box(read_size(t)); }},
    {"cylinder", [](Table& t) { return read_frustum(t, 1.0); }},
    {"cone", [](Table& t) { return read_frustum(t, 0.0); }},
    {"torus", read_torus},
};

contact::SharedBody read_shape(Table& table) {
  std::vector<std::string> words;
  for (const KindOfShape& shape : kShapes) {
    words.emplace_back(shape.word);
  }
  const std::string word = table.choice("shape", words);
  if (table.whole_text("shape") != word) {
    for (const std::string& key : table.keys()) {
      table.leave(key);
    }
    return nullptr;
  }
  for (const KindOfShape& shape : kShapes) {
    if (word == shape.word) {
      return contact::felt_body(shape.read(table));
    }
  }
  return nullptr;
}

std::vector<deformable::BodySide> read_sides(Table& table, const std::string& key) {
  constexpr std::array kSides{deformable::BodySide::kLeft,   deformable::BodySide::kRight,
                              deformable::BodySide::kBottom, deformable::BodySide::kTop,
                              deformable::BodySide::kBack,   deformable::BodySide::kFront};
  std::vector<deformable::BodySide> sides;
  for (const std::string& word : table.texts(key)) {
    const auto found = std::ranges::find(kSides, word, [](auto side) { return name_of(side); });
    if (found == kSides.end()) {
      table.reject(key, fmt::format("\"{}\"", word), "left, right, bottom, top, back, front");
    } else {
      sides.push_back(*found);
    }
  }
  return sides;
}

using Sides = std::vector<deformable::BodySide> deformable::FeltSides::*;

/// Reader of a key that lists sides of the body.
auto sides_reader(Sides sides) {
  return [sides](Table& table, const std::string& key, TrialObject& object) {
    object.sides.*sides = read_sides(table, key);
  };
}

/// The keys of a body that gives way, but those of its shape and those that read_deformable()
/// describes.
const Schema<TrialObject>& deformable_schema() {
  using T = TrialObject;
  using F = deformable::FeltSides;
  static const auto schema =
      Schema<T>()
          .integer("cells", &T::cells, 2, deformable::kMostFeltCells,
                   "Cells along the longest side of a body that gives way")
          .custom("fixed",
                  "Sides of a body that gives way which do not move: left, right, bottom, top, "
                  "back, front (-x, +x, -y, +y, -z, +z)",
                  sides_reader(&F::fixed))
          .otherwise("bottom")
          .custom("felt", "Sides of a body that gives way which can be touched",
                  sides_reader(&F::felt))
          .otherwise("all that are not fixed")
          .custom("grasped",
                  "Sides of a body that moves which the hand holds from the first tick on and "
                  "moves, instead of pressing "
                  "the body",
                  [](Table& table, const std::string& key, T& object) {
                    sides_reader (&F::grasped)(table, key, object);
                    if (!object.moves) {
                      table.reject(
                          key,
                          "stands without model = \"springs\" or \"implicit\", which it needs");
                    }
                  })
          .otherwise("none")
          .choice("seen", &T::seen_yielding, {{"yielding", true}, {"rest", false}},
                  "Shape at which a body that gives way is seen: as the hand presses it, or at "
                  "rest");
  return schema;
}

/// The keys of a body that gives way; its block, unless it is a file.
void read_deformable_shape(Table& table, TrialObject& object) {
  const std::string model =
      table.has("model") ? table.choice("model", {"elements", "springs", "implicit"}) : "elements";
  object.moves = model != "elements";
  object.own_rate = object.moves && table.has("rate");
  if (model == "springs" && table.has("calibrated")) {
    object.constants_file = table.text("calibrated");
  }
  deformable_schema().read(table, object);
  if (table.has("mesh")) {
    object.file = table.text("mesh");
    return;
  }
  table.choice("shape", {"box"});
  const Eigen::Vector3d size = read_size(table);
  try {
    object.felt = std::make_shared<const deformable::HapticMesh>(
        deformable::felt_block(size, object.cells, object.sides, "objects." + object.name));
    object.body = contact::felt_body(geometry::make_box(size));
  } catch (const InputError& error) {
    table.reject("size", fmt::format("cannot be used: {}", error.what()));
  }
}

void read_body(Table& table, TrialObject& object) {
  table.describe({"shape", "Shape of the object's body", "needed, or mesh", false});
  table.describe({"mesh", "File of the object's mesh beside the definition: .obj, .ply or .stl",
                  "needed, or shape", false});
  if (object.yields) {
    read_deformable_shape(table, object);
  } else if (table.has("mesh") && table.has("shape")) {
    table.reject("shape", "stands beside mesh; keep one of the two");
    for (const char* key : {"shape", "mesh", "radius", "size", "length", "tube"}) {
      table.leave(key);
    }
  } else if (table.has("mesh")) {
    object.file = table.text("mesh");
  } else {
    object.body = read_shape(table);
  }
}

const Schema<TrialObject>& object_schema() {
  using T = TrialObject;
  static const auto schema =
      Schema<T>()
          .choice("kind", &T::yields, {{"rigid", false}, {"deformable", true}},
                  "Kind of the object: whether its body gives way to the hand")
          .check(read_body)
          .flag("record", &T::recorded,
                "Whether every tick of contact with the object is a row of /contacts");
  return schema;
}

}  // namespace

std::vector<TrialObject> read_objects(Table& objects) {
  std::vector<TrialObject> found;
  for (const std::string& name : objects.keys()) {
    Table table = objects.table(name);
    TrialObject object;
    object.name = name;
    object_schema().read(table, object);
    found.push_back(std::move(object));
  }
  return found;
}

namespace {

void load_mesh(TrialObject& object, const std::filesystem::path& file) {
  const std::string bytes = file_text(file);
  object.body =
      contact::felt_body(geometry::parse_mesh(bytes, geometry::mesh_format(file), file.string()));
  if (object.body->facing == geometry::Facing::kMixed) {
    throw InputError(fmt::format(
        "{}: faces of some of its parts look inwards and of others outwards, so that free space "
        "would push the hand; haptrial mesh repair turns them",
        file.string()));
  }
  object.file_bytes = bytes.size();
  object.file_checksum = fnv1a(bytes);
  if (object.yields) {
    object.felt = std::make_shared<const deformable::HapticMesh>(deformable::felt_solid(
        object.body->mesh, object.cells, object.sides, "objects." + object.name));
  }
}

void load_constants(TrialObject& object, const std::filesystem::path& file) {
  const std::string bytes = file_text(file);
  const deformable::SpringBody any = deformable::spring_body(object.felt->tets, 1.0, {});
  object.constants = std::make_shared<const deformable::SpringConstants>(
      deformable::parse_constants(bytes, file.string(), any));
  object.constants_bytes = bytes.size();
  object.constants_checksum = fnv1a(bytes);
}

}  // namespace

void load_objects(std::vector<TrialObject>& objects, const std::filesystem::path& folder) {
  const auto found = [&](const std::filesystem::path& file) {
    return file.is_relative() ? folder / file : file;
  };
  for (TrialObject& object : objects) {
    try {
      if (!object.file.empty()) {
        load_mesh(object, found(object.file));
      }
      if (!object.constants_file.empty() && object.felt) {
        load_constants(object, found(object.constants_file));
      }
    } catch (const InputError& error) {
      throw InputError(fmt::format("objects.{}: {}", object.name, error.what()));
    }
  }
}

}  // namespace haptrial::protocols
