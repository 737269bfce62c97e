#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptrial::deformable {

struct NearPoint {
  double square;        // of the distance [m²]
  std::int32_t number;  // of the point
  auto operator<=>(const NearPoint&) const = default;
};

/// A kd-tree: the n points nearest to a place, nearest first; of equally near ones that with the
/// lower number.
/// Source: Morris 2006, §5.4.2.
class NearestPoints {
 public:
  explicit NearestPoints(std::vector<Eigen::Vector3d> points);

  /// @param nearest  receives `count` points, or all where there are less
  void find(const Eigen::Vector3d& place, std::size_t count, std::vector<NearPoint>& nearest) const;

 private:
  void split(std::size_t first, std::size_t last, int axis);
  void search(const Eigen::Vector3d& place, std::size_t count, std::size_t first, std::size_t last,
              int axis, std::vector<NearPoint>& nearest) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<std::int32_t> order_;  // the middle of each range divides it along x, y, z in turns
};

}  // namespace haptrial::deformable
