#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace haptrial::evaluation {

/// The god object of a convex polygon, which remembers its place.
class ConvexProfile {
 public:
  /// @param corners  anticlockwise; the side i runs from corner i to the next. A polygon that is
  /// not closed has no side from the last to the first.
  ConvexProfile(std::vector<Eigen::Vector2d> corners, bool closed);

  /// The proxy for the next place of the tool; nothing in the air.
  std::optional<Eigen::Vector2d> next(const Eigen::Vector2d& tool);

 private:
  std::size_t sides() const { return closed_ ? corners_.size() : corners_.size() - 1; }
  const Eigen::Vector2d& corner(std::size_t i) const { return corners_[i % corners_.size()]; }
  Eigen::Vector2d along(std::size_t side) const;
  void enter(const Eigen::Vector2d& tool);
  Eigen::Vector2d slide(const Eigen::Vector2d& tool);

  std::vector<Eigen::Vector2d> corners_;
  bool closed_;
  std::optional<Eigen::Vector2d> last_;  // tool in the air
  std::optional<std::size_t> side_;      // that the proxy is on
};

ConvexProfile wedge_profile(double flank);
ConvexProfile plate_profile(double width, double thickness);

/// The god object of y = height sin(2π x / length).
class WavyProfile {
 public:
  WavyProfile(double height, double length);
  std::optional<Eigen::Vector2d> next(const Eigen::Vector2d& tool);

 private:
  double height(double x) const;
  double steepness(double x) const;
  double slide(double x, const Eigen::Vector2d& tool) const;

  double height_, wave_number_;
  std::optional<double> x_;  // of the proxy on the surface
};

}  // namespace haptrial::evaluation
