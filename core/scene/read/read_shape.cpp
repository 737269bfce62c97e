#include "core/scene/read/read_shape.h"

#include "core/scene/read/field_reader.h"

namespace haptrial::scene {
namespace {

Sphere read_sphere(const FieldReader& read) {
  return {read.place("centre"), read.number("radius", kLengthBounds, "m")};
}

Box read_box(const FieldReader& read) {
  Box box;
  box.centre = read.place("centre");
  box.size = read.vector("size", kLengthBounds, "m");
  if (read.table.has("turn")) {
    box.turn = read.vector("turn", {-7.0, 7.0}, "rad");
  }
  return box;
}

Cylinder read_cylinder(const FieldReader& read) {
  Cylinder bar;
  bar.centre = read.place("centre");
  bar.axis = read.direction("axis");
  bar.radius = read.number("radius", kLengthBounds, "m");
  bar.length = read.number_or(bar.length, "length", kLengthBounds, "m");
  return bar;
}

}  // namespace

Shape read_shape(Table& table, const std::string& kind, const NumberSource& source) {
  const FieldReader read{table, source};
  if (kind == "sphere") {
    return read_sphere(read);
  }
  if (kind == "box") {
    return read_box(read);
  }
  if (kind == "cylinder") {
    return read_cylinder(read);
  }
  return HalfSpace{read.place("point"), read.direction("normal")};
}

Region read_region(Table& table, std::string name, const NumberSource& source) {
  const std::string kind = table.choice("type", {"sphere", "box", "cylinder", "half_space"});
  if (table.whole_text("type") != kind) {
    for (const std::string& key : table.keys()) {
      table.leave(key);
    }
    return {std::move(name), {}};
  }
  return {std::move(name), read_shape(table, kind, source)};
}

std::vector<Region> read_regions(Table& regions, const NumberSource& source) {
  std::vector<Region> found;
  for (const std::string& name : regions.keys()) {
    Table table = regions.table(name);
    found.push_back(read_region(table, name, source));
  }
  return found;
}

}  // namespace haptrial::scene
