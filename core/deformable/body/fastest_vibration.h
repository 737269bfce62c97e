#pragma once

#include <cstdint>
#include <span>

#include "core/deformable/body/block_matrix.h"

namespace haptrial::deformable {

/// An upper bound of the fastest vibration ω of small motions [1/s]: the square root of the largest
/// eigenvalue of M⁻¹ K, by Lanczos' method, with what it may still lack and 0.2 % added. Verlet's
/// method is stable up to steps of 2 / ω.
/// @param stiffness  K [N/m]  @param masses  of the vertices [kg]
/// @param held  vertices that do not move
double fastest_vibration(const BlockMatrix& stiffness, std::span<const double> masses,
                         std::span<const std::int32_t> held = {});

}  // namespace haptrial::deformable
