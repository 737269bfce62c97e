#include "analysis/statistics/base/decomposition.h"

#include <gsl/gsl_linalg.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

gsl_matrix_view view_of(RowMajor& matrix) {
  return gsl_matrix_view_array(matrix.data(), static_cast<std::size_t>(matrix.rows()),
                               static_cast<std::size_t>(matrix.cols()));
}

gsl_vector_view view_of(VectorXd& vector) {
  return gsl_vector_view_array(vector.data(), static_cast<std::size_t>(vector.size()));
}

}  // namespace

std::optional<MatrixXd> cholesky(const MatrixXd& matrix) {
  const Eigen::LLT<MatrixXd> factor(matrix);
  if (factor.info() != Eigen::Success) {
    return std::nullopt;
  }
  return MatrixXd(factor.matrixL());
}

MatrixXd solve_lower(const MatrixXd& lower, const MatrixXd& right) {
  if (right.cols() == 0) {  // Eigen takes the address of the first element
    return right;
  }
  return lower.triangularView<Eigen::Lower>().solve(right);
}

std::optional<MatrixXd> solve_positive(const MatrixXd& matrix, const MatrixXd& right) {
  const Eigen::LLT<MatrixXd> factor(matrix);
  if (factor.info() != Eigen::Success) {
    return std::nullopt;
  }
  return MatrixXd(factor.solve(right));
}

Pivoted solve_pivoted(const MatrixXd& matrix, const VectorXd& right) {
  const Eigen::LDLT<MatrixXd> factor(matrix);
  return {factor.vectorD().minCoeff(), factor.solve(right)};
}

SymmetricEigen symmetric_eigen(const MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(matrix);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

MatrixXd triangle(const MatrixXd& matrix) {
  const Eigen::HouseholderQR<MatrixXd> qr(matrix);
  const Index rows = std::min(matrix.rows(), matrix.cols());
  return qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
}

LeastSquares least_squares(const MatrixXd& columns, const VectorXd& response) {
  const Eigen::HouseholderQR<MatrixXd> qr(columns);
  const Index p = columns.cols();
  const MatrixXd root =
      qr.matrixQR().topRows(p).triangularView<Eigen::Upper>().solve(MatrixXd::Identity(p, p));
  return {qr.solve(response), root * root.transpose()};
}

MatrixXd beyond_span(const MatrixXd& columns, const MatrixXd& values) {
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(columns);
  const MatrixXd turned = qr.householderQ().adjoint() * values;
  return turned.bottomRows(turned.rows() - qr.rank());
}

// The decomposition of GSL: Eigen's compiles for most of a minute.
ThinSvd thin_svd(const MatrixXd& matrix) {
  const bool wide = matrix.rows() < matrix.cols();  // GSL takes what is not
  RowMajor u = wide ? RowMajor(matrix.transpose()) : RowMajor(matrix);
  const Index r = u.cols();
  if (r == 0) {
    return {MatrixXd(matrix.rows(), 0), VectorXd(0), MatrixXd(matrix.cols(), 0)};
  }
  RowMajor v(r, r);
  RowMajor square(r, r);
  VectorXd singular(r);
  VectorXd work(r);
  gsl_matrix_view u_view = view_of(u);
  gsl_matrix_view v_view = view_of(v);
  gsl_matrix_view square_view = view_of(square);
  gsl_vector_view singular_view = view_of(singular);
  gsl_vector_view work_view = view_of(work);
  gsl_linalg_SV_decomp_mod(&u_view.matrix, &square_view.matrix, &v_view.matrix,
                           &singular_view.vector, &work_view.vector);
  return wide ? ThinSvd{v, singular, u} : ThinSvd{u, singular, v};
}

}  // namespace haptrial::analysis
