#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/deformable/touch/moving_body.h"

namespace haptrial::deformable {

/// How the surface of a body that moves gives way to forces within a time τ, an implicit step of
/// it, with the stiffness K and the masses M at rest:
///
///     u = (K + M / τ²)⁻¹ f
///
/// Stiffer than at rest by what inertia holds; a body that nothing holds has one, too.
class WindowCompliance {
 public:
  /// Takes up to some seconds. @param time  τ > 0 [s]
  WindowCompliance(const MovingBody& body, double time);

  /// Displacement of v per force on the vertex w [m/N]; zero if one of them is held or cannot be
  /// touched. Any thread.
  Eigen::Matrix3f block(std::int32_t v, std::int32_t w) const noexcept {
    const std::int32_t row = place_[static_cast<std::size_t>(v)];
    const std::int32_t column = place_[static_cast<std::size_t>(w)];
    return row < 0 || column < 0 ? Eigen::Matrix3f(Eigen::Matrix3f::Zero())
                                 : Eigen::Matrix3f(inverse_.block<3, 3>(3 * row, 3 * column));
  }

 private:
  std::vector<std::int32_t> place_;  // by vertex; -1: none
  Eigen::MatrixXf inverse_;          // (3 places x 3 places)
};
using SharedWindowCompliance = std::shared_ptr<const WindowCompliance>;

/// A compliance, made when it is first asked for and shared (touch/prepared_bodies.h). Any thread
/// but the servo thread. @param window  that the body is behind on the average [s]
/// @throws InputError if the machine has not the memory.
SharedWindowCompliance prepared_compliance(const SharedMovingBody& body, double window);

}  // namespace haptrial::deformable
