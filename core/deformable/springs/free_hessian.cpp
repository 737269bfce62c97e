#include "core/deformable/springs/free_hessian.h"

namespace haptrial::deformable {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

void add_block(Triplets& entries, int row, int column, const Eigen::Matrix3d& block) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (3 * row + i >= 3 * column + j) {
        entries.emplace_back(3 * row + i, 3 * column + j, block(i, j));
      }
    }
  }
}

}  // namespace

FreeHessian::FreeHessian(const SpringBody& body, std::span<const Hold> holds)
    : hessian_(body), number_(body.rest.size(), 0) {
  for (const Hold& hold : holds) {
    number_[static_cast<std::size_t>(hold.vertex)] = -1;
  }
  for (int& n : number_) {
    n = n < 0 ? -1 : free_++;
  }
}

Eigen::SparseMatrix<double> FreeHessian::lower(const SpringBody& body,
                                               std::span<const Eigen::Vector3d> positions) {
  hessian_.assemble(body, positions);
  Triplets entries;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (number_[v] >= 0) {
      add_block(entries, number_[v], number_[v], hessian_.diagonal()[v]);
    }
  }
  for (std::size_t e = 0; e < hessian_.edges().size(); ++e) {
    const int a = number_[static_cast<std::size_t>(hessian_.edges()[e][0])];
    const int b = number_[static_cast<std::size_t>(hessian_.edges()[e][1])];
    if (a >= 0 && b >= 0) {
      add_block(entries, b, a, hessian_.mixed()[e].transpose());
    }
  }
  Eigen::SparseMatrix<double> matrix(size(), size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace haptrial::deformable
