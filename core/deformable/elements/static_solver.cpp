#include "core/deformable/elements/static_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/error.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

/// The load as fields over all vertices.
struct Fields {
  std::vector<std::uint8_t> held;
  Vectors moved;  // where held
  Vectors force;
};

Fields fields_of(const ElasticBody& body, const LoadCase& load) {
  const std::size_t n = body.mesh().vertices.size();
  Fields fields{std::vector<std::uint8_t>(n, 0), Vectors(n, Vector3d::Zero()),
                Vectors(n, Vector3d::Zero())};
  for (const Hold& hold : load.holds) {
    fields.held[static_cast<std::size_t>(hold.vertex)] = 1;
    fields.moved[static_cast<std::size_t>(hold.vertex)] = hold.displacement;
  }
  for (const NodalForce& nodal : load.forces) {
    fields.force[static_cast<std::size_t>(nodal.vertex)] += nodal.force;
  }
  return fields;
}

double dot(const Vectors& a, const Vectors& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += a[i].dot(b[i]);
  }
  return sum;
}

void add(Vectors& to, double scale, const Vectors& what) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i] += scale * what[i];
  }
}

double largest_poisson(const ElasticBody& body) {
  double largest = -1;
  for (const Material& m : body.elasticity().materials) {
    largest = std::max(largest, m.poisson);
  }
  return largest;
}

}  // namespace

struct StaticSolver::Impl {
  const ElasticBody& body;
  StaticOptions options;
  BlockMatrix matrix;
  // Vectors of the load:
  Fields fields;
  std::vector<std::uint8_t> held;  // of the system
  std::optional<LinearSystem> system;
  // Vectors of the body's positions:
  Vectors u;
  Vectors elastic;
  Vectors unbalanced;
  double energy{};
  double residual{};
  double previous{};  // residual
  double reached{};   // share of the load
  StaticResult result;

  Impl(const ElasticBody& b, const StaticOptions& o)
      : body(b), options(o), matrix(b.patches().groups(), b.mesh().vertices.size()) {}

  void begin(const LoadCase& load);
  void balance(double share);
  double scale(double share) const;
  double enough(double share) const;
  bool predict(double share);
  bool step_to(double share);
  bool newton_step(double share);
  bool search(double share, const Vectors& direction);
  [[noreturn]] void tell_failure(const LoadCase& load, double step) const;
};

void StaticSolver::Impl::begin(const LoadCase& load) {
  check_load(body.mesh(), load);
  fields = fields_of(body, load);
  if (!system || held != fields.held) {
    held = fields.held;
    const auto free = static_cast<std::size_t>(std::count(held.begin(), held.end(), 0));
    const LinearSolver solver = options.solver == LinearSolver::kAutomatic
                                    ? faster_solver(free, largest_poisson(body))
                                    : options.solver;
    system.emplace(body.mesh().vertices, matrix, held, solver);
  }
  u.assign(held.size(), Vector3d::Zero());
  reached = 0;
  result = {};
}

/// Residual of load and elastic forces on the free vertices, and its norm.
void StaticSolver::Impl::balance(double share) {
  unbalanced.resize(u.size());
  double squares = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    unbalanced[i] =
        held[i] != 0 ? Vector3d::Zero().eval() : (share * fields.force[i] + elastic[i]).eval();
    squares += unbalanced[i].squaredNorm();
  }
  residual = std::sqrt(squares);
}

/// The norm of loads and reactions.
double StaticSolver::Impl::scale(double share) const {
  double squares = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    squares += held[i] != 0 ? elastic[i].squaredNorm() : (share * fields.force[i]).squaredNorm();
  }
  return std::sqrt(squares);
}

/// The unbalanced force that counts as none, which rounding bounds below.
double StaticSolver::Impl::enough(double share) const {
  constexpr double kRoundings = 8;
  // The linear law computes with displacements alone, the others with whole gradients.
  const double rounding =
      body.elasticity().law == Law::kLinear ? 0 : kRoundings * body.rounding_force();
  return std::max(options.tolerance * scale(share), rounding);
}

/// Moves the held vertices on, and the others as the stiffness says. False: that inverts a
/// tetrahedron, or no part of it helps.
bool StaticSolver::Impl::predict(double share) {
  constexpr double kForcing = 1e-3;  // what is left of the unbalanced force where steps follow
  const bool linear = body.elasticity().law == Law::kLinear;
  body.stiffness(u, elastic, matrix);
  balance(share);
  Vectors move = fields.moved;
  bool moves = false;
  for (Vector3d& v : move) {
    v *= share - reached;
    moves = moves || !v.isZero(0);
  }
  Vectors pull(u.size());
  matrix.multiply(move, pull);
  Vectors right = unbalanced;
  for (std::size_t i = 0; i < u.size(); ++i) {
    right[i] -= held[i] != 0 ? right[i] : pull[i];
  }
  previous = std::sqrt(dot(right, right));
  system->set(matrix);
  Vectors direction;
  const double wanted = (linear ? 0.3 * options.tolerance : kForcing) * previous;
  result.linear_iterations += system->solve(right, wanted, direction);
  ++result.newton_steps;
  if (!moves && !linear) {
    energy = body.energy(u);
    return residual <= enough(share) || search(share, direction);
  }
  add(u, 1, move);
  add(u, 1, direction);
  energy = body.forces(u, elastic);
  return std::isfinite(energy);
}

