#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/big_array.h"

namespace haptrial::deformable {

using Vectors = std::vector<Eigen::Vector3d>;  // one for each vertex

/// Groups of vertices that are coupled, each with every other: elements, or patches of them.
struct CoupledGroups {
  std::span<const std::int32_t> first;     // groups + 1: into `vertices`
  std::span<const std::int32_t> vertices;  // ascending in each group
  std::size_t size() const { return first.size() - 1; }
};

/// A symmetric matrix of 3 x 3 blocks, one row of blocks a vertex. Only blocks on and above the
/// diagonal are stored, row after row, each row's diagonal block first and its columns ascending.
/// The pattern is computed once for a mesh; the values are set as often as the body moves.
class BlockMatrix {
 public:
  /// @param vertices  of the mesh: rows of blocks
  BlockMatrix(const CoupledGroups& groups, std::size_t vertices);

  /// @param start  rows + 1: where each row's blocks begin  @param column  of each block
  BlockMatrix(std::vector<std::int32_t> start, std::vector<std::int32_t> column);

  std::size_t rows() const { return start_.size() - 1; }
  std::size_t blocks() const { return column_.size(); }
  std::int32_t row_start(std::size_t row) const { return start_[row]; }
  std::int32_t column(std::int32_t block) const { return column_[static_cast<std::size_t>(block)]; }
  /// Nine numbers, column after column.
  double* block(std::int32_t at) { return values_.data() + 9 * static_cast<std::size_t>(at); }
  const double* block(std::int32_t at) const {
    return values_.data() + 9 * static_cast<std::size_t>(at);
  }
  /// Places of the blocks of a group with n vertices: n (n + 1) / 2 places, in the order of the upper
  /// triangle by rows, in the group's numbers.
  std::span<const std::int32_t> places(std::size_t group) const;

  void set_zero();
  /// this = scale this + a diagonal that is the same for the three axes of a vertex.
  void scale_and_add(double scale, std::span<const double> diagonal);
  /// this += scale other, a matrix of the same pattern
  void add(double scale, const BlockMatrix& other);
  /// y = A x
  void multiply(const Vectors& x, Vectors& y) const;

 private:
  struct Member;  // which vertex of which group
  static std::vector<Member> members_by_vertex(const CoupledGroups& groups,
                                               std::vector<std::int32_t>& first);
  void add_row(const CoupledGroups& groups, std::span<const Member> members,
               std::vector<std::int32_t>& place);

  std::vector<std::int32_t> start_;   // rows + 1
  std::vector<std::int32_t> column_;  // by block
  BigArray<double> values_;           // 9 by block
  std::vector<std::int32_t> places_;
  std::vector<std::int32_t> first_place_;  // groups + 1
};

}  // namespace haptrial::deformable
