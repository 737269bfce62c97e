#include "core/bone/simulator/bone_touch.h"

#include "core/bone/drill/feel.h"

namespace haptrial::bone {

BoneTouch::BoneTouch(const Simulator& simulator) {
  for (const ToolSpec& tool : simulator.tools()) {
    const auto* burr = tool.as<BurrTool>();
    const double spacing = simulator.world().volume(0).grid().spacing;
    drills_.push_back(burr != nullptr ? std::make_unique<Drill>(
                                            for_bone(burr->burr, spacing), simulator.structures(),
                                            best_instruction_set(), simulator.soft_tissue().soft())
                                      : nullptr);
  }
}

BoneTouch::Felt BoneTouch::tick(const Simulator& simulator, const ToolState& tool) noexcept {
  const int in_hand = simulator.output().tool;
  waits_until_free_ = waits_until_free_ || in_hand != tool_;
  tool_ = in_hand;
  const auto* burr = simulator.tool().as<BurrTool>();
  Felt felt;
  if (burr == nullptr) {
    return felt;
  }
  Drill& drill = *drills_[static_cast<std::size_t>(in_hand)];
  drill.begin_tick();
  Contact all;
  for (int piece = 0; piece < simulator.world().pieces(); ++piece) {
    const Eigen::Isometry3d& pose = simulator.world().pose(piece);
    const Eigen::Vector3d tip_B = pose.inverse(Eigen::Isometry) * tool.tip.position;
    const Eigen::Quaterniond turn(pose.linear());
    const Contact contact =
        drill.touch(simulator.world().volume(piece), tip_B, turn.conjugate() * tool.orientation);
    if (contact) {
      all = all ? together(all, in_world(contact, pose)) : in_world(contact, pose);
    }
  }
  felt.contact = static_cast<bool>(all);
  waits_until_free_ = waits_until_free_ && felt.contact;
  if (felt.contact && !waits_until_free_) {
    const double power = simulator.output().power;
    felt.force = bone_force(all, burr->feel, burr->burr, power);
    felt.drag = drag_force(all, burr->burr, power);
  }
  return felt;
}

}  // namespace haptrial::bone
