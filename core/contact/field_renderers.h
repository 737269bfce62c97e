#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/contact/contact_surface.h"
#include "core/contact/normal_spring.h"
#include "core/contact/renderer.h"
#include "core/contact/signed_distance.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::contact {

/// The cells of a cubic grid around a mesh.
struct CellGrid {
  Eigen::Vector3d origin;  // of cell 0, its corner [m]
  double side;             // of a cell [m]
  Eigen::Array3i count;

  /// Two cells wider than the mesh's box. @param resolution  cells along the longest side
  CellGrid(const geometry::Mesh& mesh, int resolution);
  std::size_t size() const { return static_cast<std::size_t>(count[0]) * count[1] * count[2]; }
};

/// Signed distances of a closed mesh on a grid around it, interpolated trilinearly; the normal is
/// the gradient, whose length is near 1.
class SampledDistance final : public BodyDistance {
 public:
  /// @param resolution  cells along the mesh's longest side
  SampledDistance(const geometry::Mesh& mesh, const ContactSurface& surface, int resolution);

  bool holds(const Eigen::Vector3d& point) const noexcept;
  /// Servo thread. Beyond the grid the distance is that from the grid, which is less.
  SurfacePoint operator()(const Eigen::Vector3d& point,
                          std::int32_t hint = -1) const noexcept override;

 private:
  CellGrid grid_;
  std::vector<double> distance_;  // by corner of cells, x fastest [m]
};

/// A spring from the tool out of a surface, along one normal. Without a proxy it knows no friction.
class DepthRenderer : public Renderer {
 public:
  void start(const Eigen::Vector3d& tool) noexcept override;
  const Contact& tick(const Eigen::Vector3d& tool, double period) noexcept override;
  void set_damping_share(double share) noexcept override { spring_.set_damping_share(share); }
  const Operations& operations() const noexcept override { return operations_; }

 protected:
  explicit DepthRenderer(const RendererOptions& options) : spring_(options) {}

 private:
  /// Distance of a finite tool from the surface, negative inside, and the normal of the force.
  virtual SurfacePoint below(const Eigen::Vector3d& tool, Operations& operations) noexcept = 0;

  NormalSpring spring_;
  Contact contact_;
  Operations operations_;
};

/// A spring from the tool to the nearest point of a closed mesh, when the tool is inside. No
/// memory: where two sides are equally near, the force jumps, and a thin plate lets the tool
/// through.
class PenaltyRenderer final : public DepthRenderer {
 public:
  PenaltyRenderer(const geometry::Mesh& mesh, const ContactSurface& surface,
                  const RendererOptions& options);

 private:
  SurfacePoint below(const Eigen::Vector3d& tool, Operations& operations) noexcept override;

  SignedDistance distance_;
  std::int32_t hint_{-1};
};

/// A grid of voxels, each of which has stored the triangle nearest to its centre; the tool is
/// pushed along that triangle's normal by its depth below that triangle's plane. Source: Morris
/// 2006, §7.4.1; McNeely et al. 1999.
class VoxelRenderer final : public DepthRenderer {
 public:
  VoxelRenderer(const geometry::Mesh& mesh, const ContactSurface& surface,
                const RendererOptions& options);

 private:
  SurfacePoint below(const Eigen::Vector3d& tool, Operations& operations) noexcept override;

  SignedDistance distance_;
  CellGrid grid_;
  std::vector<std::int32_t> nearest_;  // by cell, x fastest
};

/// Signed distances on a grid, interpolated trilinearly. The force is minus the gradient of
///
///     E(x) = k/2 min(d(x), 0)²
///
/// and so takes back on a closed path what it gave: E is continuous.
class DistanceFieldRenderer final : public DepthRenderer {
 public:
  DistanceFieldRenderer(const geometry::Mesh& mesh, const ContactSurface& surface,
                        const RendererOptions& options);

 private:
  SurfacePoint below(const Eigen::Vector3d& tool, Operations& operations) noexcept override;

  SampledDistance distance_;
};

}  // namespace haptrial::contact
