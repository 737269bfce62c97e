#include "core/subject/drilling/assisting_hand.h"

#include "core/subject/drilling/drilling_arm.h"

namespace haptrial::subject {
namespace {

constexpr double kArmLimit = 3.0;  // of the arm [N]

}  // namespace

void AssistingHand::observe(const stimulus::Shown& shown, const stimulus::Forces& /*forces*/,
                            double dt) noexcept {
  const auto* seen = shown.as<bone::DrillingView>();
  if (seen == nullptr || !seen->shown || !seen->tube.shown) {
    hand_.command({});
    device_.hold(0, 0.0, Eigen::Quaterniond::Identity());
    known_ = false;
    return;
  }
  const Eigen::Vector3d tip = scale_ * seen->tube.tip;
  const Eigen::Vector3d velocity =
      known_ ? Eigen::Vector3d((tip - last_) / dt) : Eigen::Vector3d::Zero();
  last_ = tip;
  known_ = true;
  const Eigen::Vector3d goal = scale_ * seen->tip + p_.beside;
  HandCommand command;
  command.force = kStiffness * (goal - tip) - kDamping * velocity;
  const double strength = command.force.norm();
  command.force *= strength > kArmLimit ? kArmLimit / strength : 1.0;
  hand_.command(command);
  const std::uint32_t rinsing = seen->power ? held(p_.rinse_button) : 0U;
  device_.hold(held(p_.suck_button) | rinsing, 0.0, Eigen::Quaterniond::Identity());
}

}  // namespace haptrial::subject
