#include "core/deformable/touch/condense.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

namespace haptrial::deformable {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;

namespace {

constexpr std::size_t kLeaf = 48;  // vertices that are eliminated at once

std::size_t to_size(std::int32_t i) { return static_cast<std::size_t>(i); }

/// A stiffness of a few vertices: its lower half.
struct Front {
  std::vector<std::int32_t> vertices;
  MatrixXd stiffness;
};

/// Subtracts aᵀ a from the lower half. Eigen's product divides by the number of rows, and there are
/// none where nothing lies between the vertices that are kept, as in a body one cell thick.
void subtract_square(const MatrixXd& a, MatrixXd& lower) {
  if (a.rows() > 0) {
    lower.selfadjointView<Eigen::Lower>().rankUpdate(a.transpose(), -1.0);
  }
}

class Condenser {
 public:
  Condenser(const BlockMatrix& k, std::span<const Vector3d> at, std::span<const std::uint8_t> held)
      : k_(k), at_(at), place_(k.rows(), -1), gone_(k.rows(), 0), next_(k.rows()) {
    for (std::size_t row = 0; row < k.rows(); ++row) {
      for (auto block = k.row_start(row); block < k.row_start(row + 1); ++block) {
        const std::int32_t column = k.column(block);
        if (held[row] != 0 || held[to_size(column)] != 0) {
          continue;
        }
        next_[row].push_back({column, block, false});
        if (std::cmp_not_equal(column, row)) {
          next_[to_size(column)].push_back({static_cast<std::int32_t>(row), block, true});
        }
      }
    }
  }

  /// Front that remains for the vertices around `inner` after eliminating those.
  Front without(std::vector<std::int32_t> inner) {
    std::vector<Front> halves;
    if (inner.size() > kLeaf) {
      auto [low, high] = split(inner);
      if (!low.empty()) {
        halves.push_back(without(std::move(low)));
      }
      if (!high.empty()) {
        halves.push_back(without(std::move(high)));
      }
    }
    return eliminated(inner, halves);
  }

  /// Adds the blocks of `rows` with all vertices that have a place, once each.
  /// @param rows  whose places follow each other
  void add_blocks(std::span<const std::int32_t> rows, MatrixXd& to) const {
    for (const std::int32_t row : rows) {
      for (const Neighbour& next : next_[to_size(row)]) {
        const std::int32_t i = place_[to_size(row)];
        const std::int32_t j = place_[to_size(next.vertex)];
        const bool by_other = next.vertex < row && is_of(rows, next.vertex);
        if (j < 0 || by_other) {
          continue;
        }
        const Eigen::Map<const Eigen::Matrix3d> block(k_.block(next.block));
        // block is (row of the matrix, column): with `turned`, row and next change their parts
        const bool below = i >= j;  // the block (i, j) of the lower half
        const bool transposed = below == next.turned;
        to.block<3, 3>(3 * Index{std::max(i, j)}, 3 * Index{std::min(i, j)}) +=
            transposed ? Eigen::Matrix3d(block.transpose()) : Eigen::Matrix3d(block);
      }
    }
  }

  void place(std::span<const std::int32_t> vertices) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      place_[to_size(vertices[i])] = static_cast<std::int32_t>(i);
    }
  }
  void forget(std::span<const std::int32_t> vertices) {
    for (const std::int32_t v : vertices) {
      place_[to_size(v)] = -1;
    }
  }
  void scatter(const Front& part, MatrixXd& to) const {
    for (std::size_t a = 0; a < part.vertices.size(); ++a) {
      const Index i = place_[to_size(part.vertices[a])];
      for (std::size_t b = 0; b <= a; ++b) {
        const Index j = place_[to_size(part.vertices[b])];
        const auto block =
            part.stiffness.block<3, 3>(3 * static_cast<Index>(a), 3 * static_cast<Index>(b));
        if (i > j) {
          to.block<3, 3>(3 * i, 3 * j) += block;
        } else if (i < j) {
          to.block<3, 3>(3 * j, 3 * i) += block.transpose();
        } else {
          to.block<3, 3>(3 * i, 3 * j).triangularView<Eigen::Lower>() += block;
        }
      }
    }
  }

 private:
  struct Neighbour {
    std::int32_t vertex;
    std::int32_t block;
    bool turned;  // the block belongs to the other's row
  };

  /// Whether a vertex is one of `rows`, whose places follow each other.
  bool is_of(std::span<const std::int32_t> rows, std::int32_t vertex) const {
    const std::int32_t at = place_[to_size(vertex)] - place_[to_size(rows.front())];
    return at >= 0 && to_size(at) < rows.size() && rows[to_size(at)] == vertex;
  }

  /// Parts on both sides of a plane; `inner` keeps what lies between them.
  std::pair<std::vector<std::int32_t>, std::vector<std::int32_t>> split(
      std::vector<std::int32_t>& inner) {
    Eigen::AlignedBox3d box;
    for (const std::int32_t v : inner) {
      box.extend(at_[to_size(v)]);
    }
    Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const auto middle = inner.begin() + static_cast<std::ptrdiff_t>(inner.size() / 2);
    std::nth_element(inner.begin(), middle, inner.end(), [&](std::int32_t a, std::int32_t b) {
      const double x = at_[to_size(a)][axis];
      const double y = at_[to_size(b)][axis];
      return x != y ? x < y : a < b;
    });
    const double plane = at_[to_size(*middle)][axis];
    // A lattice has a layer at the plane: low is before it, high from it on; what of high touches
    // low is what lies between.
    std::vector<std::int32_t> low, high, between;
    for (const std::int32_t v : inner) {
      (at_[to_size(v)][axis] < plane ? low : high).push_back(v);
    }
    std::sort(low.begin(), low.end());
    std::vector<std::int32_t> far;
    for (const std::int32_t v : high) {
      const bool touches = std::ranges::any_of(next_[to_size(v)], [&](const Neighbour& next) {
        return std::binary_search(low.begin(), low.end(), next.vertex);
      });
      (touches ? between : far).push_back(v);
    }
    if (low.empty() || far.empty()) {  // no plane divides them
      return {};
    }
    inner = std::move(between);
    return {std::move(low), std::move(far)};
  }

