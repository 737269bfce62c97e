#include "core/bone/simulator/second_hand.h"

#include <stdexcept>

#include "core/bone/simulator/simulator_tools.h"

namespace haptrial::bone {
namespace {

TubeParameters within_bounds(const TubeParameters& p) {
  if (!(p.radius >= 2e-4 && p.radius <= 0.01 && p.handle_length > 0.0 && p.rinse_reach > 0.0 &&
        p.shaft_length >= 0.0)) {
    throw std::invalid_argument("SecondHand: the tube's radius, length or reach is out of bounds");
  }
  return p;
}

}  // namespace

SecondHand::SecondHand(const TubeParameters& parameters, std::span<const Structure> structures,
                       double spacing, const std::array<bool, 256>& soft)
    : p_(within_bounds(parameters)),
      end_({BurrForm::kBall, 2.0 * p_.outer_radius(), 0.0, 0.0}, 0.0, p_.feel, structures, spacing,
           soft),
      at_tool_(p_.at_tool) {
  if (p_.shaft_length > 0.0) {
    const ShaftParameters shaft = default_shaft(p_.outer_radius(), p_.shaft_length);
    shaft_ = std::make_unique<FeltPart>(shaft.dimensions(), p_.outer_radius() + 0.5 * shaft.length,
                                        shaft.feel, structures, spacing, soft);
  }
}

void SecondHand::begin() noexcept {
  end_.wait();
  leave_tool();
  if (shaft_ != nullptr) {
    shaft_->wait();
  }
}

TubeOutput SecondHand::tick(const BoneWorld& world, SoftTissue& soft, const TubeInput& input,
                            const ForceTransition& transition) noexcept {
  TubeOutput out;
  const FeltPart::Felt end = end_.tick(world, input.tool, transition);
  out.force = end.force;
  out.immersed = end.immersed;
  out.contact = end.immersed > 0;
  if (shaft_ != nullptr) {
    out.shaft = shaft_->tick(world, input.tool).force;
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

Eigen::Vector3d SecondHand::push(std::span<const Rod> tool, const Eigen::Vector3d& velocity,
                                 const TubeInput& input, double dt) noexcept {
  if (!at_tool_.on()) {
    return Eigen::Vector3d::Zero();
  }
  const PointState& tip = input.tool.tip;
  const Rod tube{tip.position, tip.position + p_.handle_length * input.tool.axis(),
                 p_.outer_radius()};
  return at_tool_.force(tool, tube, tip.velocity - velocity, dt);
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
