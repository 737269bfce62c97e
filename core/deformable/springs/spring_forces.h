#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/big_array.h"
#include "core/deformable/springs/force_kernel.h"
#include "core/deformable/springs/star_packs.h"

namespace haptrial::deformable {

/// Points as the kernel reads them: x, y, z and a number that is 0.
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

/// The exact forces of all springs of a body in one pass over clusters of five tetrahedra, eight
/// clusters at once. Forces along edges are equal and opposite and those of a volume sum to zero,
/// so that linear and angular momentum are kept to the rounding of doubles. The same bits on every
/// instruction set. One thread.
/// Source: Morris 2006, §5.4.1.
class SpringForces {
 public:
  explicit SpringForces(const SpringBody& body, InstructionSet set = best_instruction_set());

  /// Places for every vertex and what fills the kernel's lanes, which no caller writes to.
  PaddedPoints points() const;

  /// Adds the springs' forces [N] on vertices at `positions` [m]; both made by points().
  /// @returns how many tetrahedra have a volume that is not above 0.
  /// Servo thread: no allocation, lock or throw (SpringMotionTest.AStepDoesNotAllocate).
  std::size_t add(const PaddedPoints& positions, PaddedPoints& forces) const noexcept;

  /// The same from and to plain vectors.
  std::vector<Eigen::Vector3d> forces(std::span<const Eigen::Vector3d> positions) const;

  std::size_t vertices() const { return vertices_; }

 private:
  std::size_t vertices_;
  SpringPacks packs_;
  ForceKernel kernel_;
};

}  // namespace haptrial::deformable
