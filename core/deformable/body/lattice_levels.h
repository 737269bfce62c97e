#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/deformable/body/block_matrix.h"

namespace haptrial::deformable {

using LatticePoint = std::array<std::int32_t, 3>;

/// The vertices in whole steps of a cubic lattice, from 0 on. Nothing where they do not lie on one,
/// or where a block of `pattern` couples vertices that are not of one cube.
std::optional<std::vector<LatticePoint>> lattice_points(std::span<const Eigen::Vector3d> vertices,
                                                        const BlockMatrix& pattern);

/// Transfer from a lattice to one of twice its spacing, and between the matrices of both: a point's
/// value is the mean of the nearest one, two, four or eight points of the coarse lattice.
class CoarseLattice {
 public:
  struct Parent {
    std::int32_t point;
    double weight;
  };

  /// @param left_out  by fine point: 1 where it has no value; empty: none
  CoarseLattice(std::span<const LatticePoint> fine, std::span<const std::uint8_t> left_out);

  std::span<const LatticePoint> points() const { return points_; }
  BlockMatrix& matrix() { return matrix_; }
  const BlockMatrix& matrix() const { return matrix_; }

  /// matrix() = P^T a P
  void project(const BlockMatrix& a);
  /// to = P^T from
  void restrict_to_coarse(const Vectors& from, Vectors& to) const;
  /// to += P from
  void add_to_fine(const Vectors& from, Vectors& to) const;

 private:
  std::span<const Parent> parents(std::size_t fine) const;

  std::vector<LatticePoint> points_;
  std::vector<std::int32_t> first_parent_;  // fine points + 1
  std::vector<Parent> parents_;
  std::vector<std::array<std::int32_t, 14>> place_;  // of blocks, by what is added to a point
  BlockMatrix matrix_;
};

}  // namespace haptrial::deformable
