#pragma once

#include <memory>

#include "core/base/shared_cache.h"
#include "core/deformable/touch/compliance.h"
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
struct PreparedBodies : SharedCache<TissueMesh<Tissue>, Body> {
  PreparedBodies() : SharedCache<TissueMesh<Tissue>, Body>(kMostPrepared) {}
};

/// The compliance of a body of a tissue, made when it is first asked for and shared by all who ask
/// for the same: trials, participants, threads. Tissues of meshes that are
/// alike have one mesh. Any thread but the servo thread.
/// @throws InputError as check_tissue(), and before anything is made if the machine has not the
/// memory that it takes.
std::shared_ptr<const Compliance> prepared(const SharedHapticMesh& mesh, const Tissue& tissue);

/// @throws InputError naming the body if the machine has not the memory that it takes.
void check_memory(const HapticMesh& mesh);

/// A bound on how stiff a ball of this radius can be on the body, wherever it is: as
/// Compliance::stiffest(), with the corners of all faces that it could press [N/m].
double stiffest_touch(const Compliance& body, double radius);

}  // namespace haptrial::deformable
