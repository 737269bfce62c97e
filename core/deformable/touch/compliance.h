#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/base/big_array.h"
#include "core/contact/contact_surface.h"
#include "core/deformable/touch/surface_samples.h"
#include "core/deformable/touch/tissue.h"

namespace haptrial::deformable {

/// How a linear body gives way at its surface: what a force on one vertex that can be touched does
/// to the others, and to those one element deeper. With it a tick takes microseconds and gives the
/// answer of all the elements at rest.
///
/// Vertices are known by places: first those that can be touched, then the deeper ones.
/// Source: Morris 2006, §5.3.2 (quasi-static elements); James and Pai 1999 (ArtDefo).
class Compliance {
 public:
  using Block = std::array<float, 12>;  // 3 x 3, column after column, each with a fourth number 0

  /// Takes some seconds. @throws InputError as check_tissue() and ElasticBody
  Compliance(SharedHapticMesh mesh, const Tissue& tissue);

  const HapticMesh& mesh() const noexcept { return *mesh_; }
  std::size_t touched() const noexcept { return touched_; }         // columns
  std::size_t places() const noexcept { return vertices_.size(); }  // rows
  std::int32_t vertex(std::int32_t place) const noexcept {
    return vertices_[static_cast<std::size_t>(place)];
  }
  const Eigen::Vector3d& rest(std::int32_t place) const noexcept {
    return rest_[static_cast<std::size_t>(place)];
  }

  std::span<const Eigen::Vector3d> rest() const noexcept { return rest_; }  // (places) [m]

  /// Response of a place to a force on a touched place [m/N].
  const Block& block(std::int32_t place, std::int32_t touched) const noexcept {
    return blocks_[static_cast<std::size_t>(place) * touched_ + static_cast<std::size_t>(touched)];
  }
  static Eigen::Vector3f response(const Block& block, const Eigen::Vector3f& force) noexcept {
    using Column = Eigen::Map<const Eigen::Vector4f, Eigen::Aligned16>;
    const float* b = block.data();
    const Eigen::Vector4f u =
        force[0] * Column(b) + force[1] * Column(b + 4) + force[2] * Column(b + 8);
    return u.head<3>();
  }
  /// The displacement of one place by a force on a touched one [m].
  Eigen::Vector3f response(std::int32_t place, std::int32_t touched,
                           const Eigen::Vector3f& force) const noexcept {
    return response(block(place, touched), force);
  }

  /// The faces that can be touched: corners are places. Surface: the same at rest.
  const std::vector<Face>& faces() const noexcept { return faces_; }
  const contact::ContactSurface& surface() const noexcept { return *surface_; }
  /// Tetrahedra with a corner that can be touched: corners are places.
  const std::vector<geometry::Tetrahedron>& outer_tets() const noexcept { return outer_tets_; }
  /// Numbers of outer_tets() at a touched place.
  std::span<const std::int32_t> tets_at(std::int32_t place) const noexcept;

  /// Samples of faces(), made once for each number of steps along an edge. Any thread.
  std::shared_ptr<const SurfaceSamples> samples(int steps) const;

  /// A bound on how stiff a ball on the surface can be: all vertices that it could reach move
  /// together [N/m]. Infinite where it can reach a held one. Looks at up to 64 places.
  double stiffest(double radius) const;

 private:
  void number_places(const PatchLayout& layout);
  void invert(const ElasticBody& body);
  double stiffest_at(std::int32_t centre, double radius) const;

  SharedHapticMesh mesh_;
  std::size_t touched_{0};
  std::vector<std::int32_t> vertices_;  // of the mesh, by place
  std::vector<Eigen::Vector3d> rest_;
  std::vector<Face> faces_;
  std::vector<geometry::Tetrahedron> outer_tets_;
  std::vector<std::int32_t> first_tet_, tets_;  // by touched place
  std::unique_ptr<contact::ContactSurface> surface_;
  mutable std::mutex samples_lock_;                                       // of the next
  mutable std::map<int, std::shared_ptr<const SurfaceSamples>> samples_;  // by steps
  BigArray<Block> blocks_;                                                // (places x touched)
};

/// Memory of a Compliance [bytes]: what stays, and at most while it is made.
struct ComplianceMemory {
  double kept{};
  double most{};
};
ComplianceMemory compliance_memory(const HapticMesh& mesh);

}  // namespace haptrial::deformable
