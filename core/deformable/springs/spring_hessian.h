#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/deformable/body/block_matrix.h"
#include "core/deformable/springs/spring_body.h"

namespace haptrial::deformable {

/// The second derivatives of the energy of all springs, exact: 3 x 3 blocks [N/m] of each vertex
/// with itself and of the two ends of each edge (vertices without a common edge have none).
class SpringHessian {
 public:
  /// Finds which edges each face and tetrahedron has.
  explicit SpringHessian(const SpringBody& body);

  /// Computes the blocks with vertices at `positions` [m]. `body` may have other constants than the
  /// constructor's.
  void assemble(const SpringBody& body, std::span<const Eigen::Vector3d> positions);

  /// A row of blocks for each vertex.
  BlockMatrix& matrix() { return matrix_; }
  const BlockMatrix& matrix() const { return matrix_; }

 private:
  template <std::size_t n>
  void add(const std::array<std::int32_t, n>& vertices,
           const std::array<std::array<Eigen::Matrix3d, n>, n>& blocks,
           std::span<const std::int32_t> edges);  // numbers of the edges between them

  BlockMatrix matrix_;
  std::vector<std::int32_t> edge_block_;                        // by edge: its place in the matrix
  std::vector<std::array<std::int32_t, 3>> face_edges_;         // 01, 02, 12
  std::vector<std::array<std::int32_t, 6>> tetrahedron_edges_;  // 01, 02, 03, 12, 13, 23
};

/// The blocks of one spring: [i][j] derives the energy by point i and by point j [N/m].
std::array<std::array<Eigen::Matrix3d, 2>, 2> length_hessian(const Spring& spring,
                                                             const Points2& points);
std::array<std::array<Eigen::Matrix3d, 3>, 3> area_hessian(const Spring& spring,
                                                           const Points3& points);
std::array<std::array<Eigen::Matrix3d, 4>, 4> volume_hessian(const Spring& spring,
                                                             const Points4& points);

}  // namespace haptrial::deformable
