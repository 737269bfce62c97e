#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "analysis/contact/truth/true_bodies.h"

namespace haptrial::evaluation {

/// The surface of a solid without edges.
class SmoothSurface {
 public:
  virtual ~SmoothSurface() = default;

  /// Height above the surface, positive outside; in size no more than the distance from the surface
  /// [m].
  virtual double height(const Eigen::Vector3d& p) const = 0;
  /// The point of the surface that belongs to a point beside it.
  virtual Eigen::Vector3d onto(const Eigen::Vector3d& p) const = 0;
  /// Out of the solid, a unit vector. @param on  a point of the surface
  virtual Eigen::Vector3d normal(const Eigen::Vector3d& on) const = 0;

  /// Place of a point of the surface after the time s if it slides down the distance to the tool:
  ///
  ///     dx/ds = (I - n nᵀ)(tool - x)
  ///
  /// Exact where a body has a closed form, else stepped_flow().
  virtual Eigen::Vector3d flow(const Eigen::Vector3d& from, const Eigen::Vector3d& tool,
                               double time) const;
  /// First point of that way on the friction cone, if there is a formula: from outside of it.
  virtual std::optional<Eigen::Vector3d> cone(const Eigen::Vector3d& from,
                                              const Eigen::Vector3d& tool, double friction) const;
};

/// The same by Runge and Kutta's method of the fourth order on any surface. Steps are halved until
/// a step and its two halves agree to 1e-14 m.
Eigen::Vector3d stepped_flow(const SmoothSurface& surface, const Eigen::Vector3d& from,
                             const Eigen::Vector3d& tool, double time);

std::unique_ptr<SmoothSurface> smooth_surface(const TrueSphere& body);
std::unique_ptr<SmoothSurface> smooth_surface(const TrueCylinder& body);
std::unique_ptr<SmoothSurface> smooth_surface(const TrueTorus& body);
std::unique_ptr<SmoothSurface> smooth_surface(const TrueWavyPlate& body);

}  // namespace haptrial::evaluation
