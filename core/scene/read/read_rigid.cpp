#include "core/scene/read/read_rigid.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <numbers>
#include <utility>

#include "core/contact/renderer_kinds.h"
#include "core/scene/read/object_keys_internal.h"

namespace haptrial::scene {
namespace {

/// The words of the kinds, or of those that an open mesh allows.
std::vector<std::string> renderers(bool open_mesh) {
  std::vector<std::string> words;
  for (const contact::KindOfRenderer& kind : contact::kinds_of_renderer()) {
    if (kind.open_meshes || !open_mesh) {
      words.push_back(kind.word);
    }
  }
  return words;
}

void read_renderer(Table& table, const std::string& key, RigidObjectParameters& p) {
  p.renderer = contact::renderer_kind(table.choice(key, renderers(false)));
}

const Schema<control::PdGains>& object_gains_schema() {
  using G = control::PdGains;
  static const auto schema =
      Schema<G>()
          .number("stiffness", &G::stiffness, {0.0, kStiffnessBounds.high, true}, "N/m",
                  "Stiffness of the object's surface")
          .required()
          .number("damping", &G::damping, kDampingBounds, "N·s/m",
                  "Damping of the object's surface")
          .required();
  return schema;
}

const Schema<RigidObjectParameters>& rigid_schema() {
  using P = RigidObjectParameters;
  static const auto schema =
      Schema<P>()
          .number("scale", &P::scale, {0.0, 1000.0, true}, "",
                  "Size of the object, as a multiple of its body's")
          .keys_of(&P::gains, object_gains_schema())
          .check([](Table& table, P& p) { p.friction = read_contact_friction(table); })
          .number("tool_radius", &P::tool_radius, {0.0, 0.05}, "m",
                  "Radius of the ball that stands for the hand; 0: a point")
          .number("shading", &P::crease_angle, {0.0, 0.5 * std::numbers::pi}, "rad",
                  "Angle below which edges of a rigid object feel round")
          .otherwise("none")
          .custom("renderer", "Method that renders the contact", read_renderer)
          .otherwise(std::string(contact::name_of(P{}.renderer)))
          .integer("resolution", &P::resolution, 4, 512,
                   "Cells along the longest side, of the renderers voxel and distance field");
  return schema;
}

/// A kind that has no tool radius or needs one.
void check_radius(Table& table, RigidObjectParameters& p) {
  using Tool = contact::KindOfRenderer::Tool;
  const contact::KindOfRenderer& kind = contact::kind_of(p.renderer);
  if (kind.tool == Tool::kBall && !(p.tool_radius > 0.0)) {
    table.reject("renderer", fmt::format("is \"{}\", a sphere's; add tool_radius", kind.word));
    p.tool_radius = 0.001;
  } else if (kind.tool == Tool::kPoint && p.tool_radius > 0.0) {
    table.reject("tool_radius", fmt::format("stands beside the renderer \"{}\", whose tool is "
                                            "a point; leave it out",
                                            kind.word));
    p.tool_radius = 0.0;
  }
}

/// Keys of other renderers.
void check_others(Table& table, RigidObjectParameters& p) {
  const contact::KindOfRenderer& kind = contact::kind_of(p.renderer);
  if (!kind.cells && table.has("resolution")) {
    table.reject("resolution", fmt::format("stands beside the renderer \"{}\", which has no "
                                           "cells; leave it out",
                                           kind.word));
  }
  if (!kind.friction && p.friction.static_friction > 0.0) {
    table.reject("friction", fmt::format("stands beside the renderer \"{}\", which has none; "
                                         "leave it out",
                                         kind.word));
    p.friction = {};
  }
}

/// Renderers without a proxy ask a mesh how deep the tool is inside.
void check_inside(Table& table, RigidObjectParameters& p) {
  const contact::KindOfRenderer& kind = contact::kind_of(p.renderer);
  if (!kind.open_meshes && p.body && !p.body->closed) {
    table.reject("renderer",
                 fmt::format("is \"{}\", which needs a closed mesh, and this one is open; "
                             "allowed: {}",
                             kind.word, fmt::join(renderers(true), ", ")));
    p.renderer = contact::RendererKind::kProxy;
  }
}

}  // namespace

Field read_rigid(Table& table, std::string name, const contact::SharedBody& body) {
  Field field;
  field.name = std::move(name);
  read_limits(table, field);
  RigidObjectParameters p;
  p.body = body;
  p.pose = read_pose(table);
  rigid_schema().read(table, p);
  check_radius(table, p);
  check_others(table, p);
  check_inside(table, p);
  field.kind = std::move(p);
  return field;
}

}  // namespace haptrial::scene
