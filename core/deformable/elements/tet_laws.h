#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "core/deformable/elements/material.h"

namespace haptrial::deformable {

/// The blocks (a, b), a <= b, of a tetrahedron's 12 x 12 stiffness, rows of a after
/// each other: (0,0), (0,1), (0,2), (0,3), (1,1) ...
using TetBlocks = std::array<Eigen::Matrix3d, 10>;
using TetGradients = Eigen::Matrix<double, 3, 4>;  // of the four shape functions, by column [1/m]

/// A law at one tetrahedron with deformation gradient F = I + G. Every law is a sum of a part that
/// resists the change of form and one that resists the change of volume by the strain theta:
///
///     energy per rest volume = form(F) + K / 2 mean(theta)²
///
/// with the mean over the patch that the tetrahedron belongs to (volume_patches.h). With patches of
/// one tetrahedron each law is the usual one:
///
///     linear         form = mu |dev sym G|²                      theta = tr G
///     corotational   form = mu |S - I|² - mu / 3 theta²          theta = tr S - 3,  F = R S
///     neo-Hookean    form = mu / 2 (J^(-2/3) tr(F^T F) - 3)      theta = J - 1,     J = det F
///
/// The neo-Hookean form is the one of CalculiX (*HYPERELASTIC, NEO HOOKE: C10 = mu / 2, D1 = 2 /
/// K).
///
/// Members: theta; inverted (no force is defined); volume_gradient = d theta / dF; energy(mu) and
/// stress(mu) of the form part, [J/m³] and first Piola [Pa]; set_blocks() sets the stiffness of
/// form plus `pressure` d² theta / dF², times the rest volume. The patch adds the rest of the
/// volume part.
template <Law law>
class TetLaw;

template <>
class TetLaw<Law::kLinear> {
 public:
  using Matrix = Eigen::Matrix3d;
  explicit TetLaw(const Matrix& g)
      : theta(g.trace()), deviator_(0.5 * (g + g.transpose()) - theta / 3 * Matrix::Identity()) {}

  double theta;
  static constexpr bool inverted = false;
  Matrix volume_gradient() const { return Matrix::Identity(); }
  double energy(double mu) const { return mu * deviator_.squaredNorm(); }
  Matrix stress(double mu) const { return 2 * mu * deviator_; }
  void set_blocks(const TetGradients& b, double mu, double /*pressure*/, double volume,
                  TetBlocks& blocks) const {
    const double c = mu * volume;
    std::size_t block = 0;
    for (int i = 0; i < 4; ++i) {
      for (int j = i; j < 4; ++j, ++block) {
        blocks[block].noalias() = c * b.col(j) * b.col(i).transpose();
        blocks[block].noalias() -= (2.0 / 3 * c) * b.col(i) * b.col(j).transpose();
        blocks[block].diagonal().array() += c * b.col(i).dot(b.col(j));
      }
    }
  }

 private:
  Matrix deviator_;
};

template <>
class TetLaw<Law::kCorotational> {
 public:
  using Matrix = Eigen::Matrix3d;
  explicit TetLaw(const Matrix& g);

  double theta{};
  bool inverted;
  const Matrix& volume_gradient() const { return rotation_; }
  double energy(double mu) const { return mu * (strain_.squaredNorm() - theta * theta / 3); }
  Matrix stress(double mu) const {
    Matrix s = strain_;
    s.diagonal().array() -= theta / 3;
    return 2 * mu * rotation_ * s;
  }
  void set_blocks(const TetGradients& b, double mu, double pressure, double volume,
                  TetBlocks& blocks) const;

 private:
  Matrix rotation_;
  Matrix strain_;  // S - I
};

template <>
class TetLaw<Law::kNeoHookean> {
 public:
  using Matrix = Eigen::Matrix3d;
  explicit TetLaw(const Matrix& g);

  double theta;
  bool inverted;
  const Matrix& volume_gradient() const { return cofactor_; }
  double energy(double mu) const;
  Matrix stress(double mu) const {
    return mu * scale_ * (f_ - (i1_ / (3 * (1 + theta))) * cofactor_);
  }
  void set_blocks(const TetGradients& b, double mu, double pressure, double volume,
                  TetBlocks& blocks) const;

 private:
  Matrix f_;
  Matrix cofactor_;   // J F^-T
  double i1_excess_;  // tr(F^T F) - 3
  double i1_;
  double scale_{1};  // J^(-2/3)
};

/// det(I + g) - 1, without the loss of digits for small g.
double volume_change(const Eigen::Matrix3d& g);

/// The rotation of the polar decomposition f = R S, for det f > 0.
Eigen::Matrix3d polar_rotation(const Eigen::Matrix3d& f);

}  // namespace haptrial::deformable
