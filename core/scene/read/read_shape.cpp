#include "core/scene/read/read_shape.h"

#include "core/base/definition/schema.h"
#include "core/scene/read/field_bounds.h"

namespace haptrial::scene {
namespace {

constexpr const char* kCentre = "Centre of the shape";
constexpr const char* kRadius = "Radius of the shape";

const Schema<Sphere>& sphere_schema() {
  static const auto schema = Schema<Sphere>()
                                 .vector("centre", &Sphere::centre, kPlaceBounds, "m", kCentre)
                                 .required()
                                 .number("radius", &Sphere::radius, kLengthBounds, "m", kRadius)
                                 .required();
  return schema;
}

const Schema<Box>& box_schema() {
  static const auto schema =
      Schema<Box>()
          .vector("centre", &Box::centre, kPlaceBounds, "m", kCentre)
          .required()
          .vector("size", &Box::size, kLengthBounds, "m", "Lengths of a box's edges")
          .required()
          .vector("turn", &Box::turn, {-7.0, 7.0}, "rad",
                  "Rotation of a box: about the vector's direction by its length")
          .otherwise("not turned");
  return schema;
}

const Schema<Cylinder>& cylinder_schema() {
  static const auto schema =
      Schema<Cylinder>()
          .vector("centre", &Cylinder::centre, kPlaceBounds, "m", kCentre)
          .required()
          .any_direction("axis", &Cylinder::axis, "Direction of a cylinder's axis")
          .required()
          .number("radius", &Cylinder::radius, kLengthBounds, "m", kRadius)
          .required()
          .number("length", &Cylinder::length, kLengthBounds, "m", "Length of a cylinder");
  return schema;
}

const Schema<HalfSpace>& half_space_schema() {
  static const auto schema = Schema<HalfSpace>()
                                 .vector("point", &HalfSpace::point, kPlaceBounds, "m",
                                         "Point on the surface of a wall or half space")
                                 .required()
                                 .any_direction("normal", &HalfSpace::normal, kNormal)
                                 .required();
  return schema;
}

}  // namespace

Shape read_shape(Table& table, const std::string& kind) {
  if (kind == "sphere") {
    return sphere_schema().read(table);
  }
  if (kind == "box") {
    return box_schema().read(table);
  }
  if (kind == "cylinder") {
    return cylinder_schema().read(table);
  }
  return half_space_schema().read(table);
}

Region read_region(Table& table, std::string name) {
  table.describe({"type", "Shape of the region", "", true});
  const std::string kind = table.choice("type", {"sphere", "box", "cylinder", "half_space"});
  if (table.whole_text("type") != kind) {
    for (const std::string& key : table.keys()) {
      table.leave(key);
    }
    return {std::move(name), {}};
  }
  return {std::move(name), read_shape(table, kind)};
}

std::vector<Region> read_regions(Table& regions) {
  std::vector<Region> found;
  for (const std::string& name : regions.keys()) {
    Table table = regions.table(name);
    found.push_back(read_region(table, name));
  }
  return found;
}

}  // namespace haptrial::scene
