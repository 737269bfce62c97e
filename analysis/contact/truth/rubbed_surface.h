#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "analysis/contact/truth/smooth_surface.h"

namespace haptrial::evaluation {

/// The god object with Coulomb friction on a smooth surface, which remembers its place. It stays
/// while the force lies in the friction cone, else slides down the distance to the tool until the
/// force lies on the cone. Once nothing pushes it any more it leaves the surface and goes straight
/// to the tool, or to where it meets the surface again.
class RubbedSurface {
 public:
  /// @param friction  of Coulomb, static and dynamic alike, >= 0
  RubbedSurface(std::unique_ptr<SmoothSurface> surface, double friction);

  /// The proxy for the next place of the tool; nothing in the air.
  std::optional<Eigen::Vector3d> next(const Eigen::Vector3d& tool);

 private:
  enum class Hold { kSlides, kHeld, kLeaves };
  Hold hold(const Eigen::Vector3d& at, const Eigen::Vector3d& tool) const;
  bool slide(Eigen::Vector3d& at, const Eigen::Vector3d& tool) const;
  std::optional<Eigen::Vector3d> meet(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  std::unique_ptr<SmoothSurface> surface_;
  double friction_;
  std::optional<Eigen::Vector3d> place_;  // of the proxy; none before the first tick
  bool touching_{false};
};

}  // namespace haptrial::evaluation
