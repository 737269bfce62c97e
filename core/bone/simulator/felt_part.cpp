#include "core/bone/simulator/felt_part.h"

#include <limits>

namespace haptrial::bone {
namespace {

FeelParameters allowed(const FeelParameters& feel) {
  check(feel);
  return feel;
}

}  // namespace

FeltPart::FeltPart(const BurrDimensions& dimensions, double middle, const FeelParameters& feel,
                   std::span<const Structure> structures, double spacing,
                   const std::array<bool, 256>& soft)
    : middle_(middle),
      feel_(allowed(feel)),
      before_(feel_),
      at_rest_(for_bone(default_burr(BurrKind::kDiamond, dimensions), spacing)),
      drill_(at_rest_, structures, best_instruction_set(), soft) {}

FeltPart::Felt FeltPart::tick(const BoneWorld& world, const ToolState& tool,
                              const ForceTransition& transition) noexcept {
  ToolState part = tool;
  if (middle_ != 0.0) {
    part.tip.position += middle_ * tool.axis();
  }
  const Contact contact = touch_pieces(drill_, world, part);
  waits_until_free_ = waits_until_free_ && static_cast<bool>(contact);
  Felt felt;
  felt.immersed = contact.samples;
  if (contact && !waits_until_free_) {
    felt.force = bone_force(contact, feel_, at_rest_, 0.0);
    if (transition.is_on()) {
      const double w = transition.weight();
      felt.force = (1.0 - w) * bone_force(contact, before_, at_rest_, 0.0) + w * felt.force;
    }
  }
  return felt;
}

Contact touch_pieces(Drill& drill, const BoneWorld& world, const ToolState& tool) noexcept {
  drill.begin_tick();
  Contact all;
  for (int piece = 0; piece < world.pieces(); ++piece) {
    const Eigen::Isometry3d& pose = world.pose(piece);
    const Eigen::Vector3d tip_B = pose.inverse(Eigen::Isometry) * tool.tip.position;
    const Eigen::Quaterniond turn(pose.linear());
    const Contact contact =
        drill.touch(world.volume(piece), tip_B, turn.conjugate() * tool.orientation);
    if (contact) {
      all = all ? together(all, in_world(contact, pose)) : in_world(contact, pose);
    }
  }
  return all;
}

BallAt deepest_ball(std::span<const BurrShape::Ball> balls, const ToolState& tool,
                    const Eigen::Isometry3d& pose, const SoftTissue& soft) noexcept {
  const Eigen::Isometry3d to_bone = pose.inverse(Eigen::Isometry);
  if (balls.size() == 1) {
    return {to_bone * tool.tip.position, balls.front().radius};
  }
  const Eigen::Vector3d axis = tool.axis();
  BallAt deepest;
  double most = -std::numeric_limits<double>::infinity();
  for (const BurrShape::Ball& ball : balls) {
    const BallAt at{to_bone * (tool.tip.position + ball.z * axis), ball.radius};
    const double depth = ball.radius - soft.distance(at.centre_B);
    if (depth > most || most == -std::numeric_limits<double>::infinity()) {
      most = depth;
      deepest = at;
    }
  }
  return deepest;
}

}  // namespace haptrial::bone
