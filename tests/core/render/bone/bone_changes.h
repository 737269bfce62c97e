#pragma once

#include <array>
#include <cmath>

#include "core/base/camera.h"
#include "core/base/random.h"
#include "tests/core/bone/surface/surface_checks.h"

namespace haptrial::render {

/// Near the surface of a ball like bumpy().
inline bone::Voxel some_voxel(const bone::BoneVolume& volume, RandomStream& random) {
  const double size = volume.grid().size[0];
  const auto any = [&] { return random.uniform(-1.0, 1.0); };
  const Eigen::Vector3d way = Eigen::Vector3d(any(), any(), any()).stableNormalized();
  const Eigen::Vector3d at =
      Eigen::Vector3d::Constant(0.5 * size) + random.uniform(0.3, 0.45) * size * way;
  return at.array().round().cast<int>();
}

/// Takes `amount` of the density in a ball; below 0 puts bone back where there can be any.
inline void change(bone::BoneVolume& volume, const bone::Voxel& centre, int radius, float amount) {
  for (int k = -radius; k <= radius; ++k) {
    for (int j = -radius; j <= radius; ++j) {
      for (int i = -radius; i <= radius; ++i) {
        const bone::Voxel voxel = centre + bone::Voxel(i, j, k);
        const std::int32_t at = volume.address(voxel);
        if (at == 0 || i * i + j * j + k * k > radius * radius) {
          continue;
        }
        if (amount >= 0.0F) {
          volume.take(at, amount);
        } else if (volume.label(at) != 0) {
          volume.put(at, 1.0F);
        }
      }
    }
  }
}

inline void change_at_random(bone::BoneVolume& volume, RandomStream& random) {
  const std::array amounts{1.0F, 1.0F, 0.4F, -1.0F};
  change(volume, some_voxel(volume, random), 1 + static_cast<int>(random.below(5)),
         amounts[random.below(amounts.size())]);
}

/// The eye goes round the target about `up` [rad].
inline Camera gone_round(Camera camera, double turn) {
  const Eigen::AngleAxisd by(turn, camera.up.normalized());
  camera.eye = camera.target + by * (camera.eye - camera.target);
  return camera;
}

/// A ball with bumps; `nerve` of label 2 runs through.
inline bone::BoneModel bumpy(int size) {
  return bone::model_of(size, [size](const bone::Voxel& v) {
    const double bumps =
        2.5 * std::sin(0.7 * v.x()) * std::sin(0.9 * v.y()) * std::sin(0.8 * v.z());
    const double middle = 0.5 * (size - 1);
    const bool bone =
        (v.cast<double>() - Eigen::Vector3d::Constant(middle)).norm() + bumps < 0.4 * size;
    const bool nerve = std::abs(v.x() - middle) < 2.0 && std::abs(v.z() - 0.8 * size) < 2.0;
    return bone ? (nerve ? 2 : 1) : 0;
  });
}

}  // namespace haptrial::render
