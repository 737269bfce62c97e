#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "core/deformable/springs/spring_body.h"

namespace haptrial::deformable {

/// linear/fastest_vibration.h of small motions about `positions` [1/s], with the exact Hessian
/// there (spring_hessian.h).
double fastest_vibration(const SpringBody& body, std::span<const Eigen::Vector3d> positions,
                         std::span<const std::int32_t> held = {});

/// The longest step of Verlet's method that is stable for small motions about the rest shape, 2 / ω
/// [s], with or without damping; infinite for a body without any stiffness. A body that is
/// stretched or crushed far may be stiffer: ask fastest_vibration() there.
double stable_step(const SpringBody& body, std::span<const std::int32_t> held = {});

}  // namespace haptrial::deformable
