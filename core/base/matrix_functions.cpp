#include "core/base/matrix_functions.h"

#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace haptrial {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

gsl_matrix_view view_of(RowMajor& matrix) {
  return gsl_matrix_view_array(matrix.data(), static_cast<std::size_t>(matrix.rows()),
                               static_cast<std::size_t>(matrix.cols()));
}

void check(const Eigen::MatrixXd& matrix) {
  if (matrix.rows() == 0 || matrix.rows() != matrix.cols() || !matrix.allFinite()) {
    throw std::invalid_argument("matrix must be square, not empty, and finite");
  }
}

}  // namespace

std::complex<double> dominant_eigenvalue(const Eigen::MatrixXd& matrix) {
  check(matrix);
  const auto n = static_cast<std::size_t>(matrix.rows());
  RowMajor copy = matrix;
  gsl_matrix_view view = view_of(copy);
  const std::unique_ptr<gsl_eigen_nonsymm_workspace, decltype(&gsl_eigen_nonsymm_free)> work(
      gsl_eigen_nonsymm_alloc(n), gsl_eigen_nonsymm_free);
  const std::unique_ptr<gsl_vector_complex, decltype(&gsl_vector_complex_free)> values(
      gsl_vector_complex_alloc(n), gsl_vector_complex_free);
  gsl_eigen_nonsymm_params(0, 1, work.get());  // eigenvalues alone, of the balanced matrix
  if (gsl_eigen_nonsymm(&view.matrix, values.get(), work.get()) != 0) {
    throw std::runtime_error("the eigenvalues of a matrix did not converge");
  }
  gsl_complex largest = gsl_vector_complex_get(values.get(), 0);
  for (std::size_t i = 1; i < n; ++i) {
    const gsl_complex value = gsl_vector_complex_get(values.get(), i);
    largest = gsl_complex_abs(value) > gsl_complex_abs(largest) ? value : largest;
  }
  return {GSL_REAL(largest), GSL_IMAG(largest)};
}

double spectral_radius(const Eigen::MatrixXd& matrix) {
  return std::abs(dominant_eigenvalue(matrix));
}

Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& matrix) {
  check(matrix);
  RowMajor copy = matrix;
  RowMajor result(matrix.rows(), matrix.cols());
  const gsl_matrix_view from = view_of(copy);
  gsl_matrix_view to = view_of(result);
  gsl_linalg_exponential_ss(&from.matrix, &to.matrix, GSL_PREC_DOUBLE);
  return result;
}

}  // namespace haptrial
