#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/contact/contact_surface.h"
#include "core/contact/shading.h"

namespace haptrial::evaluation {

/// Unit normals of a mesh's surface along a path over it: those of its shading, then averaged along
/// the path with Gaussian weights of its length.
/// @param shading    of the same surface: its crease angle says which edges stay sharp
/// @param path       (n) in the mesh's frame [m]; each point takes the normal of the nearest one of
///                   the surface
/// @param smoothing  standard deviation of the weights along the path, >= 0 [m]; 0: no averaging
/// @throws std::invalid_argument for a bad argument or a mesh without triangles.
std::vector<Eigen::Vector3d> path_normals(const contact::ContactSurface& surface,
                                          const contact::Shading& shading,
                                          std::span<const Eigen::Vector3d> path, double smoothing);

/// The path that a tool has to take for a rendering's contact point to follow the recorded one:
///
///     p_in = p_out - F_n / k,   F_n = max(0, F·n) n
///
/// F is the force on the probe, so that F_n points out of the body and p_in lies inside of it by
/// |F_n| / k. Where F pulls inwards there is no contact: p_in = p_out.
/// @param out      (n) contacts in the mesh's frame [m]
/// @param force    (n) on the probe in the same frame [N]
/// @param normals  (n) unit length, out of the body
/// @param stiffness  k > 0 [N/m]
/// @throws std::invalid_argument for lengths that differ or a stiffness that is not above 0.
/// Source: Morris 2006, §7.3.1, with the sign of the errata.
std::vector<Eigen::Vector3d> in_trajectory(std::span<const Eigen::Vector3d> out,
                                           std::span<const Eigen::Vector3d> force,
                                           std::span<const Eigen::Vector3d> normals,
                                           double stiffness);

}  // namespace haptrial::evaluation
