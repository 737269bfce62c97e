#include "protocols/psychophysics/presentation/stage_sight.h"

#include <algorithm>
#include <variant>

#include "protocols/psychophysics/definition/presented.h"

namespace haptrial::protocols {
namespace {

Mark mark_at(const Eigen::Vector3d& p, double radius) {
  const Eigen::Vector3f f = p.cast<float>();
  return {{f.x(), f.y(), f.z()}, static_cast<float>(radius)};
}

/// Place and size of a region.
Mark mark_of(const scene::Shape& shape) {
  const scene::ShapeBall ball = scene::ball_of(shape);
  return mark_at(ball.centre, ball.radius);
}

SeenObject seen_object(const contact::ObjectPose& pose, double scale, std::size_t object) {
  const Eigen::Vector3f p = pose.position.cast<float>();
  const Eigen::Quaternionf q = pose.orientation.cast<float>();
  return {{p.x(), p.y(), p.z()},
          {q.w(), q.x(), q.y(), q.z()},
          static_cast<float>(scale),
          static_cast<std::int32_t>(object)};
}

/// The objects among the fields come last, in the order of the definition's.
void show_object(const Presented& presented, const std::string& name, StageSight& sight) {
  std::size_t object = 0;
  for (const scene::Field& field : presented.fields) {
    if (const auto* solid = std::get_if<scene::RigidObjectParameters>(&field.kind);
        solid != nullptr && field.name == name) {
      sight.objects.push_back(seen_object(solid->pose, solid->scale, object));
    }
    if (const auto* body = std::get_if<scene::DeformableObjectParameters>(&field.kind);
        body != nullptr && field.name == name) {
      sight.objects.push_back(seen_object(body->pose, 1.0, object));
    }
    object += scene::traits_of(field).object ? 1 : 0;
  }
}

}  // namespace

Mark mark_to_touch(const scene::Shape& shape, std::size_t device) {
  Mark mark = mark_at(scene::place_inside(shape), scene::ball_of(shape).radius);
  mark.device = static_cast<std::uint8_t>(device);
  return mark;
}

StageSight sight_of(const NamedStage& stage, const Presented& presented, const Names& names,
                    std::uint64_t seed) {
  StageSight sight;
  sight.sound = stage.sound;
  for (const std::string& name : stage.show) {
    const auto region = std::ranges::find(presented.regions, name, &scene::Region::name);
    const auto target = std::ranges::find(presented.targets, name, &MovingTarget::name);
    const auto look = std::ranges::find(presented.looks, name, &Look::name);
    if (name == "hand") {
      sight.hand = true;
    } else if (name == "cursor") {
      sight.cursor = true;
    } else if (name == "interval_number") {
      sight.interval_number = true;
    } else if (region != presented.regions.end()) {
      sight.marks.push_back(mark_of(region->shape));
      const auto index = static_cast<std::size_t>(region - presented.regions.begin());
      sight.marks.back().device = static_cast<std::uint8_t>(presented.region_devices[index]);
    } else if (target != presented.targets.end()) {
      sight.marks.push_back(mark_at(target->at(0.0), target->radius));
      sight.marks.back().target = static_cast<std::int8_t>(target - presented.targets.begin());
    } else if (look != presented.looks.end()) {
      sight.dots = {look->dots, seed, true};
    } else if (names.has_place(name)) {
      sight.marks.push_back(mark_at(names.place(name), 0.0));
    } else {
      show_object(presented, name, sight);
    }
  }
  return sight;
}

}  // namespace haptrial::protocols
