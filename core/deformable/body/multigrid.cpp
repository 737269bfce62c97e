#include "core/deformable/body/multigrid.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/deformable/body/lattice_levels.h"

namespace haptrial::deformable {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kDense = 64;  // points at most that are solved for at once

using Block = Eigen::Map<const Matrix3d>;

/// Data of a level beside its matrix.
struct GridLevel {
  const BlockMatrix* matrix{};
  std::vector<Matrix3d> inverse;  // of the diagonal blocks; 0: held
  Vectors right, left_over, solution;

  bool invert(std::span<const std::uint8_t> held) {
    inverse.resize(matrix->rows());
    for (std::size_t row = 0; row < inverse.size(); ++row) {
      if (!held.empty() && held[row] != 0) {
        inverse[row].setZero();
        continue;
      }
      const Eigen::LLT<Matrix3d> factors{Matrix3d(Block(matrix->block(matrix->row_start(row))))};
      if (factors.info() != Eigen::Success) {
        return false;
      }
      inverse[row] = factors.solve(Matrix3d::Identity());
    }
    return true;
  }

  /// solution = (D + L)^-1 right, left_over = right - A solution
  void sweep_forwards() {
    const std::size_t n = inverse.size();
    left_over = right;
    solution.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Vector3d z = inverse[i] * left_over[i];
      solution[i] = z;
      for (auto at = matrix->row_start(i) + 1; at < matrix->row_start(i + 1); ++at) {
        left_over[static_cast<std::size_t>(matrix->column(at))].noalias() -=
            Block(matrix->block(at)).transpose() * z;
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      left_over[i] = -above(i);
    }
  }

  /// solution += (D + U)^-1 (right - A solution)
  void sweep_backwards() {
    left_over = right;
    for (std::size_t i = 0; i < inverse.size(); ++i) {
      const Vector3d z = solution[i];
      for (auto at = matrix->row_start(i) + 1; at < matrix->row_start(i + 1); ++at) {
        left_over[static_cast<std::size_t>(matrix->column(at))].noalias() -=
            Block(matrix->block(at)).transpose() * z;
      }
    }
    for (std::size_t i = inverse.size(); i-- > 0;) {
      solution[i].noalias() = inverse[i] * (left_over[i] - above(i));
    }
  }

  /// The product of the blocks right of the diagonal with the solution.
  Vector3d above(std::size_t i) const {
    Vector3d sum = Vector3d::Zero();
    for (auto at = matrix->row_start(i) + 1; at < matrix->row_start(i + 1); ++at) {
      sum.noalias() +=
          Block(matrix->block(at)) * solution[static_cast<std::size_t>(matrix->column(at))];
    }
    return sum;
  }
};

Eigen::MatrixXd dense_of(const BlockMatrix& a) {
  const auto n = static_cast<Eigen::Index>(3 * a.rows());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t row = 0; row < a.rows(); ++row) {
    for (auto at = a.row_start(row); at < a.row_start(row + 1); ++at) {
      dense.block<3, 3>(3 * a.column(at), static_cast<Eigen::Index>(3 * row)) =
          Block(a.block(at)).transpose();
    }
  }
  return dense;  // its lower half
}

}  // namespace

struct Multigrid::Impl {
  std::span<const std::uint8_t> held;
  bool fits{};
  std::vector<std::unique_ptr<CoarseLattice>> lattices;
  std::vector<GridLevel> levels;  // one more than lattices
  Eigen::LLT<Eigen::MatrixXd> last;
  Eigen::VectorXd flat;

  void cycle(std::size_t level) {
    GridLevel& here = levels[level];
    if (level == lattices.size() && level > 0) {
      for (std::size_t i = 0; i < here.right.size(); ++i) {
        flat.segment<3>(static_cast<Eigen::Index>(3 * i)) = here.right[i];
      }
      last.solveInPlace(flat);
      here.solution.resize(here.right.size());
      for (std::size_t i = 0; i < here.right.size(); ++i) {
        here.solution[i] = flat.segment<3>(static_cast<Eigen::Index>(3 * i));
      }
      return;
    }
    here.sweep_forwards();
    if (level < lattices.size()) {
      lattices[level]->restrict_to_coarse(here.left_over, levels[level + 1].right);
      cycle(level + 1);
      lattices[level]->add_to_fine(levels[level + 1].solution, here.solution);
    }
    here.sweep_backwards();
  }
};

Multigrid::Multigrid(std::span<const Vector3d> vertices, const BlockMatrix& pattern,
                     std::span<const std::uint8_t> held)
    : impl_(std::make_unique<Impl>()) {
  impl_->held = held;
  auto points = lattice_points(vertices, pattern);
  impl_->fits = points.has_value();
  if (!points) {
    return;
  }
  std::size_t count = points->size();
  while (count > kDense) {
    auto coarse = std::make_unique<CoarseLattice>(
        *points, impl_->lattices.empty() ? held : std::span<const std::uint8_t>());
    if (2 * coarse->points().size() > count && coarse->points().size() > 8 * kDense) {
      break;
    }
    points->assign(coarse->points().begin(), coarse->points().end());
    count = points->size();
    impl_->lattices.push_back(std::move(coarse));
  }
  impl_->levels.resize(impl_->lattices.size() + 1);
}

Multigrid::~Multigrid() = default;
Multigrid::Multigrid(Multigrid&&) noexcept = default;

bool Multigrid::fits() const { return impl_->fits; }

bool Multigrid::set(const BlockMatrix& a) {
  Impl& m = *impl_;
  m.levels[0].matrix = &a;
  for (std::size_t i = 0; i < m.lattices.size(); ++i) {
    m.lattices[i]->project(*m.levels[i].matrix);
    m.levels[i + 1].matrix = &m.lattices[i]->matrix();
  }
  for (std::size_t i = 0; i < m.levels.size(); ++i) {
    if (!m.levels[i].invert(i == 0 ? m.held : std::span<const std::uint8_t>())) {
      return false;
    }
  }
  if (m.lattices.empty()) {
    return true;
  }
  m.last.compute(dense_of(*m.levels.back().matrix));
  m.flat.resize(static_cast<Eigen::Index>(3 * m.levels.back().matrix->rows()));
  return m.last.info() == Eigen::Success;
}

void Multigrid::apply(const Vectors& r, Vectors& z) {
  GridLevel& finest = impl_->levels[0];
  finest.right = r;
  impl_->cycle(0);
  z = finest.solution;
}

}  // namespace haptrial::deformable
