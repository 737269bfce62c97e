#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "analysis/contact/truth/true_bodies.h"

namespace haptrial::evaluation {

/// @throws std::invalid_argument for a body, stiffness or friction that breaks its bound, or a
/// position that is not finite.
void check_truth(const TrueBody& body, std::span<const Eigen::Vector3d> tool, double stiffness,
                 double friction);

struct TrueContact {
  bool touching{false};
  Eigen::Vector3d proxy;  // the tool itself in the air [m]
  Eigen::Vector3d force;  // on the tool: k (proxy - tool) [N]
};

/// The god object without friction: on the surface it is the place of least distance to the tool
/// that the one before reaches without the distance ever growing (Zilles and Salisbury 1995); it
/// leaves the surface when the tool comes to the outside of it. On edges it holds on to its face,
/// though another one may be nearer.
///
/// @param tool  (n) positions, small steps apart; the first one is in the air. On the wavy plate
///   and the edges a step must not jump over a crest or an edge that the straight way would meet.
/// @throws std::invalid_argument for a body or stiffness that breaks its bound, a position that is
/// not finite, or a first one inside.
std::vector<TrueContact> true_contacts(const TrueBody& body, std::span<const Eigen::Vector3d> tool,
                                       double stiffness);

/// The same with Coulomb friction of coefficient `friction` >= 0, static and dynamic alike,
/// quasi-static: the proxy stays while the force lies in the friction cone (Harwin and Melder
/// 2002), else slides along the surface against the force's part along it, the tool at rest, until
/// the force lies on the cone. In a valley of two faces the faces' pushes are added. The proxy
/// first touches where the straight way from the last position in the air meets the surface.
///
/// Exact on plane faces (rubbed_profile.h) and, to rounding, on sphere and cylinder; on torus and
/// wavy plate the sliding way is integrated with the fourth order, to 1e-12 m (rubbed_profile.h).
std::vector<TrueContact> true_contacts(const TrueBody& body, std::span<const Eigen::Vector3d> tool,
                                       double stiffness, double friction);

}  // namespace haptrial::evaluation
