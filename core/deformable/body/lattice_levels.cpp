#include "core/deformable/body/lattice_levels.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptrial::deformable {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kOffLattice = 1e-6;  // of the spacing

/// Points of a box in the order of z, y, x, and the number of each that is there.
class LatticeNumbers {
 public:
  explicit LatticeNumbers(const LatticePoint& size) : size_(size) {
    number_.assign(static_cast<std::size_t>(size[0] + 2) * static_cast<std::size_t>(size[1] + 2) *
                       static_cast<std::size_t>(size[2] + 2),
                   -1);
  }
  /// @param p  from -1 to the size
  std::int32_t& operator()(const LatticePoint& p) {
    const auto row = static_cast<std::size_t>(p[2] + 1) * static_cast<std::size_t>(size_[1] + 2) +
                     static_cast<std::size_t>(p[1] + 1);
    return number_[row * static_cast<std::size_t>(size_[0] + 2) +
                   static_cast<std::size_t>(p[0] + 1)];
  }

  /// Numbers the points of this size that the body has, and lists them.
  std::vector<LatticePoint> count(const LatticePoint& size) {
    std::vector<LatticePoint> points;
    for (std::int32_t k = 0; k < size[2]; ++k) {
      for (std::int32_t j = 0; j < size[1]; ++j) {
        for (std::int32_t i = 0; i < size[0]; ++i) {
          if (std::int32_t& n = (*this)({i, j, k}); n >= 0) {
            n = static_cast<std::int32_t>(points.size());
            points.push_back({i, j, k});
          }
        }
      }
    }
    return points;
  }

 private:
  LatticePoint size_;
  std::vector<std::int32_t> number_;
};

LatticePoint size_of(std::span<const LatticePoint> points) {
  LatticePoint size{0, 0, 0};
  for (const LatticePoint& p : points) {
    for (std::size_t a = 0; a < 3; ++a) {
      size[a] = std::max(size[a], p[a] + 1);
    }
  }
  return size;
}

/// Calls function(parent, weight) for the coarse points around a fine one.
template <class Function>
void for_parents(const LatticePoint& fine, Function&& function) {
  LatticePoint low{}, high{};
  double weight = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = fine[a] / 2;
    high[a] = (fine[a] + 1) / 2;
    weight *= low[a] == high[a] ? 1 : 0.5;
  }
  for (std::int32_t k = low[2]; k <= high[2]; ++k) {
    for (std::int32_t j = low[1]; j <= high[1]; ++j) {
      for (std::int32_t i = low[0]; i <= high[0]; ++i) {
        function(LatticePoint{i, j, k}, weight);
      }
    }
  }
}

constexpr int kSlots = 14;  // a point and half of its 26 neighbours

LatticePoint at_slot(const LatticePoint& from, int slot) {
  const int code = slot + kSlots - 1;  // 0 .. 26
  return {from[0] + code % 3 - 1, from[1] + code / 3 % 3 - 1, from[2] + code / 9 - 1};
}

/// Slot of a neighbour, from 0 for the same point to 13 for one more along each axis; below 0: a
/// point before.
int slot_of(const LatticePoint& from, const LatticePoint& to) {
  return 9 * (to[2] - from[2]) + 3 * (to[1] - from[1]) + to[0] - from[0];
}

}  // namespace

std::optional<std::vector<LatticePoint>> lattice_points(std::span<const Vector3d> vertices,
                                                        const BlockMatrix& pattern) {
  Vector3d low = vertices[0];
  double spacing = 1e300;
  for (std::size_t row = 0; row < pattern.rows(); ++row) {
    low = low.cwiseMin(vertices[row]);
    for (auto at = pattern.row_start(row) + 1; at < pattern.row_start(row + 1); ++at) {
      const auto other = static_cast<std::size_t>(pattern.column(at));
      spacing = std::min(spacing, (vertices[row] - vertices[other]).norm());
    }
  }
  std::vector<LatticePoint> points(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    for (int a = 0; a < 3; ++a) {
      const double steps = (vertices[v][a] - low[a]) / spacing;
      const double whole = std::round(steps);
      if (std::abs(steps - whole) > kOffLattice * std::max(1.0, whole) || whole > 1e6) {
        return {};
      }
      points[v][static_cast<std::size_t>(a)] = static_cast<std::int32_t>(whole);
    }
  }
  for (std::size_t row = 0; row < pattern.rows(); ++row) {
    for (auto at = pattern.row_start(row) + 1; at < pattern.row_start(row + 1); ++at) {
      const LatticePoint& other = points[static_cast<std::size_t>(pattern.column(at))];
      for (std::size_t a = 0; a < 3; ++a) {
        if (std::abs(points[row][a] - other[a]) > 1) {
          return {};
        }
      }
    }
  }
  return points;
}

