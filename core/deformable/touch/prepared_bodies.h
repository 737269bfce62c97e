#pragma once

#include "core/base/kept.h"
#include "core/deformable/touch/haptic_mesh.h"

namespace haptrial::deformable {

inline constexpr std::size_t kMostPrepared = 128;

/// A mesh of a tissue. Meshes that are alike in every number count as the same.
template <class Tissue>
struct TissueMesh {
  SharedHapticMesh mesh;
  Tissue tissue;
  bool operator==(const TissueMesh& other) const {
    return tissue == other.tissue && (mesh == other.mesh || same_mesh(*mesh, *other.mesh));
  }
};

/// Bodies of tissues, kMostPrepared of them.
template <class Tissue, class Body>
struct PreparedBodies : Kept<TissueMesh<Tissue>, Body> {
  PreparedBodies() : Kept<TissueMesh<Tissue>, Body>(kMostPrepared) {}
};

}  // namespace haptrial::deformable
