#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/contact/truth/smooth_surface.h"
#include "analysis/contact/truth/true_bodies.h"

namespace haptrial::evaluation {

/// A plane face along z: the points start + s along, low <= s <= high. The solid is on the left.
struct ProfileFace {
  Eigen::Vector2d start, along;  // along has unit length
  double low, high;              // may be infinite [m]

  Eigen::Vector2d normal() const { return {along.y(), -along.x()}; }  // out of the solid
};

/// The god object with Coulomb friction on plane faces along z, exactly; it remembers its place.
///
/// On a face it stays while the force lies in the friction cone, else goes straight towards the
/// tool's foot until the force lies on the cone. Over a convex edge it goes on, on the next face.
/// In a valley where both faces push, friction acts along the valley alone, by the sum of what the
/// two push with: a V-block. Elsewhere in a valley the face decides along which the tool pulls.
class RubbedProfile {
 public:
  /// @param faces     in order, the high end of each joined to the low end of the next
  /// @param closed    the last is joined to the first
  /// @param friction  of Coulomb, static and dynamic alike, >= 0
  RubbedProfile(std::vector<ProfileFace> faces, bool closed, double friction);

  /// The proxy for the next place of the tool; nothing in the air.
  std::optional<Eigen::Vector3d> next(const Eigen::Vector3d& tool);

 private:
  struct Spot {
    std::size_t face;
    double along, z;  // [m]
  };
  struct LeftFaces {
    std::size_t face, other;  // the same, or both that make an edge
  };
  Eigen::Vector3d place(const Spot& spot) const;
  bool slide(Spot& at, const Eigen::Vector3d& tool, LeftFaces& left) const;
  void rest_in_valley(Spot& at, std::size_t other, const Eigen::Vector3d& tool) const;
  std::optional<Spot> meet(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                           const std::optional<LeftFaces>& left) const;

  std::vector<ProfileFace> faces_;
  bool closed_;
  double friction_;
  std::optional<Eigen::Vector3d> free_;  // the tool in the air
  std::optional<Spot> spot_;             // of the proxy on a face
};

RubbedProfile rubbed_profile(const TruePlane& body, double friction);
RubbedProfile rubbed_profile(const TrueWedge& body, double friction);
RubbedProfile rubbed_profile(const TrueConcaveEdge& body, double friction);
RubbedProfile rubbed_profile(const TrueThinPlate& body, double friction);

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
