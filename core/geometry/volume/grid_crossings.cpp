#include "core/geometry/volume/grid_crossings.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/mesh/predicates.h"

namespace haptrial::geometry {
namespace {

int sign_of(double value) { return (value > 0.0) - (value < 0.0); }

/// The centres along an axis that may lie between two coordinates.
struct Span {
  std::int32_t first;
  std::int32_t last;  // less than first: none
};

Span centres_between(const VoxelGrid& grid, int axis, double low, double high) {
  constexpr double kRounding = 0.01;  // of a voxel: see make_grid
  const double most = grid.size[axis] - 1.0;
  const double first = std::ceil((low - grid.origin[axis]) / grid.spacing - kRounding);
  const double last = std::floor((high - grid.origin[axis]) / grid.spacing + kRounding);
  return {static_cast<std::int32_t>(std::clamp(first, 0.0, most + 1.0)),
          static_cast<std::int32_t>(std::clamp(last, -1.0, most))};
}

/// One triangle against the lines along one axis.
class Crosser {
 public:
  Crosser(const VoxelGrid& grid, int axis, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
          const Eigen::Vector3d& c)
      : grid_(grid), axis_(axis), u_((axis + 1) % 3), v_((axis + 2) % 3), corners_{&a, &b, &c} {
    for (int i = 0; i < 3; ++i) {
      flat_[i] = {(*corners_[i])[u_], (*corners_[i])[v_]};
    }
  }

  /// Calls take(line, before, leaving) for every line that crosses the triangle.
  template <class Take>
  void run(const Take& take) {
    const auto [low_u, high_u] = std::minmax({flat_[0].x(), flat_[1].x(), flat_[2].x()});
    const auto [low_v, high_v] = std::minmax({flat_[0].y(), flat_[1].y(), flat_[2].y()});
    const Span us = centres_between(grid_, u_, low_u, high_u);
    const Span vs = centres_between(grid_, v_, low_v, high_v);
    if (us.first > us.last || vs.first > vs.last) {
      return;
    }
    facing_ = side_of_line(flat_[0], flat_[1], flat_[2]);
    if (facing_ == 0) {
      return;  // no line that is shifted ever meets it
    }
    for (std::int32_t v = vs.first; v <= vs.last; ++v) {
      for (std::int32_t u = us.first; u <= us.last; ++u) {
        const Eigen::Vector2d point(grid_.coordinate(u_, u), grid_.coordinate(v_, v));
        if (holds(point)) {
          const auto line =
              static_cast<std::uint32_t>(u) +
              static_cast<std::uint32_t>(grid_.size[u_]) * static_cast<std::uint32_t>(v);
          take(line, before(point), facing_);
        }
      }
    }
  }

 private:
  bool holds(const Eigen::Vector2d& point) const {
    return shifted_side(flat_[0], flat_[1], point) == facing_ &&
           shifted_side(flat_[1], flat_[2], point) == facing_ &&
           shifted_side(flat_[2], flat_[0], point) == facing_;
  }

  /// side_of_line() of the shifted point: where it is 0, the shift along the earlier axis decides,
  /// then that along the later one.
  int shifted_side(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                   const Eigen::Vector2d& point) const {
    const int side = side_of_line(a, b, point);
    if (side != 0) {
      return side;
    }
    const int by_u = sign_of(a.y() - b.y());
    const int by_v = sign_of(b.x() - a.x());
    const int first = u_ < v_ ? by_u : by_v;
    return first != 0 ? first : u_ < v_ ? by_v : by_u;
  }

  std::int32_t before(const Eigen::Vector2d& point) const {
    const double guess = (height_at(point) - grid_.origin[axis_]) / grid_.spacing;
    const double most = grid_.size[axis_];
    auto count = static_cast<std::int32_t>(std::clamp(std::ceil(guess), 0.0, most));
    while (count < grid_.size[axis_] && is_before(point, count)) {
      ++count;
    }
    while (count > 0 && !is_before(point, count - 1)) {
      --count;
    }
    return count;
  }

  /// Height at which the line meets the triangle's plane, to rounding; within the triangle's own
  /// range.
  double height_at(const Eigen::Vector2d& point) const {
    const auto weight = [&](int i, int j) {
      const Eigen::Vector2d a = flat_[i] - point;
      const Eigen::Vector2d b = flat_[j] - point;
      return a.x() * b.y() - a.y() * b.x();
    };
    const std::array<double, 3> weights{weight(1, 2), weight(2, 0), weight(0, 1)};
    const auto height = [&](int i) { return (*corners_[i])[axis_]; };
    const auto [low, high] = std::minmax({height(0), height(1), height(2)});
    const double sum = weights[0] + weights[1] + weights[2];
    const double found =
        (weights[0] * height(0) + weights[1] * height(1) + weights[2] * height(2)) / sum;
    return found > low ? std::min(found, high) : low;  // also where it is not a number
  }

