#include "core/bone/simulator/bone_touch.h"

#include "core/bone/drill/feel.h"
#include "core/bone/simulator/felt_part.h"

namespace haptrial::bone {

BoneTouch::BoneTouch(const Simulator& simulator)
    : shafts_(simulator.tools(), simulator.structures(), simulator.world().volume(0).grid().spacing,
              simulator.soft_tissue().soft()),
      soft_(simulator.soft_tissue().touch()) {
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
  if (in_hand != tool_) {
    waits_until_free_ = true;
    shafts_.wait();
    SoftTissue::forget(soft_);
  }
  tool_ = in_hand;
  Felt felt;
  if (const auto* burr = simulator.tool().as<BurrTool>()) {
    felt = touch_by_burr(simulator, *burr, tool);
    const Drill& drill = *drills_[static_cast<std::size_t>(tool_)];
    felt.force += touch_soft(simulator, drill.burr().shape().balls(), false, tool);
    felt.shaft = shafts_.force(tool_, simulator.world(), tool);
  } else if (const auto* tube = simulator.tool().as<SuctionTool>()) {
    const BurrShape::Ball end{0.0, tube->radius};
    felt.force = touch_soft(simulator, {&end, 1}, simulator.output().power > 0.0, tool);
  } else if (simulator.tool().as<PlateTool>() != nullptr) {
    felt = touch_by_plate(simulator, tool);
  }
  return felt;
}

bool BoneTouch::lets_feel(bool contact) noexcept {
  waits_until_free_ = waits_until_free_ && contact;
  return contact && !waits_until_free_;
}

BoneTouch::Felt BoneTouch::touch_by_burr(const Simulator& simulator, const BurrTool& burr,
                                         const ToolState& tool) noexcept {
  const Contact all =
      touch_pieces(*drills_[static_cast<std::size_t>(tool_)], simulator.world(), tool);
  Felt touched;
  touched.contact = static_cast<bool>(all);
  if (lets_feel(touched.contact)) {
    const double power = simulator.handpiece().turning(simulator.output().power);
    touched.force = bone_force(all, burr.feel, burr.burr, power);
    touched.drag = drag_force(all, burr.burr, power);
  }
  return touched;
}

BoneTouch::Felt BoneTouch::touch_by_plate(const Simulator& simulator,
                                          const ToolState& tool) noexcept {
  const PlateContact contact = press(*simulator.plate(tool_), pose_of(tool), simulator.world());
  Felt touched;
  touched.contact = contact.touching > 0;
  if (lets_feel(touched.contact)) {
    touched.force = contact.force;
  }
  return touched;
}

/// Soft tissue is part of the bone itself, not of pieces that come off it.
Eigen::Vector3d BoneTouch::touch_soft(const Simulator& simulator,
                                      std::span<const BurrShape::Ball> balls, bool sucks,
                                      const ToolState& tool) noexcept {
  if (simulator.soft_tissue().empty()) {
    return Eigen::Vector3d::Zero();
  }
  const Eigen::Isometry3d& pose = simulator.world().pose(0);
  const BallAt ball = deepest_ball(balls, tool, pose, simulator.soft_tissue());
  return pose.linear() * simulator.soft_tissue().feel(soft_, ball.centre_B, ball.radius, sucks);
}

}  // namespace haptrial::bone
