#include "core/deformable/elements/dynamic_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

void check_options(const DynamicOptions& o) {
  const auto refuse = [](const char* what, double value, const char* allowed) {
    throw InputError(fmt::format("the {} is {}; allowed: {}", what, value, allowed));
  };
  if (!(o.step > 0) || !std::isfinite(o.step)) {
    refuse("time step", o.step, "above 0 s");
  }
  if (!(o.mass_damping >= 0)) {
    refuse("mass damping", o.mass_damping, "0 or more");
  }
  if (!(o.stiffness_damping >= 0)) {
    refuse("stiffness damping", o.stiffness_damping, "0 or more");
  }
  if (!(o.tolerance > 0)) {
    refuse("tolerance", o.tolerance, "above 0");
  }
}

/// Direct factors pay where they are used again.
LinearSolver dynamic_choice(const ElasticBody& body, std::size_t free) {
  constexpr std::size_t kFactorable = 20000;  // vertices
  return body.elasticity().law == Law::kLinear && free < kFactorable
             ? LinearSolver::kCholesky
             : LinearSolver::kConjugateGradients;
}

double inner(const Vectors& a, const Vectors& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += a[i].dot(b[i]);
  }
  return sum;
}

}  // namespace

/// A step by d = u_next - u, with s = 1/2 for the midpoint and 1 for backward Euler, balances
///
///     M (d - h v) / (s h²) + C d / h = load + elastic(u + s d)
///
/// and gives v_next = d / h, or 2 d / h - v at the midpoint. It is where the potential
///
///     |d - h v|²_M / (2 s h²) + d C d / (2 h) - load d + energy(u + s d) / s
///
/// is stationary.
struct DynamicSolver::Impl {
  const ElasticBody& body;
  DynamicOptions options;
  std::vector<std::uint8_t> held;
  Motion motion;
  double time{};
  static constexpr double kShare = 0.5;  // s, of the midpoint
  BlockMatrix matrix;
  BlockMatrix damping;  // beta K, where beta > 0
  std::unique_ptr<LinearSystem> system;
  bool factorized{};
  // Within a step:
  Vectors d;
  Vectors elastic;
  Vectors damped;  // beta K d
  Vectors unbalanced;
  double potential{};
  double residual{};

  Impl(const ElasticBody& b, const DynamicOptions& o)
      : body(b),
        options(o),
        matrix(b.patches().groups(), b.mesh().vertices.size()),
        damping(matrix) {}

  bool damps() const { return options.stiffness_damping > 0; }
  Vectors moved(double by) const;
  void set_damping();
  void evaluate(const Vectors& force);
  void set_matrix();
  double force_scale(const Vectors& force) const;
  bool search(const Vectors& direction, const Vectors& force);
  void finish();
};

Vectors DynamicSolver::Impl::moved(double by) const {
  Vectors u = motion.displacement;
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i] += by * d[i];
  }
  return u;
}

void DynamicSolver::Impl::set_damping() {
  const bool constant = body.elasticity().law == Law::kLinear;
  if (!damps() || (constant && factorized)) {
    return;
  }
  body.stiffness(motion.displacement, elastic, damping);
  damping.scale_and_add(options.stiffness_damping, std::vector<double>(held.size(), 0.0));
}

/// Forces and potential at d.
void DynamicSolver::Impl::evaluate(const Vectors& force) {
  const double h = options.step;
  potential = body.forces(moved(kShare), elastic) / kShare;
  if (!std::isfinite(potential)) {
    return;
  }
  damped.assign(d.size(), Vector3d::Zero());
  if (damps()) {
    damping.multiply(d, damped);
  }
  const std::span<const double> mass = body.masses();
  unbalanced.assign(d.size(), Vector3d::Zero());
  double squares = 0;
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (held[i] != 0) {
      continue;
    }
    const Vector3d off = d[i] - h * motion.velocity[i];
    const Vector3d drag = (options.mass_damping * mass[i] * d[i] + damped[i]) / h;
    unbalanced[i] = force[i] + elastic[i] - drag - mass[i] / (kShare * h * h) * off;
    potential += mass[i] * off.squaredNorm() / (2 * kShare * h * h) + 0.5 * d[i].dot(drag) -
                 force[i].dot(d[i]);
    squares += unbalanced[i].squaredNorm();
  }
  residual = std::sqrt(squares);
}

void DynamicSolver::Impl::set_matrix() {
  if (factorized && body.elasticity().law == Law::kLinear) {
    return;
  }
  const double h = options.step;
  body.stiffness(moved(kShare), elastic, matrix);
  std::vector<double> diagonal(held.size());
  for (std::size_t i = 0; i < held.size(); ++i) {
    diagonal[i] = body.masses()[i] * (1 / (kShare * h * h) + options.mass_damping / h);
  }
  matrix.scale_and_add(kShare, diagonal);
  if (damps()) {
    matrix.add(1 / h, damping);
  }
  system->set(matrix);
  factorized = true;
}

