#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

#include "core/contact/signed_distance.h"

namespace haptrial::evaluation {

struct RegistrationOptions {
  double radius{0.0};     // of the probe's sphere: its centre is this far outside the mesh [m]
  double trimmed{0.1};    // share of the contacts that may be wrong, 0 .. 0.5: left out
  int starts{200};        // orientations tried; 0: only from `guess`
  std::uint64_t seed{1};  // of these orientations
  Eigen::Isometry3d guess{Eigen::Isometry3d::Identity()};  // T_BW
};

/// Pose of a registered path relative to the mesh.
struct Registration {
  Eigen::Isometry3d body_from_world;  // T_BW: contacts in W become contacts in the mesh's frame B
  std::vector<double> residuals;      // (n) signed distance - radius, positive outside [m]
  double rms{0.0};                    // of the contacts that were kept [m]
  double median{0.0};                 // of all |residuals| [m]
  double p95{0.0};                    // their 95 % quantile [m]
  double worst{0.0};                  // [m]
  std::vector<std::string> unfixed;   // sentences: directions that the contacts do not fix
};

/// Moves a path of contacts onto a mesh, rigidly: iterated closest points with distances along the
/// surface's normals (Chen and Medioni 1992), by damped Gauss-Newton over contacts trimmed by their
/// distance (Chetverikov et al. 2005), with Tukey's weights on those that are kept. The starting
/// orientations are spread at random; the best one on a subset of the contacts is refined on all.
///
/// A direction of movement (an eigenvector of the last equations) is unfixed when moving along it
/// by a hundredth of the path's size, one way or the other, leaves the mean square below 1.5 times
/// what it was. A sentence describes each: a shift, or a turn about an axis, in the mesh's frame.
///
/// @param distance  from the body, whose triangles face outwards
/// @param contacts  (n >= 12) in W [m]
/// @throws std::invalid_argument for fewer contacts, one that is not finite, an empty mesh or an
/// option that breaks its bound.
Registration register_path(const contact::SignedDistance& distance,
                           std::span<const Eigen::Vector3d> contacts,
                           const RegistrationOptions& options = {});

/// The same residuals for contacts that were not fitted: a test of a registration, or of a body.
std::vector<double> surface_residuals(const contact::SignedDistance& distance,
                                      const Eigen::Isometry3d& body_from_world,
                                      std::span<const Eigen::Vector3d> contacts, double radius);

}  // namespace haptrial::evaluation
