#pragma once

#include <Eigen/Core>

namespace haptrial::analysis {

/// Weights of the first and the second derivative in the middle of 2 half + 1 even samples, of the
/// polynomial of degree 5 that fits them best; (2 half + 1 x 2) [1/s, 1/s²].
/// @param half  at least 3.  @param rate  of the samples > 0 [Hz]
Eigen::MatrixXd derivative_weights(long half, double rate);

/// The kernel K for which the second derivative above is K over the plain second differences; its
/// sum is 1. (2 half - 1)
Eigen::VectorXd smoothing_of(const Eigen::VectorXd& second_derivative, double rate);

}  // namespace haptrial::analysis
