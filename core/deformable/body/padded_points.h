#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "core/base/big_array.h"

namespace haptrial::deformable {

/// Points as kernels read them: x, y, z and a number that is 0.
class PaddedPoints {
 public:
  explicit PaddedPoints(std::size_t points = 0) : values_(4 * points, 0.0) {}
  Eigen::Map<Eigen::Vector3d> operator[](std::size_t i) {
    return Eigen::Map<Eigen::Vector3d>(values_.data() + 4 * i);
  }
  Eigen::Map<const Eigen::Vector3d> operator[](std::size_t i) const {
    return Eigen::Map<const Eigen::Vector3d>(values_.data() + 4 * i);
  }
  double* data() { return values_.data(); }
  const double* data() const { return values_.data(); }
  std::size_t size() const { return values_.size() / 4; }

 private:
  BigArray<double> values_;
};

}  // namespace haptrial::deformable