  bool is_before(const Eigen::Vector2d& point, std::int32_t number) const {
    Eigen::Vector3d centre;
    centre[axis_] = grid_.coordinate(axis_, number);
    centre[u_] = point.x();
    centre[v_] = point.y();
    const int side = side_of_plane(*corners_[0], *corners_[1], *corners_[2], centre);
    return (side != 0 ? side : normal_sign()) == -facing_;
  }

  /// The sign of the normal's first part that is not 0: on which side a shifted point is.
  int normal_sign() const {
    for (int part = 0; part < 3; ++part) {
      const auto flat = [&](int i) {
        return Eigen::Vector2d((*corners_[i])[(part + 1) % 3], (*corners_[i])[(part + 2) % 3]);
      };
      if (const int sign = side_of_line(flat(0), flat(1), flat(2)); sign != 0) {
        return sign;
      }
    }
    return 0;
  }

  const VoxelGrid& grid_;
  int axis_;
  int u_;
  int v_;
  std::array<const Eigen::Vector3d*, 3> corners_;
  std::array<Eigen::Vector2d, 3> flat_;
  int facing_{0};  // 1: the normal looks along the axis
};

}  // namespace

GridCrossings::GridCrossings(const Mesh& mesh, const VoxelGrid& grid, int axis,
                             const WorkReport& report) {
  constexpr std::size_t kBetweenReports = 1 << 14;
  std::vector<Crossing> found;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t % kBetweenReports == 0) {
      report_share(report, static_cast<double>(t) / static_cast<double>(mesh.triangles.size()));
    }
    const Triangle& corners = mesh.triangles[t];
    Crosser(grid, axis, mesh.vertices[corners[0]], mesh.vertices[corners[1]],
            mesh.vertices[corners[2]])
        .run([&](std::uint32_t line, std::int32_t before, std::int32_t leaving) {
          found.push_back({line, before, leaving});
        });
  }
  const std::size_t lines = static_cast<std::size_t>(grid.size[(axis + 1) % 3]) *
                            static_cast<std::size_t>(grid.size[(axis + 2) % 3]);
  std::vector<std::uint64_t> place(lines + 2, 0);
  for (const Crossing& crossing : found) {
    ++place[crossing.line + 2];
  }
  for (std::size_t i = 2; i < place.size(); ++i) {
    place[i] += place[i - 1];
  }
  crossings_.resize(found.size());
  for (const Crossing& crossing : found) {
    crossings_[place[crossing.line + 1]++] = crossing;
  }
  place.pop_back();
  begin_ = std::move(place);
  for (std::size_t line = 0; line < lines; ++line) {
    std::sort(crossings_.begin() + static_cast<std::ptrdiff_t>(begin_[line]),
              crossings_.begin() + static_cast<std::ptrdiff_t>(begin_[line + 1]),
              [](const Crossing& a, const Crossing& b) { return a.before < b.before; });
  }
}

double crossing_memory(const Mesh& mesh, const VoxelGrid& grid) {
  double most = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    double crossings = 0.0;
    for (const Triangle& t : mesh.triangles) {
      const Eigen::Vector3d& a = mesh.vertices[t[0]];
      const Eigen::Vector3d& b = mesh.vertices[t[1]];
      const Eigen::Vector3d& c = mesh.vertices[t[2]];
      const Eigen::Array3d low = a.cwiseMin(b).cwiseMin(c);
      const Eigen::Array3d high = a.cwiseMax(b).cwiseMax(c);
      const Span us = centres_between(grid, u, low[u], high[u]);
      const Span vs = centres_between(grid, v, low[v], high[v]);
      crossings +=
          std::max(0.0, us.last - us.first + 1.0) * std::max(0.0, vs.last - vs.first + 1.0);
    }
    const double lines = static_cast<double>(grid.size[u]) * grid.size[v];
    // A growing vector may have twice its size, and the sorted copy lives beside it.
    most = std::max(most, 3.0 * sizeof(Crossing) * crossings + 2.0 * sizeof(std::uint64_t) * lines);
  }
  return most;
}

}  // namespace haptrial::geometry
