#include "tests/support/references/surface_samples.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/bone/model/voxel_walk.h"

namespace haptrial::bone {

SurfaceSamples::SurfaceSamples(double radius, std::int32_t samples) : radius_(radius) {
  if (!(radius > 0.0) || samples < 1) {
    throw std::invalid_argument("SurfaceSamples: a radius above 0 and at least one sample");
  }
  const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (std::int32_t n = 0; n < samples; ++n) {
    const double z = 1.0 - (2.0 * n + 1.0) / samples;
    const double across = std::sqrt(1.0 - z * z);
    directions_.emplace_back(across * std::cos(n * turn), across * std::sin(n * turn), z);
  }
  addresses_.resize(static_cast<std::size_t>(samples) * kLongestRay);
}

SurfaceContact SurfaceSamples::touch(const BoneVolume& volume, const Eigen::Vector3d& tip_B,
                                     const Eigen::Quaterniond& orientation_B) noexcept {
  SurfaceContact contact;
  used_ = 0;
  for (const Eigen::Vector3d& direction_T : directions_) {
    const Eigen::Vector3d direction = orientation_B * direction_T;
    double way = 0.0;
    std::int32_t passed = 0;
    // A ray begins in bone or not at all: its first voxel is the one that its sample lies in.
    walk_voxels(
        volume.grid(), tip_B + radius_ * direction, tip_B,
        [&](const Voxel& voxel, double in, double out) {
          const std::int32_t at = volume.address(voxel);
          if ((passed == 0 && in > 0.0) || !(volume.density(at) > 0.0F) || passed == kLongestRay) {
            return false;
          }
          addresses_[used_++] = at;
          ++passed;
          way = out;
          return true;
        });
    if (passed > 0) {
      ++contact.samples;
      contact.push -= way * radius_ * direction;
    }
  }
  return contact;
}

double SurfaceSamples::remove(BoneVolume& volume, float amount) noexcept {
  double sum = 0.0;
  for (std::size_t n = 0; n < used_; ++n) {
    sum += static_cast<double>(volume.take(addresses_[n], amount));
  }
  return sum;
}

Eigen::Vector3d surface_force(const SurfaceContact& contact, double stiffness,
                              double force_limit) noexcept {
  const Eigen::Vector3d force = stiffness * contact.push;
  const double length = force.norm();
  return length > force_limit ? Eigen::Vector3d(force * (force_limit / length)) : force;
}

}  // namespace haptrial::bone
