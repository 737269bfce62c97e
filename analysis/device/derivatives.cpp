#include "analysis/device/derivatives.h"

#include <Eigen/QR>
#include <cmath>

namespace haptrial::analysis {

Eigen::MatrixXd derivative_weights(long half, double rate, long degree) {
  const long n = 2 * half + 1;
  Eigen::MatrixXd powers(n, degree + 1);
  for (long i = 0; i < n; ++i) {
    const double s = static_cast<double>(i - half) / static_cast<double>(half);
    for (long p = 0; p <= degree; ++p) {
      powers(i, p) = std::pow(s, p);
    }
  }
  const Eigen::MatrixXd inverse = powers.completeOrthogonalDecomposition().pseudoInverse();
  Eigen::MatrixXd weights(n, 3);
  const double per_second = rate / static_cast<double>(half);
  weights.col(0) = per_second * inverse.row(1).transpose();
  weights.col(1) = 2.0 * per_second * per_second * inverse.row(2).transpose();
  weights.col(2) = inverse.row(0).transpose();
  return weights;
}

Eigen::VectorXd smoothing_of(const Eigen::VectorXd& second_derivative, double rate) {
  const long n = second_derivative.size() - 2;
  Eigen::VectorXd kernel(n);
  double before = 0.0, now = 0.0;
  for (long i = 0; i < n; ++i) {
    const double next = second_derivative[i] / (rate * rate) + 2.0 * now - before;
    kernel[i] = next;
    before = now;
    now = next;
  }
  return kernel;
}

}  // namespace haptrial::analysis
