#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/mesh/mesh.h"

namespace haptrial::geometry::reading {

/// Cuts faces with more than three corners into triangles that look the same way as their face:
/// a fan from the first corner if that does, else ears (Meisters 1975). Faces are seen along the
/// axis to which their normal (Newell) is nearest. A fold thinner than a millionth of the largest
/// coordinate and a thousandth of the face is rounding and stays a fan. One between the two becomes
/// ears, or a fan where it crosses itself.
class FaceCutter {
 public:
  static constexpr std::size_t kMostConcaveCorners = 10'000;  // ears take the square of it

  /// @param corners    n of them > 3, indices of `vertices`
  /// @param triangles  n - 2, replaced
  /// @returns why the face cannot be cut; empty if it is.
  const char* cut(const std::vector<Eigen::Vector3d>& vertices,
                  std::span<const std::int32_t> corners, std::span<Triangle> triangles);

 private:
  void project(const std::vector<Eigen::Vector3d>& vertices, std::span<const std::int32_t> corners);
  /// @param rounding  area of folds that are none
  bool fan_fits(double rounding) const;
  bool is_ear(std::size_t corner) const;
  /// @returns whether all of the face became ears.
  bool clip_ears(std::span<const std::int32_t> corners, std::span<Triangle> triangles);

  std::vector<Eigen::Vector2d> points_;  // corners, anticlockwise
  std::vector<std::size_t> next_;        // of the corners that are left
  std::vector<std::size_t> previous_;
  double rounding_{0.0};       // area that rounding makes of nothing
  double most_rounding_{0.0};  // the same by the coordinates alone, however small the face
};

}  // namespace haptrial::geometry::reading
