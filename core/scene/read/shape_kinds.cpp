#include "core/scene/read/shape_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/base/definition/table.h"
#include "core/scene/read/field_kinds_internal.h"

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

const Schema<SurfaceParameters>& surface_schema() {
  using P = SurfaceParameters;
  static const auto schema =
      Schema<P>()
          .choice("felt_from", &P::felt_from_inside, {{"outside", false}, {"inside", true}},
                  "Side from which a surface is felt")
          .only_if([](const P& p) { return !std::holds_alternative<HalfSpace>(p.shape); })
          .keys_of(&P::gains, field_gains_schema());
  return schema;
}

template <class T, const Schema<T>& (*schema)()>
Shape read_shape_by(Table& table) {
  return schema().read(table);
}

KindOfShape half_space_shape() {
  return {"half_space", read_shape_by<HalfSpace, half_space_schema>, "wall"};
}
KindOfShape sphere_shape() { return {"sphere", read_shape_by<Sphere, sphere_schema>}; }
KindOfShape box_shape() { return {"box", read_shape_by<Box, box_schema>}; }
KindOfShape cylinder_shape() { return {"cylinder", read_shape_by<Cylinder, cylinder_schema>}; }

std::vector<KindOfShape>& all_shapes() {
  static std::vector<KindOfShape> kinds{sphere_shape(), box_shape(), cylinder_shape(),
                                        half_space_shape()};
  return kinds;
}

/// The kind of field that is felt as a shape's surface.
KindOfField surface_field(const KindOfShape& shape) {
  const auto read = [read_shape = shape.read](Table& table, const FieldSetting&) -> FieldKind {
    SurfaceParameters p;
    p.shape = read_shape(table);
    surface_schema().read(table, p);
    return p;
  };
  return {shape.field_word(), read};
}

}  // namespace

KindOfField wall_field() { return surface_field(half_space_shape()); }

KindOfField box_field() { return surface_field(box_shape()); }

KindOfField sphere_field() { return surface_field(sphere_shape()); }

KindOfField cylinder_field() { return surface_field(cylinder_shape()); }

const std::vector<KindOfShape>& kinds_of_shape() { return all_shapes(); }

void add_kind_of_shape(const KindOfShape& kind) {
  const std::vector<KindOfShape>& kinds = all_shapes();
  if (std::ranges::find(kinds, kind.word, &KindOfShape::word) != kinds.end()) {
    throw std::invalid_argument(
        fmt::format("add_kind_of_shape: there is a shape '{}' already", kind.word));
  }
  add_kind_of_field(surface_field(kind));
  all_shapes().push_back(kind);
}

Region read_region(Table& table, std::string name) {
  table.describe({"type", "Shape of the region", "", true});
  std::vector<std::string> words;
  for (const KindOfShape& kind : kinds_of_shape()) {
    words.push_back(kind.word);
  }
  const std::string word = table.choice("type", words);
  if (table.whole_text("type") != word) {
    for (const std::string& key : table.keys()) {
      table.leave(key);
    }
    return {std::move(name), {}};
  }
  return {std::move(name),
          std::ranges::find(kinds_of_shape(), word, &KindOfShape::word)->read(table)};
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
