#include "core/deformable/body/conjugate_gradients.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace haptrial::deformable {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

using Flat = Eigen::Map<Eigen::VectorXd>;

Flat flat(Vectors& v) { return {v.front().data(), static_cast<Eigen::Index>(3 * v.size())}; }

std::vector<Matrix3d> inverse_diagonal(const BlockMatrix& a, std::span<const std::uint8_t> held) {
  std::vector<Matrix3d> inverse(a.rows());
  for (std::size_t row = 0; row < a.rows(); ++row) {
    const Matrix3d block = Eigen::Map<const Matrix3d>(a.block(a.row_start(row)));
    inverse[row] = block.inverse();
    if (held[row] != 0) {
      inverse[row].setZero();
    } else if (!(block.determinant() > 0) || !(block.trace() > 0)) {
      inverse[row] = Matrix3d::Identity() / std::max(block.norm(), 1e-300);
    }
  }
  return inverse;
}

double free_norm(const Vectors& r, std::span<const std::uint8_t> held) {
  double squares = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    if (held[i] == 0) {
      squares += r[i].squaredNorm();
    }
  }
  return std::sqrt(squares);
}

}  // namespace

Preconditioner block_jacobi(const BlockMatrix& a, std::span<const std::uint8_t> held) {
  return [inverse = inverse_diagonal(a, held)](const Vectors& r, Vectors& z) {
    for (std::size_t i = 0; i < r.size(); ++i) {
      z[i].noalias() = inverse[i] * r[i];
    }
  };
}

GradientResult conjugate_gradients(const BlockMatrix& a, const Vectors& b,
                                   std::span<const std::uint8_t> held,
                                   const Preconditioner& precondition,
                                   const GradientOptions& options, Vectors& x) {
  x.assign(b.size(), Vector3d::Zero());
  Vectors r = b;
  Vectors z(b.size(), Vector3d::Zero());
  Vectors ap(b.size());
  precondition(r, z);
  double rz = flat(r).dot(flat(z));
  Vectors p = z;
  GradientResult result{0, free_norm(r, held), false};
  while (result.residual > options.residual && result.iterations < options.most) {
    a.multiply(p, ap);
    const double curvature = flat(p).dot(flat(ap));
    if (!(curvature > 0) || !(rz > 0)) {
      result.negative_curvature = true;
      if (result.iterations == 0) {
        x = p;
      }
      break;
    }
    const double alpha = rz / curvature;
    flat(x) += alpha * flat(p);
    flat(r) -= alpha * flat(ap);
    precondition(r, z);
    const double next = flat(r).dot(flat(z));
    flat(p) = flat(z) + (next / rz) * flat(p);
    rz = next;
    ++result.iterations;
    result.residual = free_norm(r, held);
  }
  return result;
}

}  // namespace haptrial::deformable