CoarseLattice::CoarseLattice(std::span<const LatticePoint> fine,
                             std::span<const std::uint8_t> left_out)
    : matrix_(std::vector<std::int32_t>{0}, {}) {
  LatticePoint size = size_of(fine);
  for (std::int32_t& s : size) {
    s = s / 2 + 1;
  }
  LatticeNumbers number(size);
  const auto skipped = [&](std::size_t i) { return !left_out.empty() && left_out[i] != 0; };
  for (std::size_t i = 0; i < fine.size(); ++i) {
    if (!skipped(i)) {
      for_parents(fine[i], [&](const LatticePoint& p, double) { number(p) = 0; });
    }
  }
  points_ = number.count(size);
  first_parent_.push_back(0);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    if (!skipped(i)) {
      for_parents(fine[i], [&](const LatticePoint& p, double weight) {
        parents_.push_back({number(p), weight});
      });
    }
    first_parent_.push_back(static_cast<std::int32_t>(parents_.size()));
  }
  std::vector<std::int32_t> start{0};
  std::vector<std::int32_t> column;
  for (const LatticePoint& p : points_) {
    place_.emplace_back();
    for (int slot = 0; slot < kSlots; ++slot) {
      const std::int32_t n = number(at_slot(p, slot));
      place_.back()[static_cast<std::size_t>(slot)] =
          n < 0 ? -1 : static_cast<std::int32_t>(column.size());
      if (n >= 0) {
        column.push_back(n);
      }
    }
    start.push_back(static_cast<std::int32_t>(column.size()));
  }
  matrix_ = BlockMatrix(std::move(start), std::move(column));
}

std::span<const CoarseLattice::Parent> CoarseLattice::parents(std::size_t fine) const {
  return std::span(parents_).subspan(
      static_cast<std::size_t>(first_parent_[fine]),
      static_cast<std::size_t>(first_parent_[fine + 1] - first_parent_[fine]));
}

void CoarseLattice::project(const BlockMatrix& a) {
  matrix_.set_zero();
  const auto add = [&](std::int32_t from, int slot, double weight, const Matrix3d& block) {
    const std::int32_t place =
        place_[static_cast<std::size_t>(from)][static_cast<std::size_t>(slot)];
    Eigen::Map<Matrix3d>(matrix_.block(place)) += weight * block;
  };
  for (std::size_t row = 0; row < a.rows(); ++row) {
    const auto left = parents(row);
    if (left.empty()) {
      continue;
    }
    for (auto at = a.row_start(row); at < a.row_start(row + 1); ++at) {
      const bool diagonal = at == a.row_start(row);
      const auto right = diagonal ? left : parents(static_cast<std::size_t>(a.column(at)));
      const Matrix3d block = Eigen::Map<const Matrix3d>(a.block(at));
      const Matrix3d turned = block.transpose();
      const Matrix3d both = block + turned;
      for (const Parent& i : left) {
        const LatticePoint& from = points_[static_cast<std::size_t>(i.point)];
        for (const Parent& j : right) {
          const int slot = slot_of(from, points_[static_cast<std::size_t>(j.point)]);
          const double weight = i.weight * j.weight;
          if (slot == 0) {
            add(i.point, 0, weight, diagonal ? block : both);
          } else if (slot > 0) {
            add(i.point, slot, weight, block);
          } else if (!diagonal) {
            add(j.point, -slot, weight, turned);
          }
        }
      }
    }
  }
}

void CoarseLattice::restrict_to_coarse(const Vectors& from, Vectors& to) const {
  to.assign(points_.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < from.size(); ++i) {
    for (const Parent& p : parents(i)) {
      to[static_cast<std::size_t>(p.point)] += p.weight * from[i];
    }
  }
}

void CoarseLattice::add_to_fine(const Vectors& from, Vectors& to) const {
  for (std::size_t i = 0; i < to.size(); ++i) {
    for (const Parent& p : parents(i)) {
      to[i] += p.weight * from[static_cast<std::size_t>(p.point)];
    }
  }
}

}  // namespace haptrial::deformable
