#include "core/bone/simulator/second_hand.h"

#include <stdexcept>

#include "core/bone/simulator/piece_contact.h"

namespace haptrial::bone {
namespace {

TubeParameters within_bounds(const TubeParameters& p) {
  if (!(p.radius >= 2e-4 && p.radius <= 0.01 && p.handle_length > 0.0 && p.rinse_reach > 0.0)) {
    throw std::invalid_argument("SecondHand: the tube's radius, length or reach is out of bounds");
  }
  check(p.feel);
  return p;
}

}  // namespace

SecondHand::SecondHand(const TubeParameters& parameters, std::span<const Structure> structures,
                       double spacing, const std::array<bool, 256>& soft)
    : p_(within_bounds(parameters)),
      end_(for_bone(default_burr(BurrKind::kDiamond, 2.0 * p_.outer_radius()), spacing)),
      drill_(end_, structures, best_instruction_set(), soft) {}

TubeOutput SecondHand::tick(const BoneWorld& world, SoftTissue& soft,
                            const TubeInput& input) noexcept {
  TubeOutput out;
  const Contact all = touch_pieces(drill_, world, input.tool);
  out.contact = static_cast<bool>(all);
  out.immersed = all.samples;
  waits_until_free_ = waits_until_free_ && out.contact;
  if (out.contact && !waits_until_free_) {
    out.force = bone_force(all, p_.feel, end_, 0.0);
  }
  if (!soft.empty()) {
    const Eigen::Isometry3d& pose = world.pose(0);
    const Eigen::Vector3d tip_B = pose.inverse(Eigen::Isometry) * input.tool.tip.position;
    const std::size_t before = soft.tears().size();
    const Eigen::Vector3d force = soft.tick_second(tip_B, p_.radius, input.sucks);
    out.yields = !force.isZero(0.0);
    out.tore = soft.tears().size() > before;
    out.force += pose.linear() * force;
  }
  return out;
}

void SecondHand::place(const TubeInput& input, DustTool& tube, DustWater& water) const noexcept {
  const Eigen::Vector3d& tip = input.tool.tip.position;
  tube = {tip, input.tool.axis(), p_.handle_length, p_.radius, input.sucks};
  water = {tip, input.rinses ? p_.rinse_reach : 0.0};
}

bool SecondHand::rinses(const TubeInput& input, const Eigen::Vector3d& p_W) const noexcept {
  return input.rinses && (p_W - input.tool.tip.position).norm() <= p_.rinse_reach;
}

}  // namespace haptrial::bone
