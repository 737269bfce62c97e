#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

#include "core/base/big_array.h"

namespace haptrial::deformable {

/// Cholesky factor of a matrix with one number for each pair of vertices, for loops that must not
/// allocate. The three axes are solved at once, in floats: whoever iterates with it loses nothing.
class MeshFactor {
 public:
  using Row = Eigen::Array4f;  // x, y, z and a number that means nothing

  /// @param matrix  positive definite (vertices x vertices); its lower half is read
  /// @throws std::invalid_argument if it is not positive definite.
  explicit MeshFactor(const Eigen::SparseMatrix<double>& matrix);

  std::size_t size() const noexcept { return place_.size(); }
  /// Where a vertex is in the order of elimination, which solve() takes.
  std::size_t place(std::size_t vertex) const noexcept {
    return static_cast<std::size_t>(place_[vertex]);
  }
  /// x = A⁻¹ x, (size), vertex v at place(v). Servo thread: no allocation, lock or throw.
  void solve(Row* x) const noexcept;
  std::size_t entries() const noexcept { return values_.size(); }

 private:
  std::vector<std::int32_t> place_;  // by vertex
  std::vector<std::int32_t> start_;  // by column, and one more
  BigArray<std::int32_t> rows_;      // below the diagonal
  BigArray<float> values_;           // likewise
  std::vector<float> over_;          // 1 / diagonal
};

}  // namespace haptrial::deformable
