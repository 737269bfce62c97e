#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/geometry/mesh/closest_point.h"
#include "core/geometry/mesh/mesh.h"
#include "core/geometry/mesh/mesh_size.h"
#include "core/geometry/mesh/predicates.h"

namespace haptrial::contact {

/// Whether two segments of a plane meet, decided without rounding.
inline bool segments_meet(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                          const Eigen::Vector2d& c, const Eigen::Vector2d& d) {
  using geometry::side_of_line;
  const int ac = side_of_line(a, b, c), ad = side_of_line(a, b, d);
  const int ca = side_of_line(c, d, a), cb = side_of_line(c, d, b);
  const bool boxes = (a.cwiseMin(b).array() <= c.cwiseMax(d).array()).all() &&
                     (c.cwiseMin(d).array() <= a.cwiseMax(b).array()).all();
  return boxes && ac * ad <= 0 && ca * cb <= 0;
}

/// The same for a segment in the plane of a triangle: they meet if they do along every axis, as one
/// of the three views is not edge-on.
inline bool meets_in_plane(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                           const geometry::Corners& t) {
  const auto meets_seen_along = [&](int axis) {
    const auto flat = [&](const Eigen::Vector3d& x) {
      return Eigen::Vector2d(x[(axis + 1) % 3], x[(axis + 2) % 3]);
    };
    int left = 0, right = 0;
    for (int k = 0; k < 3; ++k) {
      if (segments_meet(flat(p), flat(q), flat(t[k]), flat(t[(k + 1) % 3]))) {
        return true;
      }
      const int side = geometry::side_of_line(flat(t[k]), flat(t[(k + 1) % 3]), flat(p));
      left += side > 0;
      right += side < 0;
    }
    return left == 3 || right == 3;
  };
  return meets_seen_along(0) && meets_seen_along(1) && meets_seen_along(2);
}

/// Whether a segment meets a triangle, its sides and corners included, decided without rounding.
/// Triangles without area are met by nothing: their neighbours close the surface.
inline bool segment_meets_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                                   const geometry::Corners& t) {
  using geometry::side_of_plane;
  const int at_p = side_of_plane(t[0], t[1], t[2], p), at_q = side_of_plane(t[0], t[1], t[2], q);
  if (at_p * at_q > 0) {
    return false;
  }
  if (at_p == 0 && at_q == 0) {
    const Eigen::Vector3d away = p + Eigen::Vector3d(1.0, 0.7, 0.3) * (p.norm() + 1.0);
    const Eigen::Vector3d aside = p + Eigen::Vector3d(-0.2, 0.5, 1.1) * (p.norm() + 1.0);
    const bool has_area =
        side_of_plane(t[0], t[1], t[2], away) != 0 || side_of_plane(t[0], t[1], t[2], aside) != 0;
    return has_area && meets_in_plane(p, q, t);
  }
  int left = 0, right = 0;
  for (int k = 0; k < 3; ++k) {
    const int side = side_of_plane(p, q, t[k], t[(k + 1) % 3]);
    left += side > 0;
    right += side < 0;
  }
  return left == 0 || right == 0;
}

/// Whether a closed mesh holds a point, decided without rounding: by the parity of the triangles
/// that a segment to a far point crosses, one that meets no edge and no corner.
inline bool holds(const geometry::Mesh& mesh, const Eigen::Vector3d& p) {
  using geometry::side_of_plane;
  const Eigen::AlignedBox3d box = geometry::bounds(mesh);
  for (int attempt = 0;; ++attempt) {
    const Eigen::Vector3d aside(std::sin(1.0 + attempt), std::sin(2.0 + 1.7 * attempt), 4.0);
    const Eigen::Vector3d q = box.center() + box.sizes().maxCoeff() * aside;
    bool inside = false, clear = true;
    for (std::size_t i = 0; i < mesh.triangles.size() && clear; ++i) {
      const geometry::Triangle& c = mesh.triangles[i];
      const Eigen::Vector3d t[3] = {mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]};
      const int at_p = side_of_plane(t[0], t[1], t[2], p);
      const int at_q = side_of_plane(t[0], t[1], t[2], q);
      if (at_p == at_q) {
        continue;  // beside it, or it has no area
      }
      int left = 0, right = 0;
      for (int k = 0; k < 3; ++k) {
        const int side = side_of_plane(p, q, t[k], t[(k + 1) % 3]);
        left += side >= 0;
        right += side <= 0;
      }
      const bool meets = left == 3 || right == 3;
      clear = !meets || (left + right == 3 && at_p * at_q != 0);
      inside ^= meets;
    }
    if (clear) {
      return inside;
    }
  }
}

/// Finds the triangle of a mesh that a segment meets, by a grid of cells of its own.
class ExactCrossing {
 public:
  explicit ExactCrossing(const geometry::Mesh& mesh) : mesh_(mesh), box_(geometry::bounds(mesh)) {
    const double size = std::max(box_.sizes().maxCoeff(), 1e-300);
    const double wanted = std::cbrt(2.0 * static_cast<double>(mesh.triangles.size())) + 1.0;
    cell_ = size / wanted;
    for (int axis = 0; axis < 3; ++axis) {
      count_[axis] = static_cast<int>(box_.sizes()[axis] / cell_) + 1;
    }
    cells_.resize(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      Eigen::AlignedBox3d box;
      for (const std::int32_t k : mesh.triangles[i]) {
        box.extend(mesh.vertices[k]);
      }
      each_cell(box, [&](std::vector<std::int32_t>& cell) {
        cell.push_back(static_cast<std::int32_t>(i));
        return false;
      });
    }
  }

  /// @returns the number of a triangle that is met; -1: none.
  std::int32_t operator()(const Eigen::Vector3d& p, const Eigen::Vector3d& q) const {
    const int parts = 1 + static_cast<int>(std::min((q - p).norm() / cell_, 1000.0));
    std::int32_t found = -1;
    for (int i = 0; i < parts && found < 0; ++i) {
      Eigen::AlignedBox3d box(Eigen::Vector3d(p + (q - p) * i / parts));
      box.extend(p + (q - p) * (i + 1) / parts);
      each_cell(box, [&](const std::vector<std::int32_t>& cell) {
        for (const std::int32_t t : cell) {
          const geometry::Triangle& c = mesh_.triangles[t];
          if (segment_meets_triangle(
                  p, q, {mesh_.vertices[c[0]], mesh_.vertices[c[1]], mesh_.vertices[c[2]]})) {
            found = t;
            return true;
          }
        }
        return false;
      });
    }
    return found;
  }

 private:
  /// Cells that a box meets, and a hundredth of a cell around it for what rounding may leave out.
  template <class Visit>
  void each_cell(const Eigen::AlignedBox3d& box, Visit visit) const {
    int low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = [&](double x) {
        return static_cast<int>(
            std::clamp(std::floor((x - box_.min()[axis]) / cell_), -1.0, count_[axis] + 1.0));
      };
      low[axis] = std::max(at(box.min()[axis] - 0.01 * cell_), 0);
      high[axis] = std::min(at(box.max()[axis] + 0.01 * cell_), count_[axis] - 1);
    }
    for (int z = low[2]; z <= high[2]; ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[0]; x <= high[0]; ++x) {
          if (visit(cells_[(static_cast<std::size_t>(z) * count_[1] + y) * count_[0] + x])) {
            return;
          }
        }
      }
    }
  }

  const geometry::Mesh& mesh_;
  Eigen::AlignedBox3d box_;
  double cell_{1.0};
  int count_[3];
  mutable std::vector<std::vector<std::int32_t>> cells_;
};

}  // namespace haptrial::contact
