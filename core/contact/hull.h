#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/contact/contact_surface.h"

namespace haptrial::contact {

typedef double Two __attribute__((vector_size(16)));
typedef std::int64_t TwoInts __attribute__((vector_size(16)));

inline Two load_two(const double* from) noexcept {
  Two x;
  std::memcpy(&x, from, sizeof x);
  return x;
}

inline void store_two(double* to, Two x) noexcept { std::memcpy(to, &x, sizeof x); }

/// A triangle as the points x with
///
///     out_k · (x - origin) <= level_k
///
/// for both of its sides, across its three edges and, against the spikes that two of those make at
/// a sharp corner, across the ends of its longest edge. The levels are those of its corners as
/// computed, so that it lies inside whatever the rounding of the directions.
struct alignas(64) Hull {
  static constexpr int kPlanes = 8;  // the last, and those of edges without length, hold nothing
  static constexpr int kFaces = 2;   // the first: both sides

  std::array<double, kPlanes> x, y, z;  // out: unit vectors or zero
  std::array<double, kPlanes> level;    // [m]
  Eigen::Vector3d origin;               // the first corner [m]
  std::int32_t slot{-1};
  /// Whether the corners leave no doubt about the normal and what is beside the edges.
  bool plump{false};

  Eigen::Vector3d out(int k) const noexcept { return {x[k], y[k], z[k]}; }
  void wrap(const ContactSurface& surface, std::int32_t of) noexcept {
    wrap(surface.corners(of), surface.normal(of), of);
  }
  /// @param normal  a unit vector, or zero for a point
  void wrap(const geometry::Corners& corners, const Eigen::Vector3d& normal,
            std::int32_t of) noexcept;

  /// Distance by which a plane is moved out for a skin of the thickness h [m].
  static constexpr double wider(int k, double h) noexcept { return k < kFaces ? h : 0.5 * h; }

  /// How high a point is above each plane, and how a move changes that.
  struct Heights {
    std::array<double, kPlanes> at, gain;  // [m]
  };
  Heights heights(const Eigen::Vector3d& from, const Eigen::Vector3d& move) const noexcept {
    const Eigen::Vector3d d = from - origin;
    Heights heights;
    for (int k = 0; k < kPlanes; k += 2) {
      const Two a = load_two(&x[k]), b = load_two(&y[k]), c = load_two(&z[k]);
      store_two(&heights.at[k], a * d.x() + b * d.y() + c * d.z() - load_two(&level[k]));
      store_two(&heights.gain[k], a * move.x() + b * move.y() + c * move.z());
    }
    return heights;
  }
  /// Whether one plane keeps a whole move farther away than what faces and other planes ask for.
  static bool parted(const Heights& heights, double off_faces, double off_edges) noexcept {
    TwoInts parted{0, 0};
    for (int k = 0; k < kPlanes; k += 2) {
      const double off = k < kFaces ? off_faces : off_edges;
      const Two at = load_two(&heights.at[k]);
      parted |= (at > off) & (at + load_two(&heights.gain[k]) > off);
    }
    return (parted[0] | parted[1]) != 0;
  }
  /// The direction of the plane that keeps a move farthest away.
  Eigen::Vector3d farthest(const Heights& heights) const noexcept;
};

/// The hulls of the triangles that were asked for last.
class Hulls {
 public:
  explicit Hulls(const ContactSurface& surface) : surface_(&surface), hulls_(kMost) {}

  const Hull& of(std::int32_t slot) noexcept {
    Hull& hull = hulls_[static_cast<std::size_t>(slot) % kMost];
    if (hull.slot != slot) {
      hull.wrap(*surface_, slot);
    }
    return hull;
  }

 private:
  static constexpr std::size_t kMost = 256;
  const ContactSurface* surface_;
  std::vector<Hull> hulls_;
};

}  // namespace haptrial::contact
