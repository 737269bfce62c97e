#include "core/deformable/body/fastest_vibration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kMargin = 2e-3;       // of ω, added
constexpr double kCloseEnough = 1e-3;  // of λ: what Lanczos' method may lack
constexpr int kMostSteps = 400;
constexpr int kRitzEvery = 10;

/// M^-1/2 K M^-1/2 on free vertices.
class Scaled {
 public:
  Scaled(const BlockMatrix& stiffness, std::span<const double> masses,
         std::span<const std::int32_t> held)
      : stiffness_(stiffness), scale_(masses.size()) {
    for (std::size_t v = 0; v < scale_.size(); ++v) {
      scale_[v] = 1 / std::sqrt(masses[v]);
    }
    for (const std::int32_t v : held) {
      scale_[static_cast<std::size_t>(v)] = 0;
    }
  }
  VectorXd times(const VectorXd& x) const {
    std::vector<Vector3d> moved(scale_.size());
    for (std::size_t v = 0; v < scale_.size(); ++v) {
      moved[v] = scale_[v] * part(x, v);
    }
    Vectors forces(moved.size());
    stiffness_.multiply(moved, forces);
    VectorXd y(x.size());
    for (std::size_t v = 0; v < scale_.size(); ++v) {
      y.segment<3>(3 * static_cast<Eigen::Index>(v)) = scale_[v] * forces[v];
    }
    return y;
  }
  /// The same every time.
  VectorXd start() const {
    RandomStream random(0, "lanczos");
    VectorXd x(3 * static_cast<Eigen::Index>(scale_.size()));
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      x[i] = scale_[static_cast<std::size_t>(i / 3)] > 0 ? random.normal() : 0.0;
    }
    return x.normalized();
  }

 private:
  static Vector3d part(const VectorXd& x, std::size_t v) {
    return x.segment<3>(3 * static_cast<Eigen::Index>(v));
  }
  const BlockMatrix& stiffness_;
  std::vector<double> scale_;
};

struct Ritz {
  double value, lack;
};

Ritz largest(const std::vector<double>& diagonal, const std::vector<double>& beside) {
  const auto n = static_cast<Eigen::Index>(diagonal.size());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<const VectorXd>(diagonal.data(), n),
                                Eigen::Map<const VectorXd>(beside.data(), n - 1));
  const double last = solver.eigenvectors()(n - 1, n - 1);
  return {solver.eigenvalues()[n - 1], std::abs(beside.back() * last)};
}

double largest_eigenvalue(const Scaled& matrix) {
  VectorXd now = matrix.start();
  VectorXd before = VectorXd::Zero(now.size());
  std::vector<double> diagonal, beside;
  for (int step = 1; step <= kMostSteps; ++step) {
    VectorXd next = matrix.times(now);
    if (!beside.empty()) {
      next -= beside.back() * before;
    }
    diagonal.push_back(now.dot(next));
    next -= diagonal.back() * now;
    beside.push_back(next.norm());
    const bool done = beside.back() <= 1e-12 * std::abs(diagonal.front());
    if (done || step % kRitzEvery == 0 || step == kMostSteps) {
      const Ritz found = largest(diagonal, beside);
      if (done || found.lack <= kCloseEnough * found.value || step == kMostSteps) {
        return found.value + found.lack;
      }
    }
    before = now;
    now = next / beside.back();
  }
  return 0;  // not reached
}

}  // namespace

double fastest_vibration(const BlockMatrix& stiffness, std::span<const double> masses,
                         std::span<const std::int32_t> held) {
  const double value = largest_eigenvalue(Scaled(stiffness, masses, held));
  return std::sqrt(std::max(0.0, value)) * (1 + kMargin);
}

}  // namespace haptrial::deformable
