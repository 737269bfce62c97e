#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <functional>
#include <limits>

#include "tests/support/pressing_hand.h"

namespace haptrial::test {

/// The force of a bone on a tool at a place [N].
using BoneForce = std::function<Eigen::Vector3d(const Eigen::Vector3d& tip)>;

/// How much a pressed tool still moves after it had time to settle.
struct Restlessness {
  double way{0.0};                                // from end to end, along the axis with most [m]
  double force{0.0};                              // from least to greatest length [N]
  Eigen::Vector3d mean{Eigen::Vector3d::Zero()};  // where it is [m]
};

/// Presses a tool for `seconds` at 1 kHz, and watches the last half second.
inline Restlessness press(const BoneForce& bone, const Eigen::Vector3d& start,
                          const PressingHand::Options& hand_options, double seconds = 3.0) {
  constexpr double kTick = 1e-3;
  const int ticks = static_cast<int>(seconds / kTick);
  PressingHand hand(start, hand_options);
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  double weakest = std::numeric_limits<double>::infinity();
  double strongest = 0.0;
  Restlessness rest;
  for (int n = 0; n < ticks; ++n) {
    const Eigen::Vector3d force = bone(hand.position());
    if (n >= ticks - 500) {
      low = low.cwiseMin(hand.position());
      high = high.cwiseMax(hand.position());
      weakest = std::min(weakest, force.norm());
      strongest = std::max(strongest, force.norm());
      rest.mean += hand.position() / 500.0;
    }
    hand.step(force, kTick);
  }
  rest.way = (high - low).maxCoeff();
  rest.force = strongest - weakest;
  return rest;
}

/// The change of force with depth of a burr that goes straight down into bone with its surface at
/// z = 0, between 0.6 and 1.4 times `force` [N/m].
inline double stiffness_at(const BoneForce& bone, double radius, double force) {
  const auto depth = [&](double wanted) {
    double low = 0.0;
    double high = radius;
    for (int n = 0; n < 40; ++n) {
      const double middle = 0.5 * (low + high);
      const bool less = bone(Eigen::Vector3d(1e-4, 2e-4, radius - middle)).norm() < wanted;
      (less ? low : high) = middle;
    }
    return low;
  };
  return 0.8 * force / (depth(1.4 * force) - depth(0.6 * force));
}

}  // namespace haptrial::test
