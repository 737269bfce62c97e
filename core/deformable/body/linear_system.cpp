#include "core/deformable/body/linear_system.h"

#include <optional>

#include "core/base/error.h"
#include "core/deformable/body/cholesky.h"
#include "core/deformable/body/conjugate_gradients.h"
#include "core/deformable/body/multigrid.h"

namespace haptrial::deformable {

struct LinearSystem::Impl {
  std::span<const std::uint8_t> held;
  std::optional<Cholesky> cholesky;
  std::optional<Multigrid> multigrid;
  Preconditioner precondition;
  const BlockMatrix* matrix{};
};

LinearSolver faster_solver(std::size_t vertices, double poisson) {
  constexpr double kStiff = 0.4995;           // above it conjugate gradients take very long ...
  constexpr std::size_t kFactorable = 20000;  // ... but more vertices take long to factorize
  return poisson > kStiff && vertices < kFactorable ? LinearSolver::kCholesky
                                                    : LinearSolver::kConjugateGradients;
}

LinearSystem::LinearSystem(std::span<const Eigen::Vector3d> vertices, const BlockMatrix& pattern,
                           std::span<const std::uint8_t> held, LinearSolver solver)
    : impl_(std::make_unique<Impl>()) {
  impl_->held = held;
  if (solver == LinearSolver::kCholesky) {
    impl_->cholesky.emplace(pattern, held);
  } else {
    impl_->multigrid.emplace(vertices, pattern, held);
  }
}

LinearSystem::~LinearSystem() = default;
LinearSystem::LinearSystem(LinearSystem&&) noexcept = default;

void LinearSystem::set(BlockMatrix& a) {
  impl_->matrix = &a;
  if (!impl_->cholesky) {
    Multigrid& grid = *impl_->multigrid;
    if (grid.fits() && grid.set(a)) {
      impl_->precondition = [&grid](const Vectors& r, Vectors& z) { grid.apply(r, z); };
    } else {
      impl_->precondition = block_jacobi(a, impl_->held);
    }
    return;
  }
  if (!impl_->cholesky->factorize_raised(a)) {
    throw RunError("the stiffness could not be factorized");
  }
}

int LinearSystem::solve(const Vectors& b, double residual, Vectors& x) {
  if (impl_->cholesky) {
    impl_->cholesky->solve(b, x);
    return 1;
  }
  return conjugate_gradients(*impl_->matrix, b, impl_->held, impl_->precondition, {residual}, x)
      .iterations;
}

}  // namespace haptrial::deformable
