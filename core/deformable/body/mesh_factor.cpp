#include "core/deformable/body/mesh_factor.h"

#include <Eigen/CholmodSupport>
#include <stdexcept>

namespace haptrial::deformable {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

/// CHOLMOD's factor, column after column. Eigen keeps it to itself.
class ColumnFactor : public Eigen::CholmodSimplicialLLT<Matrix, Eigen::Lower> {
 public:
  explicit ColumnFactor(const Matrix& matrix) {
    cholmod().print = 0;
    compute(matrix);
    if (info() == Eigen::Success) {
      cholmod_change_factor(CHOLMOD_REAL, 1, 0, 1, 1, m_cholmodFactor, &cholmod());
    }
  }
  const cholmod_factor& factor() const { return *m_cholmodFactor; }
};

}  // namespace

MeshFactor::MeshFactor(const Eigen::SparseMatrix<double>& matrix) {
  const ColumnFactor made{matrix};
  if (made.info() != Eigen::Success) {
    throw std::invalid_argument("a matrix of a mesh is not positive definite");
  }
  const cholmod_factor& l = made.factor();
  const auto* order = static_cast<const int*>(l.Perm);
  const auto* start = static_cast<const int*>(l.p);
  const auto* rows = static_cast<const int*>(l.i);
  const auto* values = static_cast<const double*>(l.x);
  place_.resize(l.n);
  for (std::size_t i = 0; i < l.n; ++i) {
    place_[static_cast<std::size_t>(order[i])] = static_cast<std::int32_t>(i);
  }
  for (std::size_t column = 0; column < l.n; ++column) {
    start_.push_back(static_cast<std::int32_t>(rows_.size()));
    over_.push_back(static_cast<float>(1.0 / values[start[column]]));
    for (int at = start[column] + 1; at < start[column + 1]; ++at) {
      rows_.push_back(rows[at]);
      values_.push_back(static_cast<float>(values[at]));
    }
  }
  start_.push_back(static_cast<std::int32_t>(rows_.size()));
}

void MeshFactor::solve(Row* x) const noexcept {
  const std::int32_t* rows = rows_.data();
  const float* values = values_.data();
  const std::size_t n = size();
  for (std::size_t column = 0; column < n; ++column) {
    const Row own = x[column] *= over_[column];
    for (std::int32_t at = start_[column]; at < start_[column + 1]; ++at) {
      x[rows[at]] -= values[at] * own;
    }
  }
  for (std::size_t column = n; column-- > 0;) {
    Row sum = x[column];
    for (std::int32_t at = start_[column]; at < start_[column + 1]; ++at) {
      sum -= values[at] * x[rows[at]];
    }
    x[column] = sum * over_[column];
  }
}

}  // namespace haptrial::deformable
