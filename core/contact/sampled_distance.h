#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/contact/contact_surface.h"
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

}  // namespace haptrial::contact
