#include "core/scene/read/read_solid.h"

#include <fmt/format.h>

#include <numbers>
#include <utility>

#include "core/scene/read/field_reader.h"
#include "core/scene/read/object_keys_internal.h"

namespace haptrial::scene {
namespace {

contact::RendererKind read_renderer(const FieldReader& read) {
  std::vector<std::string> words;
  for (const contact::RendererKind kind : contact::kRendererKinds) {
    words.emplace_back(contact::name_of(kind));
  }
  return contact::renderer_kind(read.table.choice("renderer", words));
}

/// A kind that has no tool radius or needs one.
void check_radius(const FieldReader& read, RigidObjectParameters& p) {
  using contact::RendererKind;
  if (p.renderer == RendererKind::kRuspini && !(p.tool_radius > 0.0)) {
    read.table.reject("renderer", "is \"ruspini\", a sphere's; add tool_radius");
    p.tool_radius = 0.001;
  } else if (p.renderer != RendererKind::kRuspini && p.renderer != RendererKind::kProxy &&
             p.tool_radius > 0.0) {
    read.table.reject("tool_radius", fmt::format("stands beside the renderer \"{}\", whose tool is "
                                                 "a point; leave it out",
                                                 contact::name_of(p.renderer)));
    p.tool_radius = 0.0;
  }
}

/// Keys of other renderers.
void check_others(const FieldReader& read, RigidObjectParameters& p) {
  using contact::RendererKind;
  const bool cells =
      p.renderer == RendererKind::kVoxel || p.renderer == RendererKind::kDistanceField;
  if (!cells && read.table.has("resolution")) {
    read.table.reject("resolution", fmt::format("stands beside the renderer \"{}\", which has no "
                                                "cells; leave it out",
                                                contact::name_of(p.renderer)));
  }
  const bool proxy = p.renderer == RendererKind::kProxy || p.renderer == RendererKind::kRuspini;
  if (!proxy && p.friction.static_friction > 0.0) {
    read.table.reject("friction", fmt::format("stands beside the renderer \"{}\", which has none; "
                                              "leave it out",
                                              contact::name_of(p.renderer)));
    p.friction = {};
  }
}

/// Renderers without a proxy ask a mesh how deep the tool is inside.
void check_inside(const FieldReader& read, RigidObjectParameters& p) {
  using contact::RendererKind;
  if (p.renderer != RendererKind::kProxy && p.renderer != RendererKind::kRuspini && p.body &&
      !p.body->closed) {
    read.table.reject("renderer",
                      fmt::format("is \"{}\", which needs a closed mesh, and this one is open; "
                                  "allowed: proxy, ruspini",
                                  contact::name_of(p.renderer)));
    p.renderer = RendererKind::kProxy;
  }
}

}  // namespace

Field read_solid(Table& table, std::string name, const contact::SharedBody& body,
                 const NumberSource& source) {
  FieldReader read{table, source};
  Field field;
  field.name = std::move(name);
  read_limits(read, field);
  RigidObjectParameters p;
  p.body = body;
  p.pose = read_pose(read);
  p.scale = read.number_or(p.scale, "scale", {0.0, 1000.0, true}, "");
  p.gains = {read.number("stiffness", {0.0, kStiffnessBounds.high, true}, "N/m"),
             read.number("damping", kDampingBounds, "N·s/m")};
  p.friction = read_contact_friction(read);
  p.tool_radius = read.number_or(p.tool_radius, "tool_radius", {0.0, 0.05}, "m");
  if (table.has("shading")) {
    p.crease_angle = read.number("shading", {0.0, 0.5 * std::numbers::pi}, "rad");
  }
  if (table.has("renderer")) {
    p.renderer = read_renderer(read);
  }
  p.resolution = table.integer_or("resolution", p.resolution, 4, 512);
  check_radius(read, p);
  check_others(read, p);
  check_inside(read, p);
  field.kind = std::move(p);
  return field;
}

}  // namespace haptrial::scene
