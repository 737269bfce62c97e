#include "core/device/energy_watch.h"

#include <algorithm>

namespace haptrial::device {
namespace {

constexpr double kAllowed = 0.15;    // [J]
constexpr double kForgotten = 0.15;  // [W]

}  // namespace

bool EnergyWatch::look(const Eigen::Vector3d& force, const Eigen::Vector3d& moved,
                       const ForceIntent& intent, double dt) noexcept {
  work_ += (force - intent.push).dot(moved - dt * intent.drive) - intent.added;
  given_ = work_ + intent.stored;
  lowest_ = begun_ ? std::min(given_, lowest_ + kForgotten * dt) : given_;
  begun_ = true;
  return generated() > kAllowed;
}

}  // namespace haptrial::device
