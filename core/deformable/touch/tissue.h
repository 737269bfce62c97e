#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/deformable/elements/elastic_body.h"
#include "core/deformable/touch/haptic_mesh.h"

namespace haptrial::deformable {

/// A ball of another stiffness in a body.
struct Inclusion {
  std::string name;
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};  // in the body's frame [m]
  double radius{};                                  // >= 0; 0: it is not there [m]
  double young{};                                   // > 0 [Pa]

  bool operator==(const Inclusion&) const = default;
};

/// Material and voxels of a body.
struct Tissue {
  double young{};          // E > 0 [Pa]
  double poisson{};        // 0 <= nu <= kMostPoisson
  double density{1000.0};  // > 0; of springs [kg/m³]
  std::vector<Inclusion> inclusions;

  bool operator==(const Tissue&) const = default;
};

/// Beyond it the volume is kept so strongly that forces of doubles tell little of a surface.
inline constexpr double kMostPoisson = 0.499;
inline constexpr std::size_t kMostInclusions = 8;

/// @throws InputError naming the body and the value that breaks its bound, or an inclusion that
/// does not lie within the body's box.
void check_tissue(const HapticMesh& mesh, const Tissue& tissue);

/// The share of each voxel that lies in a ball, by equally spaced points, for its five tetrahedra:
/// (tetrahedra).
std::vector<double> shares_in_ball(const HapticMesh& mesh, const Eigen::Vector3d& centre,
                                   double radius);

/// The materials of the elements. In a voxel that a ball cuts, the logarithm of E lies
/// between those of both by the ball's share, in steps of 1/16: so what is felt changes smoothly
/// with centre and radius.
Elasticity elasticity_of(const HapticMesh& mesh, const Tissue& tissue);

}  // namespace haptrial::deformable
