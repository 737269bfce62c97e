#pragma once

#include <Eigen/Core>

/// Functions of square matrices by GSL: Eigen's templates of them compile for half a minute a file.
namespace haptrial {

/// Largest modulus of the eigenvalues. @param matrix  (n x n), n > 0, finite
double spectral_radius(const Eigen::MatrixXd& matrix);

/// The sum of matrix^k / k!, to double precision. @param matrix  (n x n), finite
Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& matrix);

}  // namespace haptrial
