#include "protocols/psychophysics/objects/trial_object.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "core/base/definition/table.h"
#include "core/base/definition/table_vector.h"
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

double side(Table& table, const char* key) { return table.number(key, kSide, "m"); }

Eigen::Vector3d sides(Table& table) {
  return read_vector(table, "size", kSide, "m", Eigen::Vector3d::Constant(0.01));
}

geometry::Mesh read_ellipsoid(Table& table) {
  geometry::Mesh mesh = geometry::make_sphere(0.5, kSphereFrequency);
  const Eigen::Vector3d size = sides(table);
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = vertex.cwiseProduct(size).eval();
  }
  return mesh;
}

geometry::Mesh read_torus(Table& table) {
  const double radius = side(table, "radius");
  double tube = side(table, "tube");
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
    {"sphere", [](Table& t) { return geometry::make_sphere(side(t, "radius"), kSphereFrequency); }},
    {"ellipsoid", read_ellipsoid},
    {"box", [](Table& t) { return geometry::make_box(sides(t)); }},
    {"cylinder",
     [](Table& t) {
       const double radius = side(t, "radius");
       return geometry::make_frustum(radius, radius, side(t, "length"), kAround);
     }},
    {"cone",
     [](Table& t) {
       const double radius = side(t, "radius");
       return geometry::make_frustum(radius, 0.0, side(t, "length"), kAround);
     }},
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

std::vector<deformable::BodySide> read_sides(Table& table, const char* key) {
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

/// The keys of a body that gives way; its block, unless it is a file.
void read_deformable_shape(Table& table, TrialObject& object) {
  object.yields = true;
  object.moves = table.has("model") && table.choice("model", {"elements", "springs"}) == "springs";
  object.own_rate = object.moves && table.has("rate");
  if (object.moves && table.has("calibrated")) {
    object.constants_file = table.text("calibrated");
  }
  object.cells = table.integer_or("cells", object.cells, 2, deformable::kMostFeltCells);
  if (table.has("fixed")) {
    object.sides.fixed = read_sides(table, "fixed");
  }
  if (table.has("felt")) {
    object.sides.felt = read_sides(table, "felt");
  }
  if (table.has("grasped")) {
    object.sides.grasped = read_sides(table, "grasped");
    if (!object.moves) {
      table.reject("grasped", "stands without model = \"springs\", which it needs");
    }
  }
  if (table.has("seen")) {
    object.seen_yielding = table.choice("seen", {"yielding", "rest"}) != "rest";
  }
  if (table.has("mesh")) {
    object.file = table.text("mesh");
    return;
  }
  table.choice("shape", {"box"});
  const Eigen::Vector3d size = sides(table);
  try {
    object.felt = std::make_shared<const deformable::HapticMesh>(
        deformable::felt_block(size, object.cells, object.sides, "objects." + object.name));
    object.body = contact::felt_body(geometry::make_box(size));
  } catch (const InputError& error) {
    table.reject("size", fmt::format("cannot be used: {}", error.what()));
  }
}

}  // namespace

std::vector<TrialObject> read_objects(Table& objects) {
  std::vector<TrialObject> found;
  for (const std::string& name : objects.keys()) {
    Table table = objects.table(name);
    TrialObject object;
    object.name = name;
    if (table.has("kind") && table.choice("kind", {"rigid", "deformable"}) == "deformable") {
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
    object.recorded = table.has("record") && table.boolean("record");
    found.push_back(std::move(object));
  }
  return found;
}

namespace {

void load_mesh(TrialObject& object, const std::filesystem::path& file) {
  const std::string bytes = file_text(file);
  object.body =
      contact::felt_body(geometry::parse_mesh(bytes, geometry::mesh_format(file), file.string()));
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
