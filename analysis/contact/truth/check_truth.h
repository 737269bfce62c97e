#pragma once

#include <Eigen/Core>
#include <span>

#include "analysis/contact/truth/true_bodies.h"

namespace haptrial::evaluation {

/// @throws std::invalid_argument for a body, stiffness or friction that breaks its bound, or a
/// position that is not finite.
void check_truth(const TrueBody& body, std::span<const Eigen::Vector3d> tool, double stiffness,
                 double friction);

}  // namespace haptrial::evaluation
