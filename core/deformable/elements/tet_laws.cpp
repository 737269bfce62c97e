#include "core/deformable/elements/tet_laws.h"

namespace haptrial::deformable {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d cofactor(const Matrix3d& f) {
  Matrix3d c;
  c.col(0) = f.col(1).cross(f.col(2));
  c.col(1) = f.col(2).cross(f.col(0));
  c.col(2) = f.col(0).cross(f.col(1));
  return c;
}

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

double volume_change(const Matrix3d& g) {
  const double trace = g.trace();
  const double squares = (g.array() * g.transpose().array()).sum();
  return trace + 0.5 * (trace * trace - squares) + g.determinant();
}

Matrix3d polar_rotation(const Matrix3d& f) {
  // Newton's iteration with Higham's scaling converges quadratically; ten steps are more than any
  // tetrahedron needs that is not flat.
  constexpr int kMost = 50;
  constexpr double kSettled = 1e-15;
  Matrix3d r = f;
  for (int i = 0; i < kMost; ++i) {
    const Matrix3d inverse = cofactor(r) / r.determinant();  // transposed
    const double scale = std::sqrt(inverse.norm() / r.norm());
    const Matrix3d next = 0.5 * (scale * r + inverse / scale);
    const double moved = (next - r).squaredNorm();
    r = next;
    if (moved < kSettled) {
      break;  // the step after one of 3e-8 is below rounding
    }
  }
  return 0.5 * (r + cofactor(r) / r.determinant());
}

TetLaw<Law::kCorotational>::TetLaw(const Matrix3d& g) : inverted(volume_change(g) <= -1) {
  const Matrix3d f = Matrix3d::Identity() + g;
  rotation_ = inverted ? Matrix3d::Identity().eval() : polar_rotation(f);
  // R^T F - I, from the small matrices where F is near R.
  const Matrix3d s = rotation_.transpose() * f - Matrix3d::Identity();
  strain_ = 0.5 * (s + s.transpose());
  theta = strain_.trace();
}

void TetLaw<Law::kCorotational>::set_blocks(const TetGradients& b, double mu, double pressure,
                                            double volume, TetBlocks& blocks) const {
  // A turn of R by w takes (tr(S) I - S) w = b x (R^T e_k) for a move of a corner along axis k.
  Matrix3d turn = -strain_;
  turn.diagonal().array() += theta + 2;
  const Matrix3d yields = turn.inverse();
  const double c = volume * (2 * mu + 2.0 / 3 * mu * theta - pressure);
  const TetGradients rb = rotation_ * b;
  std::array<Matrix3d, 4> arms;  // [b]x R^T
  std::array<Matrix3d, 4> turned;
  for (int i = 0; i < 4; ++i) {
    const auto at = static_cast<std::size_t>(i);
    arms[at].noalias() = cross_matrix(b.col(i)) * rotation_.transpose();
    turned[at].noalias() = c * yields * arms[at];
  }
  std::size_t block = 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = i; j < 4; ++j, ++block) {
      blocks[block].noalias() = (-2.0 / 3 * mu * volume) * rb.col(i) * rb.col(j).transpose();
      blocks[block].noalias() -=
          arms[static_cast<std::size_t>(i)].transpose() * turned[static_cast<std::size_t>(j)];
      blocks[block].diagonal().array() += 2 * mu * volume * b.col(i).dot(b.col(j));
    }
  }
}

TetLaw<Law::kNeoHookean>::TetLaw(const Matrix3d& g)
    : theta(volume_change(g)),
      inverted(theta <= -1),
      f_(Matrix3d::Identity() + g),
      cofactor_(cofactor(f_)),
      i1_excess_(2 * g.trace() + g.squaredNorm()),
      i1_(3 + i1_excess_) {
  if (!inverted) {
    const double root = std::cbrt(1 + theta);
    scale_ = 1 / (root * root);
  }
}

double TetLaw<Law::kNeoHookean>::energy(double mu) const {
  const double a = -2.0 / 3 * std::log1p(theta);
  return 0.5 * mu * (3 * std::expm1(a) + i1_excess_ * scale_);
}

void TetLaw<Law::kNeoHookean>::set_blocks(const TetGradients& b, double mu, double pressure,
                                          double volume, TetBlocks& blocks) const {
  const double j = 1 + theta;
  const double c = volume * mu * scale_;
  const TetGradients gs = (1 / j) * cofactor_ * b;  // gradients in the deformed shape
  const TetGradients hs = f_ * b;
  const double same = c * (2.0 / 9) * i1_ + volume * pressure * j;
  const double swapped = c * i1_ / 3 - volume * pressure * j;
  std::size_t block = 0;
  for (int m = 0; m < 4; ++m) {
    const Vector3d left = same * gs.col(m) - (2.0 / 3 * c) * hs.col(m);
    const Vector3d right = (-2.0 / 3 * c) * gs.col(m);
    const Vector3d back = swapped * gs.col(m);
    for (int n = m; n < 4; ++n, ++block) {
      blocks[block].noalias() = left * gs.col(n).transpose();
      blocks[block].noalias() += right * hs.col(n).transpose();
      blocks[block].noalias() += gs.col(n) * back.transpose();
      blocks[block].diagonal().array() += c * b.col(m).dot(b.col(n));
    }
  }
}

}  // namespace haptrial::deformable
