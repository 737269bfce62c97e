#include <fmt/format.h>

#include "core/scene/read/object_keys_internal.h"

namespace haptrial::scene {
namespace {

constexpr double kObjectFade = 0.05;  // [s]

const Schema<contact::ObjectPose>& pose_schema() {
  using P = contact::ObjectPose;
  static const auto schema =
      Schema<P>()
          .vector("centre", &P::position, kPlaceBounds, "m",
                  "Place of the origin of the object's body in the world")
          .otherwise("0, 0, 0")
          .custom("turn",
                  "Rotation of the object's body: about the vector's direction by its length",
                  [](Table& table, const std::string& key, P& pose) {
                    const Eigen::Vector3d turn = read_vector(table, key, {-7.0, 7.0}, "rad");
                    if (turn.norm() > 0.0) {
                      pose.orientation = Eigen::AngleAxisd(turn.norm(), turn.normalized());
                    }
                  })
          .otherwise("not turned");
  return schema;
}

const Schema<contact::Friction>& contact_friction_schema() {
  using F = contact::Friction;
  static const auto schema =
      Schema<F>()
          .number("static", &F::static_friction, {0.0, 10.0}, "",
                  "Coefficient of the friction that holds a tool that rests on the object")
          .required()
          .number("dynamic", &F::dynamic_friction, {0.0, 10.0}, "",
                  "Coefficient of the friction that resists a tool that slides on the object")
          .required()
          .check([](Table& table, F& friction) {
            if (friction.static_friction < friction.dynamic_friction) {
              table.reject("static", fmt::format("{}", friction.static_friction),
                           fmt::format("at least dynamic, {}", friction.dynamic_friction));
              friction.static_friction = friction.dynamic_friction;
            }
          });
  return schema;
}

}  // namespace

void read_limits(Table& table, Field& field) {
  field.fade_in = field.fade_out = kObjectFade;
  field_limit_schema().read(table, field);
  field_fade_schema().read(table, field);
}

contact::ObjectPose read_pose(Table& table) { return pose_schema().read(table); }

contact::Friction read_contact_friction(Table& table) {
  if (!table.has("friction")) {
    return {};
  }
  Table inner = table.table("friction");
  return contact_friction_schema().read(inner);
}

}  // namespace haptrial::scene
