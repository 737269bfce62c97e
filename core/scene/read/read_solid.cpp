#include "core/scene/read/read_solid.h"

#include <fmt/format.h>

#include <numbers>
#include <utility>

#include "core/scene/read/field_reader_internal.h"

namespace haptrial::scene {
namespace {

constexpr double kSolidFade = 0.05;  // [s]

contact::ObjectPose read_pose(const FieldReader& read) {
  contact::ObjectPose pose;
  if (read.table.has("centre")) {
    pose.position = read.place("centre");
  }
  if (read.table.has("turn")) {
    const Eigen::Vector3d turn = read.vector("turn", {-7.0, 7.0}, "rad");
    const double angle = turn.norm();
    if (angle > 0.0) {
      pose.orientation = Eigen::AngleAxisd(angle, turn / angle);
    }
  }
  return pose;
}

contact::Friction read_contact_friction(const FieldReader& read) {
  if (!read.table.has("friction")) {
    return {};
  }
  Table table = read.table.table("friction");
  const FieldReader of{table, read.source};
  contact::Friction friction{of.number("static", {0.0, 10.0}, ""),
                             of.number("dynamic", {0.0, 10.0}, "")};
  if (friction.static_friction < friction.dynamic_friction) {
    table.reject("static", fmt::format("{}", friction.static_friction),
                 fmt::format("at least dynamic, {}", friction.dynamic_friction));
    friction.static_friction = friction.dynamic_friction;
  }
  return friction;
}

contact::RendererKind read_renderer(const FieldReader& read) {
  std::vector<std::string> words;
  for (const contact::RendererKind kind : contact::kRendererKinds) {
    words.emplace_back(contact::name_of(kind));
  }
  return contact::renderer_kind(read.table.choice("renderer", words));
}

/// A kind that has no tool radius or needs one.
void check_radius(const FieldReader& read, SolidParameters& p) {
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

}  // namespace

Field read_solid(Table& table, std::string name, const contact::SharedBody& body,
                 const NumberSource& source) {
  FieldReader read{table, source};
  Field field;
  field.name = std::move(name);
  field.limit = read.number_or(field.limit, "limit", {0.0, 100.0, true}, "N");
  field.fade_in = read.number_or(kSolidFade, "fade_in", kFadeBounds, "s");
  field.fade_out = read.number_or(kSolidFade, "fade_out", kFadeBounds, "s");
  SolidParameters p;
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
  check_radius(read, p);
  field.kind = std::move(p);
  return field;
}

}  // namespace haptrial::scene
