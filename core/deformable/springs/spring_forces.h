#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/deformable/body/padded_points.h"
#include "core/deformable/springs/force_kernel.h"
#include "core/deformable/springs/star_packs.h"

namespace haptrial::deformable {

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
