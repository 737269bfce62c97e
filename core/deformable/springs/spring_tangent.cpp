#include "core/deformable/springs/spring_tangent.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "core/deformable/body/cholesky.h"
#include "core/deformable/body/conjugate_gradients.h"
#include "core/deformable/body/fastest_vibration.h"
#include "core/deformable/body/multigrid.h"
#include "core/deformable/springs/spring_hessian.h"

namespace haptrial::deformable {
namespace {

constexpr std::size_t kLarge = 1500;  // free vertices: below, CHOLMOD is as fast
constexpr int kSoon = 200;            // iterations; CHOLMOD takes as long as some hundreds

}  // namespace

struct SpringTangent::Impl {
  const SpringBody& body;
  std::vector<std::uint8_t> held;
  SpringHessian hessian;
  std::optional<Multigrid> multigrid;  // none: CHOLMOD alone
  std::optional<Cholesky> cholesky;
  bool by_multigrid{false};  // what set() has made ready
  bool definite{false};

  Impl(const SpringBody& b, std::vector<std::uint8_t> h) : body(b), held(std::move(h)), hessian(b) {
    if (static_cast<std::size_t>(std::count(held.begin(), held.end(), 0)) < kLarge) {
      return;
    }
    multigrid.emplace(body.rest, hessian.matrix(), held);
    if (!multigrid->fits()) {
      multigrid.reset();
    }
  }

  bool factorize() {
    multigrid.reset();  // such a body is not tried again
    by_multigrid = false;
    if (!cholesky) {
      cholesky.emplace(hessian.matrix(), held);
    }
    const auto raised = cholesky->factorize_raised(hessian.matrix());
    definite = raised == 0.0;
    return raised.has_value();
  }

  bool converges(const Vectors& force, double residual, Vectors& x) {
    const auto precondition = [this](const Vectors& r, Vectors& z) { multigrid->apply(r, z); };
    const GradientResult found =
        conjugate_gradients(hessian.matrix(), force, held, precondition, {residual, kSoon}, x);
    return !found.negative_curvature && found.residual <= residual;
  }
};

SpringTangent::SpringTangent(const SpringBody& body, std::vector<std::uint8_t> held)
    : impl_(std::make_unique<Impl>(body, std::move(held))) {}
SpringTangent::~SpringTangent() = default;

bool SpringTangent::set(std::span<const Eigen::Vector3d> positions) {
  Impl& t = *impl_;
  t.hessian.assemble(t.body, positions);
  if (t.multigrid && t.multigrid->set(t.hessian.matrix())) {
    t.by_multigrid = true;
    t.definite = true;
    return true;
  }
  return t.factorize();
}

bool SpringTangent::solve(const Vectors& force, double residual, Vectors& direction) {
  Impl& t = *impl_;
  if (t.by_multigrid && t.converges(force, residual, direction)) {
    return true;
  }
  if (t.by_multigrid && !t.factorize()) {
    return false;
  }
  t.cholesky->solve(force, direction);
  return true;
}

bool SpringTangent::seems_definite() const { return impl_->definite; }

bool SpringTangent::is_definite() {
  constexpr double kMillionth = 1e-6;
  Impl& t = *impl_;
  if (!t.by_multigrid) {
    return t.definite;
  }
  RandomStream random(0, "definite");
  Vectors force(t.held.size(), Eigen::Vector3d::Zero());
  double squares = 0;
  for (std::size_t v = 0; v < force.size(); ++v) {
    if (t.held[v] == 0) {
      force[v] = {random.normal(), random.normal(), random.normal()};
      squares += force[v].squaredNorm();
    }
  }
  Vectors unused;
  return t.converges(force, kMillionth * std::sqrt(squares), unused) ||
         (t.factorize() && t.definite);
}

std::optional<std::vector<Eigen::Vector3d>> small_displacements(
    const SpringBody& body, std::span<const Hold> holds, std::span<const Eigen::Vector3d> positions,
    std::span<const Eigen::Vector3d> forces) {
  SpringHessian hessian(body);
  hessian.assemble(body, positions);
  Cholesky factors(hessian.matrix(), held_flags(body.rest.size(), holds));
  if (!factors.factorize(hessian.matrix())) {
    return std::nullopt;
  }
  Vectors result;
  factors.solve(Vectors(forces.begin(), forces.end()), result);
  return result;
}

double fastest_vibration(const SpringBody& body, std::span<const Eigen::Vector3d> positions,
                         std::span<const std::int32_t> held) {
  SpringHessian hessian(body);
  hessian.assemble(body, positions);
  return fastest_vibration(hessian.matrix(), body.masses, held);
}

double stable_step(const SpringBody& body, std::span<const std::int32_t> held) {
  const double fastest = fastest_vibration(body, body.rest, held);
  return fastest > 0 ? 2 / fastest : std::numeric_limits<double>::infinity();
}

}  // namespace haptrial::deformable