  Front eliminated(const std::vector<std::int32_t>& inner, const std::vector<Front>& halves) {
    std::vector<std::int32_t> all = inner;
    place(all);
    const auto take = [&](std::int32_t v) {
      if (place_[to_size(v)] < 0) {
        place_[to_size(v)] = static_cast<std::int32_t>(all.size());
        all.push_back(v);
      }
    };
    for (const std::int32_t v : inner) {
      for (const Neighbour& next : next_[to_size(v)]) {
        if (gone_[to_size(next.vertex)] == 0) {
          take(next.vertex);
        }
      }
    }
    for (const Front& half : halves) {
      std::ranges::for_each(half.vertices, take);
    }
    const auto size = 3 * static_cast<Index>(all.size());
    const auto own = 3 * static_cast<Index>(inner.size());
    MatrixXd whole = MatrixXd::Zero(size, size);
    add_blocks(inner, whole);
    for (const Front& half : halves) {
      scatter(half, whole);
    }
    forget(all);
    for (const std::int32_t v : inner) {
      gone_[to_size(v)] = 1;
    }
    const Index rest = size - own;
    Front front;
    front.vertices.assign(all.begin() + static_cast<std::ptrdiff_t>(inner.size()), all.end());
    Eigen::Ref<MatrixXd> inner_part(whole.topLeftCorner(own, own));
    const Eigen::LLT<Eigen::Ref<MatrixXd>> factors(inner_part);
    MatrixXd across = whole.bottomLeftCorner(rest, own).transpose();
    factors.matrixL().solveInPlace(across);
    front.stiffness = whole.bottomRightCorner(rest, rest);
    subtract_square(across, front.stiffness);
    return front;
  }

  const BlockMatrix& k_;
  std::span<const Vector3d> at_;
  std::vector<std::int32_t> place_;  // in the front at work; -1: not in it
  std::vector<std::uint8_t> gone_;   // eliminated
  std::vector<std::vector<Neighbour>> next_;
};

}  // namespace

MatrixXd condensed(const BlockMatrix& stiffness, std::span<const Vector3d> at,
                   std::span<const std::uint8_t> held, std::span<const std::int32_t> kept) {
  Condenser condenser(stiffness, at, held);
  std::vector<std::uint8_t> stays(held.begin(), held.end());
  for (const std::int32_t v : kept) {
    stays[to_size(v)] = 1;
  }
  std::vector<std::int32_t> inner;
  for (std::size_t v = 0; v < stays.size(); ++v) {
    if (stays[v] == 0) {
      inner.push_back(static_cast<std::int32_t>(v));
    }
  }
  const auto size = 3 * static_cast<Index>(kept.size());
  MatrixXd result = MatrixXd::Zero(size, size);
  Front rest;
  if (!inner.empty()) {
    rest = condenser.without(std::move(inner));
  }
  condenser.place(kept);
  condenser.add_blocks(kept, result);
  condenser.scatter(rest, result);
  condenser.forget(kept);
  return result;
}

SurfaceInverse surface_inverse(const BlockMatrix& stiffness, std::span<const Vector3d> at,
                               std::span<const std::uint8_t> held,
                               std::span<const std::int32_t> outer,
                               std::span<const std::int32_t> below) {
  std::vector<std::uint8_t> without_outer(held.begin(), held.end());
  for (const std::int32_t v : outer) {
    without_outer[to_size(v)] = 1;
  }
  std::vector<std::int32_t> both(below.begin(), below.end());
  both.insert(both.end(), outer.begin(), outer.end());
  const auto deep = 3 * static_cast<Index>(below.size());
  const auto top = 3 * static_cast<Index>(outer.size());
  Condenser condenser(stiffness, at, held);
  MatrixXd whole = MatrixXd::Zero(deep + top, deep + top);
  condenser.place(both);
  condenser.add_blocks(outer, whole);
  MatrixXd first = condensed(stiffness, at, without_outer, below);
  const Eigen::LLT<Eigen::Ref<MatrixXd>> first_factors(first);
  MatrixXd follow = whole.bottomLeftCorner(top, deep).transpose();
  MatrixXd second = whole.bottomRightCorner(top, top);
  first_factors.matrixL().solveInPlace(follow);
  subtract_square(follow, second);
  first_factors.matrixU().solveInPlace(follow);
  const Eigen::LLT<Eigen::Ref<MatrixXd>> second_factors(second);
  MatrixXd root = MatrixXd::Identity(top, top);
  second_factors.matrixL().solveInPlace(root);
  second.setZero();
  second.selfadjointView<Eigen::Lower>().rankUpdate(root.transpose());
  SurfaceInverse inverse;
  inverse.outer = second.selfadjointView<Eigen::Lower>().toDenseMatrix().cast<float>();
  inverse.below = -(follow.cast<float>() * inverse.outer);
  return inverse;
}

}  // namespace haptrial::deformable
