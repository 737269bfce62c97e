#include "core/deformable/springs/spring_forces.h"

namespace haptrial::deformable {
namespace {

/// Corners of a unit cube (x + 2 y + 4 z) as a star: the middle, and what lies opposite each of it.
constexpr std::array<int, kFillers> kFillingStar{0, 5, 3, 6, 7, 2, 4, 1};

PackView view_of(const ClusterPacks& packs) {
  return {packs.owned.size(), packs.corners.data(), packs.owned.data(), packs.constants.data()};
}

}  // namespace

SpringForces::SpringForces(const SpringBody& body, InstructionSet set)
    : vertices_(body.rest.size()), packs_(pack_springs(body)), kernel_(force_kernel(set)) {}

PaddedPoints SpringForces::points() const {
  PaddedPoints points(vertices_ + kFillers);
  for (std::size_t i = 0; i < kFillers; ++i) {
    const int corner = kFillingStar[i];
    points[vertices_ + i] = Eigen::Vector3d(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
  }
  return points;
}

std::size_t SpringForces::add(const PaddedPoints& positions, PaddedPoints& forces) const noexcept {
  const ForceQuery query{view_of(packs_.stars), view_of(packs_.singles), positions.data(),
                         forces.data()};
  return packs_.tetrahedra - kernel_(query);
}

std::vector<Eigen::Vector3d> SpringForces::forces(
    std::span<const Eigen::Vector3d> positions) const {
  PaddedPoints at = points();
  PaddedPoints sums(at.size());
  for (std::size_t v = 0; v < vertices_; ++v) {
    at[v] = positions[v];
  }
  add(at, sums);
  std::vector<Eigen::Vector3d> forces(vertices_);
  for (std::size_t v = 0; v < vertices_; ++v) {
    forces[v] = sums[v];
  }
  return forces;
}

}  // namespace haptrial::deformable
