#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/deformable/body/padded_points.h"
#include "core/deformable/elements/elastic_body.h"

namespace haptrial::deformable {

/// Forces of neo-Hookean elements whose volume is kept by patches, as ElasticBody has them, for
/// loops that must not allocate. A tetrahedron that is flat or inside out is taken to have
/// kLeastVolume of its volume where its form is concerned, so that its force is defined and turns
/// it back. One thread.
class ElementForces {
 public:
  static constexpr double kLeastVolume = 0.05;

  explicit ElementForces(const ElasticBody& body);

  /// Adds the forces [N] on vertices at `positions` [m].
  /// @returns how many tetrahedra have a volume that is not above 0.
  /// Servo thread: no allocation, lock or throw.
  std::size_t add(const PaddedPoints& positions, PaddedPoints& forces) noexcept;

 private:
  struct Tet {
    std::array<std::int32_t, 4> corners;
    Eigen::Matrix3d inverse;  // of the edges from its first corner, as columns, at rest [1/m]
    double volume;            // at rest [m³]
  };
  struct Deformation {
    Eigen::Matrix3d gradient, cofactor;
    double change;  // of volume: det F
  };
  struct Patch {
    std::int32_t first;  // of its tetrahedra
    double volume;       // [m³]
    Moduli moduli;
  };

  std::vector<Tet> tets_;          // patch after patch
  std::vector<Patch> patches_;     // and one that marks the end
  std::vector<Deformation> room_;  // of one patch
};

}  // namespace haptrial::deformable
