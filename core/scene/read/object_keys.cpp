#include <fmt/format.h>

#include "core/scene/read/object_keys_internal.h"

namespace haptrial::scene {
namespace {

constexpr double kObjectFade = 0.05;  // [s]

}  // namespace

void read_limits(const FieldReader& read, Field& field) {
  field.limit = read.number_or(field.limit, "limit", {0.0, 100.0, true}, "N");
  field.fade_in = read.number_or(kObjectFade, "fade_in", kFadeBounds, "s");
  field.fade_out = read.number_or(kObjectFade, "fade_out", kFadeBounds, "s");
}

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

}  // namespace haptrial::scene
