#pragma once

#include <vector>

#include "core/contact/normal_spring.h"
#include "core/contact/renderer.h"
#include "core/contact/sampled_distance.h"
#include "core/contact/signed_distance.h"

namespace haptrial::contact {

/// A spring from the tool to the nearest point of a closed mesh, when the tool is inside. No
/// memory: where two sides are equally near, the force jumps, and a thin plate lets the tool
/// through.
class PenaltyRenderer final : public Renderer {
 public:
  PenaltyRenderer(const geometry::Mesh& mesh, const ContactSurface& surface,
                  const RendererOptions& options);
  void start(const Eigen::Vector3d& tool) noexcept override;
  const Contact& tick(const Eigen::Vector3d& tool, double period) noexcept override;
  void set_damping_share(double share) noexcept override { spring_.set_damping_share(share); }
  const Operations& operations() const noexcept override { return operations_; }

 private:
  SignedDistance distance_;
  NormalSpring spring_;
  std::int32_t hint_{-1};
  Contact contact_;
  Operations operations_;
};

/// A grid of voxels, each of which has stored the triangle nearest to its centre; the tool is
/// pushed along that triangle's normal by its depth below that triangle's plane. Source: Morris
/// 2006, §7.4.1; McNeely et al. 1999.
class VoxelRenderer final : public Renderer {
 public:
  VoxelRenderer(const geometry::Mesh& mesh, const ContactSurface& surface,
                const RendererOptions& options);
  void start(const Eigen::Vector3d& tool) noexcept override;
  const Contact& tick(const Eigen::Vector3d& tool, double period) noexcept override;
  void set_damping_share(double share) noexcept override { spring_.set_damping_share(share); }
  const Operations& operations() const noexcept override { return operations_; }

 private:
  SignedDistance distance_;
  CellGrid grid_;
  std::vector<std::int32_t> nearest_;  // by cell, x fastest
  NormalSpring spring_;
  Contact contact_;
  Operations operations_;
};

/// Signed distances on a grid, interpolated trilinearly. The force is minus the gradient of
///
///     E(x) = k/2 min(d(x), 0)²
///
/// and so takes back on a closed path what it gave: E is continuous.
class DistanceFieldRenderer final : public Renderer {
 public:
  DistanceFieldRenderer(const geometry::Mesh& mesh, const ContactSurface& surface,
                        const RendererOptions& options);
  void start(const Eigen::Vector3d& tool) noexcept override;
  const Contact& tick(const Eigen::Vector3d& tool, double period) noexcept override;
  void set_damping_share(double share) noexcept override { spring_.set_damping_share(share); }
  const Operations& operations() const noexcept override { return operations_; }

 private:
  SampledDistance distance_;
  NormalSpring spring_;
  Contact contact_;
  Operations operations_;
};

}  // namespace haptrial::contact