bool StaticSolver::Impl::step_to(double share) {
  const Vectors before = u;
  bool going = predict(share);
  for (int i = 0; going && i < options.most_newton_steps; ++i) {
    balance(share);
    if (residual <= enough(share)) {
      reached = share;
      return true;
    }
    going = newton_step(share);
  }
  u = before;
  return false;
}

bool StaticSolver::Impl::newton_step(double share) {
  // Eisenstat and Walker: as exact as the last step was good.
  constexpr double kLoosest = 1e-2;
  const double ratio = previous > 0 ? residual / previous : 1;
  const double forcing = std::min(kLoosest, 0.5 * ratio * ratio);
  body.stiffness(u, elastic, matrix);
  system->set(matrix);
  Vectors direction;
  const double wanted = std::max(forcing * residual, 0.3 * enough(share));
  result.linear_iterations += system->solve(unbalanced, wanted, direction);
  ++result.newton_steps;
  previous = residual;
  return search(share, direction);
}

/// Halves the step until the potential falls enough, or the unbalanced force falls where rounding
/// hides the potential's fall. False: no step helps.
bool StaticSolver::Impl::search(double share, const Vectors& direction) {
  constexpr double kArmijo = 1e-4;
  constexpr int kMost = 30;
  const Vectors start = u;
  const double slope = dot(unbalanced, direction);
  const double before = energy;
  const double residual_before = residual;
  const double work = share * dot(fields.force, direction);
  double step = 1;
  for (int i = 0; i < kMost; ++i, step *= 0.5) {
    u = start;
    add(u, step, direction);
    energy = body.forces(u, elastic);
    if (!std::isfinite(energy)) {
      continue;
    }
    balance(share);
    const double change = energy - before - step * work;
    if (change <= -kArmijo * step * slope || residual < 0.5 * residual_before) {
      return true;
    }
    if (slope > 0 && residual < residual_before && slope < 1e-9 * std::abs(before)) {
      return true;
    }
  }
  u = start;
  return false;
}

/// Names the tetrahedron that is stretched most beside its volume where the load was still borne.
void StaticSolver::Impl::tell_failure(const LoadCase& load, double step) const {
  const std::vector<TetState> states = body.states(u);
  const auto distortion = [&](const TetState& state) {
    return state.gradient.squaredNorm() / std::pow(state.gradient.determinant(), 2.0 / 3);
  };
  const auto worst = std::max_element(
      states.begin(), states.end(),
      [&](const TetState& a, const TetState& b) { return distortion(a) < distortion(b); });
  throw InputError(fmt::format(
      "load '{}' tears or inverts the body: there is no balance beyond {:.4g} % of it (a step of "
      "{:.2g} % fails), where tetrahedron {} is distorted most, with {:.3g} % of its volume",
      load.name, 100 * reached, 100 * step, worst - states.begin(),
      100 * worst->gradient.determinant()));
}

double static_memory(std::size_t vertices, std::size_t tetrahedra, LinearSolver solver) {
  constexpr double kByTet = 200;      // rest shape, layout, places of blocks
  constexpr double kByVertex = 1800;  // 14 blocks, and the vectors
  constexpr double kFill = 130;       // numbers of the factors, by vertices^(4/3)
  const auto n = static_cast<double>(vertices);
  const double factors =
      solver == LinearSolver::kConjugateGradients ? 0 : 8 * kFill * std::pow(n, 4.0 / 3);
  return kByVertex * n + kByTet * static_cast<double>(tetrahedra) + factors;
}

StaticSolver::StaticSolver(const ElasticBody& body, const StaticOptions& options)
    : impl_(std::make_unique<Impl>(body, options)) {}
StaticSolver::~StaticSolver() = default;
StaticSolver::StaticSolver(StaticSolver&&) noexcept = default;

StaticResult StaticSolver::solve(const LoadCase& load) {
  Impl& s = *impl_;
  s.begin(load);
  double step = 1;
  const double smallest = std::ldexp(1.0, -s.options.most_halvings);
  while (s.reached < 1) {
    const double share = std::min(1.0, s.reached + step);
    if (s.step_to(share)) {
      ++s.result.load_steps;
      step *= 2;
    } else {
      step *= 0.5;
      if (step < smallest) {
        s.tell_failure(load, 2 * step);
      }
    }
  }
  if (const std::int32_t tet = s.body.inverted(s.u); tet >= 0) {
    throw InputError(fmt::format(
        "load '{}' inverts tetrahedron {} by the {} law; lower the load or take neo-hookean",
        load.name, tet, name_of(s.body.elasticity().law)));
  }
  s.result.residual = s.residual / std::max(s.scale(1), 1e-300);
  s.result.energy = s.energy;
  s.result.displacement = s.u;
  s.result.elastic_force = s.elastic;
  return std::move(s.result);
}

StaticResult solve_static(const ElasticBody& body, const LoadCase& load,
                          const StaticOptions& options) {
  return StaticSolver(body, options).solve(load);
}

}  // namespace haptrial::deformable