double DynamicSolver::Impl::force_scale(const Vectors& force) const {
  const double h = options.step;
  double squares = 0;
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (held[i] != 0) {
      continue;
    }
    squares += force[i].squaredNorm() + elastic[i].squaredNorm() +
               (body.masses()[i] / h * motion.velocity[i]).squaredNorm();
  }
  return std::sqrt(squares);
}

bool DynamicSolver::Impl::search(const Vectors& direction, const Vectors& force) {
  constexpr int kMost = 30;
  constexpr double kArmijo = 1e-4;
  const Vectors start = d;
  const double before = potential;
  const double residual_before = residual;
  const double slope = inner(unbalanced, direction);
  double length = 1;
  for (int i = 0; i < kMost; ++i, length *= 0.5) {
    for (std::size_t v = 0; v < d.size(); ++v) {
      d[v] = start[v] + length * direction[v];
    }
    evaluate(force);
    if (!std::isfinite(potential)) {
      continue;
    }
    if (potential <= before - kArmijo * length * slope || residual < 0.5 * residual_before) {
      return true;
    }
  }
  return false;
}

void DynamicSolver::Impl::finish() {
  const double h = options.step;
  for (std::size_t i = 0; i < d.size(); ++i) {
    motion.displacement[i] += d[i];
    motion.velocity[i] = 2 / h * d[i] - motion.velocity[i];
  }
  time += h;
}

DynamicSolver::DynamicSolver(const ElasticBody& body, const std::vector<Hold>& holds,
                             const DynamicOptions& options) {
  check_options(options);
  LoadCase load{"holds", holds, {}};
  load.forces.push_back({0, Vector3d::UnitX()});  // a load needs something that acts
  check_load(body.mesh(), load);
  impl_ = std::make_unique<Impl>(body, options);
  Impl& s = *impl_;
  const std::size_t n = body.mesh().vertices.size();
  s.held.assign(n, 0);
  s.motion = {Vectors(n, Vector3d::Zero()), Vectors(n, Vector3d::Zero())};
  for (const Hold& hold : holds) {
    s.held[static_cast<std::size_t>(hold.vertex)] = 1;
    s.motion.displacement[static_cast<std::size_t>(hold.vertex)] = hold.displacement;
  }
  const auto free = static_cast<std::size_t>(std::count(s.held.begin(), s.held.end(), 0));
  s.system = std::make_unique<LinearSystem>(
      body.mesh().vertices, s.matrix, s.held,
      options.solver == LinearSolver::kAutomatic ? dynamic_choice(body, free) : options.solver);
}

DynamicSolver::~DynamicSolver() = default;
DynamicSolver::DynamicSolver(DynamicSolver&&) noexcept = default;

const Motion& DynamicSolver::motion() const { return impl_->motion; }
double DynamicSolver::time() const { return impl_->time; }

void DynamicSolver::set_motion(const Motion& motion) {
  for (std::size_t i = 0; i < impl_->held.size(); ++i) {
    if (impl_->held[i] != 0) {
      continue;
    }
    impl_->motion.displacement[i] = motion.displacement[i];
    impl_->motion.velocity[i] = motion.velocity[i];
  }
}

void DynamicSolver::step(const Vectors& force) {
  constexpr int kMostNewton = 30;
  constexpr double kRoundings = 8;
  constexpr double kForcing = 1e-3;  // what a linear solve leaves of the unbalanced force
  Impl& s = *impl_;
  s.d.assign(s.held.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < s.held.size(); ++i) {
    if (s.held[i] == 0) {
      s.d[i] = s.options.step * s.motion.velocity[i];
    }
  }
  s.set_damping();
  s.evaluate(force);
  if (!std::isfinite(s.potential)) {  // as fast as this a tetrahedron would turn inside out
    s.d.assign(s.held.size(), Vector3d::Zero());
    s.evaluate(force);
  }
  for (int i = 0; i < kMostNewton && std::isfinite(s.potential); ++i) {
    const double enough =
        std::max(s.options.tolerance * s.force_scale(force), kRoundings * s.body.rounding_force());
    if (s.residual <= enough) {
      s.finish();
      return;
    }
    s.set_matrix();
    Vectors direction;
    s.system->solve(s.unbalanced, std::max(0.3 * enough, kForcing * s.residual), direction);
    if (!s.search(direction, force)) {
      break;
    }
  }
  throw InputError(
      fmt::format("no balance is found in the step of {} s after {} s; lower the time "
                  "step or the load",
                  s.options.step, s.time));
}

double DynamicSolver::energy() const {
  double kinetic = 0;
  for (std::size_t i = 0; i < impl_->held.size(); ++i) {
    kinetic += 0.5 * impl_->body.masses()[i] * impl_->motion.velocity[i].squaredNorm();
  }
  return kinetic + impl_->body.energy(impl_->motion.displacement);
}

}  // namespace haptrial::deformable
