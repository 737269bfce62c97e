#pragma once

#include <Eigen/Core>
#include <complex>

/// Functions of square matrices by GSL: Eigen's templates of them compile for half a minute a file.
namespace haptrial {

/// The eigenvalue of the largest modulus; of a conjugate pair either. @param matrix  (n x n), n >
/// 0, finite
std::complex<double> dominant_eigenvalue(const Eigen::MatrixXd& matrix);

/// The modulus of the dominant eigenvalue. @param matrix  (n x n), n > 0, finite
double spectral_radius(const Eigen::MatrixXd& matrix);

/// The sum of matrix^k / k!, to double precision. @param matrix  (n x n), finite
Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& matrix);

}  // namespace haptrial
