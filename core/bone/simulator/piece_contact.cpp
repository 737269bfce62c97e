#include "core/bone/simulator/piece_contact.h"

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

}  // namespace haptrial::bone
