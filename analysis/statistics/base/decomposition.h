#pragma once

#include <Eigen/Core>
#include <optional>

/// Decompositions of dense matrices, compiled once: their templates take the compiler longest.
namespace haptrial::analysis {

/// L of matrix = L L', from its lower triangle; nothing unless it is positive definite.
std::optional<Eigen::MatrixXd> cholesky(const Eigen::MatrixXd& matrix);
/// L^-1 right. @param lower  (n x n)  @param right  (n x m), m may be 0
Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& right);
/// matrix^-1 right; nothing unless `matrix` is positive definite.
std::optional<Eigen::MatrixXd> solve_positive(const Eigen::MatrixXd& matrix,
                                              const Eigen::MatrixXd& right);

/// L D L' of a matrix that may be semidefinite.
struct Pivoted {
  double smallest;         // pivot in D
  Eigen::VectorXd solved;  // matrix^-1 right
};
Pivoted solve_pivoted(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

struct SymmetricEigen {
  Eigen::VectorXd values;   // (n) rising
  Eigen::MatrixXd vectors;  // (n x n) of unit length, in columns
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

/// R of matrix = Q R. @return (min(rows, columns) x columns), upper triangular
Eigen::MatrixXd triangle(const Eigen::MatrixXd& matrix);

/// Least squares of `response` (n) on `columns` (n x p) of full rank, n >= p.
struct LeastSquares {
  Eigen::VectorXd slopes;   // (p)
  Eigen::MatrixXd inverse;  // (columns' columns)^-1, (p x p)
};
LeastSquares least_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response);

/// `values` (n x m) in an orthonormal basis of all that `columns` (n x p) do not span.
/// @return (n - rank x m)
Eigen::MatrixXd beyond_span(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& values);

/// matrix = U diag(singular) V', r = min(rows, columns).
struct ThinSvd {
  Eigen::MatrixXd u;         // (rows x r)
  Eigen::VectorXd singular;  // (r) falling
  Eigen::MatrixXd v;         // (columns x r)
};
ThinSvd thin_svd(const Eigen::MatrixXd& matrix);

}  // namespace haptrial::analysis
