#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/contact_surface.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::contact {

/// Normals for force shading: one at each corner of each triangle, the mean, weighted by angle, of
/// the normals of the triangles around its vertex that are joined to it over edges less sharp than
/// the crease angle. Across a crease the corners keep to their own side, so the normal never turns
/// over there.
/// Sources: Morris 2006, §7.4.4; Morgenbesser and Srinivasan 1996; Ruspini et al. 1997.
class Shading {
 public:
  /// @param crease_angle  between the normals of two triangles, 0 to pi / 2 [rad]
  Shading(const geometry::Mesh& mesh, const ContactSurface& surface, double crease_angle);

  /// The interpolated normal at the point of the triangle below `at`, on the side of `normal`.
  /// Servo thread.
  Eigen::Vector3d normal(std::int32_t triangle, const Eigen::Vector3d& at,
                         const Eigen::Vector3d& normal) const noexcept;

 private:
  const ContactSurface* surface_;
  std::vector<std::array<Eigen::Vector3d, 3>> corners_;  // by triangle
};

}  // namespace haptrial::contact
