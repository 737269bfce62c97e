#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/contact/contact_surface.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::contact {

/// The distance from a closed mesh, negative inside, and the point where it is measured.
struct SurfacePoint {
  double distance{0.0};                             // [m]
  Eigen::Vector3d point{Eigen::Vector3d::Zero()};   // the nearest of the surface [m]
  Eigen::Vector3d normal{Eigen::Vector3d::Zero()};  // out of the body: the distance's gradient
  std::int32_t triangle{-1};
};

/// The distance from a body, by whatever stands for its surface.
class BodyDistance {
 public:
  virtual ~BodyDistance() = default;
  /// Servo thread: no allocation, lock, I/O or throw. @param hint  a triangle that may be near; -1:
  /// none
  virtual SurfacePoint operator()(const Eigen::Vector3d& point,
                                  std::int32_t hint) const noexcept = 0;
};

/// Signed distances by the normals of faces, edges and corners, those of corners weighted by angle:
/// their sign is right for closed, oriented meshes that do not cut themselves.
/// Source: Baerentzen and Aanaes 2005.
class SignedDistance final : public BodyDistance {
 public:
  /// @param surface  of the same mesh; it must outlive this
  SignedDistance(const geometry::Mesh& mesh, const ContactSurface& surface);

  const ContactSurface& surface() const noexcept { return *surface_; }

  SurfacePoint operator()(const Eigen::Vector3d& point,
                          std::int32_t hint = -1) const noexcept override;
  /// The surface point of the triangle alone: the distance from its plane.
  SurfacePoint of_plane(const Eigen::Vector3d& point, std::int32_t triangle) const noexcept;

 private:
  const ContactSurface* surface_;
  std::vector<geometry::Triangle> triangles_;
  std::vector<Eigen::Vector3d> corner_normals_;               // by vertex
  std::vector<std::array<Eigen::Vector3d, 3>> edge_normals_;  // by triangle and edge
};

}  // namespace haptrial::contact
