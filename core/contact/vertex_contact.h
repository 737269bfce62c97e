#pragma once

#include <Eigen/Core>
#include <array>

#include "core/contact/near_triangles.h"
#include "core/contact/plane_set.h"
#include "core/contact/sweep.h"

namespace haptrial::contact {

/// A corner where a point rests, and what stopped it on every way on from there. While the tool
/// moves and the point does not, planes and triangles lie as they did: a few products tell whether
/// each way is still stopped at once. Servo thread.
class VertexContact {
 public:
  void forget() noexcept { met_.clear(); }

  /// @param met  what the ways on from a point met
  /// @param at  the point [m]
  void set(const PlaneSet& met, const Eigen::Vector3d& at, const Skin& skin) noexcept;

  /// Whether three planes or more were met, with the same skin.
  bool known(const Skin& skin) const noexcept {
    return met_.size() >= 3 && met_.size() <= kMost && skin.thickness == skin_.thickness;
  }
  /// Whether the way to the tool, and those that lead nearer to it along one plane or two, are
  /// stopped at once. Only of a corner that is known.
  /// @param wish  from the point to the tool [m]
  /// @param enough  ways that are no longer lead nowhere [m]
  /// @returns false also where only sweeps can tell
  bool holds(const Eigen::Vector3d& wish, double enough, NearTriangles& near) noexcept;

 private:
  static constexpr int kMost = 8;

  /// A plane, and what else bounds the triangle that it belongs to.
  struct Side {
    static constexpr int kBounds = 6;
    Eigen::Vector3d normal;
    double lack;                          // of the point's height over the plane, 0 or less [m]
    double above;                         // the triangle's hull, so far is the point [m]
    std::array<double, kBounds> x, y, z;  // out of it: unit vectors or zero
    std::array<double, kBounds> room;     // from the point to there [m]
  };
  struct Line {             // where two planes meet
    Eigen::Vector3d along;  // a unit vector
    Eigen::Vector3d onto;   // from the point to the line [m]
    bool known;             // not of planes that are nearly parallel
  };
  void prepare(NearTriangles& near) noexcept;
  Side side(const ContactPlane& plane, const Hull& hull) const noexcept;
  bool stopped(const Eigen::Vector3d& move, double enough, Operations& operations) const noexcept;
  bool stops(const Side& side, const Eigen::Vector3d& move, double square,
             double enough) const noexcept;

  PlaneSet met_;
  Eigen::Vector3d at_{Eigen::Vector3d::Zero()};
  Skin skin_{};
  bool prepared_{false};  // what is below
  std::array<Side, kMost> sides_;
  std::array<std::array<Line, kMost>, kMost> lines_;  // [j][i], i < j
};

}  // namespace haptrial::contact
