#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <vector>

namespace haptrial::geometry {

/// Numbers points in the order in which they first come; points with equal coordinates (0 and -0
/// are equal) have one number. Inside core/geometry only.
class PointIndex {
 public:
  explicit PointIndex(std::size_t expected = 0) { rehash(std::bit_ceil(2 * expected + 16)); }

  std::int32_t number(const Eigen::Vector3d& point) {
    if (2 * (points_.size() + 1) > slots_.size()) {
      rehash(2 * slots_.size());
    }
    std::int32_t& slot = find(point);
    if (slot < 0) {
      slot = static_cast<std::int32_t>(points_.size());
      points_.push_back(point);
    }
    return slot;
  }

  std::vector<Eigen::Vector3d> take() && { return std::move(points_); }
  std::size_t size() const { return points_.size(); }

 private:
  static std::uint64_t hash(const Eigen::Vector3d& point) {
    std::uint64_t mixed = 0;
    for (int axis = 0; axis < 3; ++axis) {
      mixed ^= std::bit_cast<std::uint64_t>(point[axis] + 0.0);  // -0 + 0 is 0
      mixed *= 0x9E3779B97F4A7C15u;
      mixed ^= mixed >> 32;
    }
    return mixed;
  }

  std::int32_t& find(const Eigen::Vector3d& point) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = hash(point) & mask;
    while (slots_[at] >= 0 && points_[slots_[at]] != point) {
      at = (at + 1) & mask;
    }
    return slots_[at];
  }

  void rehash(std::size_t slots) {
    slots_.assign(slots, -1);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      find(points_[i]) = static_cast<std::int32_t>(i);
    }
  }

  std::vector<Eigen::Vector3d> points_;
  std::vector<std::int32_t> slots_;
};

}  // namespace haptrial::geometry
