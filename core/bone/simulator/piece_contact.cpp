#include "core/bone/simulator/piece_contact.h"

#include <limits>

namespace haptrial::bone {

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
