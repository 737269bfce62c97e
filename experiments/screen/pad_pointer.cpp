#include "experiments/screen/pad_pointer.h"

#include <algorithm>

namespace haptrial::experiments {
namespace {

constexpr double kSpeed = 0.35;   // of a stick that is pushed all the way, in heights [1/s]
constexpr double kWheel = 13.0;   // of a trigger that is down: 8 mm/s in a drilling [steps/s]
constexpr double kLongest = 0.1;  // a picture that took longer moves nothing further [s]

}  // namespace

PadPointer::PadPointer(int width, int height) : size_(width, height) {
  pointer_.position = 0.5 * size_;
}

render::Pointer PadPointer::moved(const device::GamepadState& pad, double dt) {
  const double time = std::min(dt, kLongest);
  // A stick pushed half the way moves a quarter as fast, so that fine work is possible.
  const double fast = kSpeed * size_.y() * pad.move.norm() * time;
  pointer_.position += fast * Eigen::Vector2d(pad.move.x(), -pad.move.y());
  pointer_.position = pointer_.position.cwiseMax(0.0).cwiseMin(size_);
  pointer_.wheel += kWheel * pad.depth * time;
  pointer_.buttons = pad.buttons;
  return pointer_;
}

}  // namespace haptrial::experiments
