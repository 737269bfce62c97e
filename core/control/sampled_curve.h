#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/base/big_array.h"
#include "core/control/curve_chords.h"

namespace haptrial::control {

/// A place on a sampled curve.
struct CurvePlace {
  std::size_t segment{0};  // between the points `segment` and `segment` + 1
  double t{0.0};           // 0 at the segment's first point, 1 at its second
  double arc{0.0};         // along the curve from its first point [m]
  double distance{0.0};    // of the point that was asked for [m]
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  // [m]
};

/// A stretch of a curve, both ends included [m].
struct ArcWindow {
  double low{0.0};
  double high{std::numeric_limits<double>::infinity()};
};

/// Which places of a curve a search is about.
struct CurveQuery {
  ArcWindow window;
  /// Segment to begin at. The answer depends on it only if several places are equally near; near
  /// the answer it saves most of the time.
  std::size_t from_segment{0};
  double below{std::numeric_limits<double>::infinity()};  // only places nearer than this [m]
  /// A stretch known to hold no place that is nearer than `below`: it need not be looked at.
  ArcWindow known{std::numeric_limits<double>::infinity(), 0.0};
  /// An answer may be farther than the nearest place by so much. Bounds the time where a long
  /// stretch is equally far, as it is from the centre of a circle >= 0 [m].
  double tolerance{0.0};
};

/// The polyline through sampled points, and the nearest point on it: exact over its segments.
///
/// Runs of eight segments lie side by side; over them stands a tree with eight children a node. A
/// node knows its chord and how far the curve strays from it, so that its distance is bounded from
/// below by (distance to the chord) - (stray), which for a smooth curve is far tighter than a box:
/// the stray falls with the square of the length. docs/algorithms/curve-constraints.md has the
/// figures. Points may repeat. Source: Morris 2006, §6.2.2, which looks among the N nearest points.
class SampledCurve {
 public:
  static constexpr double kMostCoordinate = 1e100;  // [m]

  /// @param points  (N x 3) [m], N >= 2, none beyond kMostCoordinate
  /// @throws std::invalid_argument otherwise.
  explicit SampledCurve(std::span<const Eigen::Vector3d> points);

  std::size_t size() const noexcept { return size_; }  // points
  double length() const noexcept { return arc(size_ - 1); }
  Eigen::Vector3d point(std::size_t i) const noexcept;
  double arc(std::size_t i) const noexcept { return strips_[i / kRun].arc[i % kRun]; }
  double arc_of(std::size_t segment, double t) const noexcept;

  /// The nearest place of the whole curve. Servo thread. A point that is not finite gives the
  /// curve's first place with a distance of infinity.
  CurvePlace nearest(const Eigen::Vector3d& point) const noexcept;

  /// The nearest place of those that `query` is about, if there is one. Servo thread.
  std::optional<CurvePlace> nearest(const Eigen::Vector3d& point,
                                    const CurveQuery& query) const noexcept;

  /// The place at an arc position, held at the ends; distance 0. Servo thread.
  CurvePlace at(double arc) const noexcept;

  /// The curve's direction at a place, unit length (zero where all points coincide). Where the
  /// place is a corner the direction turns with the point, so that it stays perpendicular to the
  /// line that joins them; at either end it is that of the last segment. Servo thread.
  Eigen::Vector3d tangent(const CurvePlace& place, const Eigen::Vector3d& point) const noexcept;

 private:
  using Strip = Chords;  // eight segments; the last strip is filled up with its last point
  using Pack = ChordPack;
  class Search;

  void fill_strips(std::span<const Eigen::Vector3d> points) noexcept;
  void fill_nodes(std::size_t level) noexcept;
  double stray_of(std::size_t level, std::size_t node, const Eigen::Vector3d& from,
                  const Eigen::Vector3d& chord) const noexcept;
  Eigen::Vector3d strip_boundary(std::size_t strip) const noexcept;
  double arc_at_boundary(std::size_t strip) const noexcept;
  CurvePlace place(std::size_t segment, double t) const noexcept;
  Eigen::Vector3d direction_after(double arc) const noexcept;
  Eigen::Vector3d direction_before(double arc) const noexcept;

  std::size_t size_;
  BigArray<Strip> strips_;
  std::vector<BigArray<Pack>> levels_;  // [0]: its nodes are strips; the last has one pack
};

}  // namespace haptrial::control
