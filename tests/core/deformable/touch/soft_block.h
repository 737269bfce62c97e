#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "core/deformable/touch/ball_touch.h"
#include "core/deformable/touch/compliance.h"

namespace haptrial::test {

using deformable::BodySide;
using deformable::HapticMesh;
using deformable::SharedHapticMesh;
using deformable::Tissue;

/// 48 x 24 x 48 mm on a plate, touched from above.
inline SharedHapticMesh soft_block(int cells = 12) {
  deformable::FeltSides sides;
  sides.felt = {BodySide::kTop};
  return std::make_shared<const HapticMesh>(
      deformable::felt_block({0.048, 0.024, 0.048}, cells, sides, "block"));
}

inline Tissue soft_tissue() { return {20e3, 0.45, 1000.0, {}}; }

/// A block whose cells are `fine` at the middle of its top and grow outwards and downwards; touched
/// near the middle alone. Its bottom is held, some 60 `fine` below.
inline SharedHapticMesh half_space(double fine) {
  constexpr int kHalf = 13;  // cells from the middle to a side
  constexpr int kEven = 6;   // of them as fine
  constexpr double kGrowth = 1.55;
  std::array<double, kHalf + 1> at{};
  double step = fine;
  for (int i = 1; i <= kHalf; ++i) {
    step = i > kEven ? kGrowth * step : step;
    at[static_cast<std::size_t>(i)] = at[static_cast<std::size_t>(i - 1)] + step;
  }
  deformable::FeltSides sides;
  sides.felt = {BodySide::kTop};
  HapticMesh mesh =
      deformable::felt_block({2.0 * kHalf, kHalf, 2.0 * kHalf}, 2 * kHalf, sides, "half");
  const auto placed = [&](double x) {
    const double far = at[static_cast<std::size_t>(std::lround(std::abs(x)))];
    return x < 0.0 ? -far : far;
  };
  for (Eigen::Vector3d& v : mesh.tets.vertices) {
    v = {placed(v.x()), -placed(0.5 * kHalf - v.y()), placed(v.z())};
  }
  mesh.box = {Eigen::Vector3d(-at.back(), -at.back(), -at.back()),
              Eigen::Vector3d(at.back(), 0.0, at.back())};
  mesh.spacing = fine;
  std::erase_if(mesh.felt, [&](const deformable::Face& face) {
    for (const std::int32_t v : face) {
      const Eigen::Vector3d& p = mesh.tets.vertices[static_cast<std::size_t>(v)];
      if (std::max(std::abs(p.x()), std::abs(p.z())) > (kEven + 0.5) * fine) {
        return true;
      }
    }
    return false;
  });
  return std::make_shared<const HapticMesh>(std::move(mesh));
}

}  // namespace haptrial::test
