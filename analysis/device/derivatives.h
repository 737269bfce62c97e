#pragma once

#include <Eigen/Core>

namespace haptrial::analysis {

/// Weights of the first and the second derivative and of the value in the middle of 2 half + 1 even
/// samples, of the polynomial that fits them best; (2 half + 1 x 3) [1/s, 1/s², 1].
/// @param half  more than degree / 2.  @param rate  of the samples > 0 [Hz]
/// @param degree  of the polynomial, at least 2
Eigen::MatrixXd derivative_weights(long half, double rate, long degree);

/// The kernel K for which the second derivative above is K over the plain second differences; its
/// sum is 1. (2 half - 1)
Eigen::VectorXd smoothing_of(const Eigen::VectorXd& second_derivative, double rate);

}  // namespace haptrial::analysis
