#include "core/deformable/body/cholesky.h"

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>
#include <cmath>

namespace haptrial::deformable {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

struct Cholesky::Impl {
  std::vector<std::int32_t> place;  // of a free vertex among the free ones; -1: held
  Matrix matrix;                    // its lower half
  Eigen::CholmodSupernodalLLT<Matrix, Eigen::Lower> factors;
  Eigen::VectorXd right;

  /// Row i of blocks above the diagonal is column i of blocks below it.
  template <class Function>
  void for_each(const BlockMatrix& a, Function&& function) const {
    for (std::size_t row = 0; row < a.rows(); ++row) {
      if (place[row] < 0) {
        continue;
      }
      for (int axis = 0; axis < 3; ++axis) {
        for (auto at = a.row_start(row); at < a.row_start(row + 1); ++at) {
          const std::int32_t to = place[static_cast<std::size_t>(a.column(at))];
          if (to < 0) {
            continue;
          }
          const bool diagonal = at == a.row_start(row);
          for (int i = diagonal ? axis : 0; i < 3; ++i) {
            function(3 * to + i, 3 * place[row] + axis, a.block(at)[axis + 3 * i]);
          }
        }
      }
    }
  }
};

Cholesky::Cholesky(const BlockMatrix& pattern, std::span<const std::uint8_t> held)
    : impl_(std::make_unique<Impl>()) {
  std::int32_t free = 0;
  for (const std::uint8_t is_held : held) {
    impl_->place.push_back(is_held != 0 ? -1 : free++);
  }
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(free);
  impl_->matrix.resize(n, n);
  impl_->right.resize(n);
  std::vector<int> counts(static_cast<std::size_t>(n), 0);
  impl_->for_each(pattern, [&](int, int col, double) { ++counts[static_cast<std::size_t>(col)]; });
  int* outer = impl_->matrix.outerIndexPtr();
  outer[0] = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    outer[i + 1] = outer[i] + counts[static_cast<std::size_t>(i)];
  }
  impl_->matrix.resizeNonZeros(outer[n]);
  std::size_t at = 0;
  impl_->for_each(pattern, [&](int row, int, double) {
    impl_->matrix.innerIndexPtr()[at] = row;
    impl_->matrix.valuePtr()[at++] = 1;
  });
  impl_->factors.cholmod().print = 0;  // a matrix that is not positive definite is our message
  impl_->factors.analyzePattern(impl_->matrix);
}

Cholesky::~Cholesky() = default;
Cholesky::Cholesky(Cholesky&&) noexcept = default;

bool Cholesky::factorize(const BlockMatrix& a) {
  double* value = impl_->matrix.valuePtr();
  impl_->for_each(a, [&](int, int, double v) { *value++ = v; });
  impl_->factors.factorize(impl_->matrix);
  return impl_->factors.info() == Eigen::Success;
}

std::optional<double> Cholesky::factorize_raised(BlockMatrix& a) {
  constexpr double kFirst = 1e-4;  // of the mean diagonal
  constexpr int kMost = 17;
  if (factorize(a)) {
    return 0.0;
  }
  double mean = 0;
  for (std::size_t row = 0; row < a.rows(); ++row) {
    const double* d = a.block(a.row_start(row));
    mean += (std::abs(d[0]) + std::abs(d[4]) + std::abs(d[8])) / 3;
  }
  double more = kFirst * mean / static_cast<double>(a.rows());
  double raised = 0;
  for (int i = 0; i < kMost && std::isfinite(mean); ++i, more *= 4) {
    a.scale_and_add(1, std::vector<double>(a.rows(), more));
    raised += more;
    if (factorize(a)) {
      return raised;
    }
  }
  return std::nullopt;
}

void Cholesky::solve(const Vectors& b, Vectors& x) {
  const auto& place = impl_->place;
  for (std::size_t v = 0; v < b.size(); ++v) {
    if (place[v] >= 0) {
      impl_->right.segment<3>(3 * place[v]) = b[v];
    }
  }
  const Eigen::VectorXd solution = impl_->factors.solve(impl_->right);
  x.assign(b.size(), Eigen::Vector3d::Zero());
  for (std::size_t v = 0; v < b.size(); ++v) {
    if (place[v] >= 0) {
      x[v] = solution.segment<3>(3 * place[v]);
    }
  }
}

}  // namespace haptrial::deformable
