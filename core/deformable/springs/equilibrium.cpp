#include "core/deformable/springs/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "core/deformable/springs/spring_tangent.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

constexpr double kEnough = 1e-4;  // of the fall that the slope promises (Armijo)
constexpr int kHalvings = 30;     // of a step of the line search
constexpr double kLeft = 1e-3;    // of the forces, by a step far from the end

/// Energy and forces; held vertices stay where they are put.
class HeldProblem {
 public:
  HeldProblem(const SpringBody& body, const LoadCase& load)
      : body_(body), held_(held_flags(body.rest.size(), load.holds)) {
    external_.assign(body.rest.size(), Vector3d::Zero());
    for (const NodalForce& nodal : load.forces) {
      external_[static_cast<std::size_t>(nodal.vertex)] += nodal.force;
    }
  }
  const std::vector<std::uint8_t>& held() const { return held_; }

  double energy(const Vectors& x) const {
    double energy = spring_energy(body_, x);
    for (std::size_t v = 0; v < x.size(); ++v) {
      energy -= external_[v].dot(x[v] - body_.rest[v]);
    }
    return energy;
  }

  /// The forces that nothing balances, 0 on held vertices; `largest` receives the largest that acts
  /// anywhere.
  Vectors unbalanced(const Vectors& x, double& largest) const {
    Vectors r = spring_forces(body_, x);
    largest = 0;
    for (std::size_t v = 0; v < x.size(); ++v) {
      if (held_[v] != 0) {
        largest = std::max(largest, r[v].norm());
        r[v].setZero();
        continue;
      }
      largest = std::max(largest, external_[v].norm());
      r[v] += external_[v];
    }
    return r;
  }

 private:
  const SpringBody& body_;
  std::vector<std::uint8_t> held_;
  Vectors external_;
};

double dot(const Vectors& a, const Vectors& b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    sum += a[v].dot(b[v]);
  }
  return sum;
}

double norm(const Vectors& a) { return std::sqrt(dot(a, a)); }

double largest_coordinate(const Vectors& a) {
  double largest = 0;
  for (const Vector3d& v : a) {
    if (!v.allFinite()) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    largest = std::max(largest, v.cwiseAbs().maxCoeff());
  }
  return largest;
}

Vectors moved(const Vectors& x, const Vectors& by, double share) {
  Vectors next = x;
  for (std::size_t v = 0; v < x.size(); ++v) {
    next[v] += share * by[v];
  }
  return next;
}

/// @returns whether `x` has moved to where the energy is lower, or, where energies cannot tell any
/// more, to where less is unbalanced.
bool search_line(const HeldProblem& problem, const Vectors& direction, const Vectors& force,
                 bool definite, Vectors& x) {
  const double before = problem.energy(x);
  const double slope = dot(force, direction);
  const double rounding = 1e-14 * std::abs(before) + 1e-300;
  double share = 1;
  for (int i = 0; i < kHalvings; ++i, share *= 0.5) {
    Vectors next = moved(x, direction, share);
    const double fall = before - problem.energy(next);
    double unused = 0;
    const bool lower = fall >= kEnough * share * slope && slope * share > 10 * rounding;
    const bool calmer = !lower && definite && std::abs(fall) <= 1e3 * rounding &&
                        norm(problem.unbalanced(next, unused)) < norm(force);
    if (!lower && !calmer) {
      continue;
    }
    x = std::move(next);
    return true;
  }
  return false;
}

/// Leaves a saddle along its most falling direction, by inverse iteration with the raised Hessian,
/// which is factorized then. @returns whether the energy has fallen.
bool leave_saddle(const HeldProblem& problem, SpringTangent& tangent, const Vectors& force,
                  double extent, Vectors& x) {
  constexpr int kInverseIterations = 10;
  RandomStream random(0, "saddle");
  Vectors direction(x.size(), Vector3d::Zero());
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (problem.held()[v] == 0) {
      direction[v] = {random.normal(), random.normal(), random.normal()};
    }
  }
  for (int i = 0; i < kInverseIterations; ++i) {
    const Vectors last = moved(Vectors(x.size(), Vector3d::Zero()), direction, 1 / norm(direction));
    tangent.solve(last, 0.0, direction);
  }
  const double before = problem.energy(x);
  double way = 0.1 * extent * (dot(direction, force) < 0 ? -1 : 1) / largest_coordinate(direction);
  for (int i = 0; i < kHalvings; ++i, way *= 0.5) {
    for (const double side : {way, -way}) {
      Vectors next = moved(x, direction, side);
      if (problem.energy(next) >= before - 1e-12 * std::abs(before)) {
        continue;
      }
      x = std::move(next);
      return true;
    }
  }
  return false;
}

void check_free_load(const SpringBody& body, const LoadCase& load) {
  geometry::TetMesh mesh;
  mesh.vertices.assign(body.rest.begin(), body.rest.end());
  mesh.tetrahedra.assign(body.tetrahedra.begin(), body.tetrahedra.end());
  check_load(mesh, load);
}

double extent_of(const Vectors& x) {
  Vector3d low = x.front();
  Vector3d high = x.front();
  for (const Vector3d& p : x) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

}  // namespace

Equilibrium equilibrium(const SpringBody& body, const LoadCase& load,
                        const NewtonSettings& settings, Vectors start) {
  check_free_load(body, load);
  Equilibrium found;
  found.positions = start.empty() ? body.rest : std::move(start);
  for (const Hold& hold : load.holds) {
    const auto v = static_cast<std::size_t>(hold.vertex);
    found.positions[v] = body.rest[v] + hold.displacement;
  }
  const HeldProblem problem(body, load);
  const double extent = extent_of(body.rest);
  SpringTangent tangent(body, problem.held());
  for (; found.iterations <= settings.iterations; ++found.iterations) {
    double largest = 0;
    const Vectors force = problem.unbalanced(found.positions, largest);
    found.residual = largest_coordinate(force);
    found.inverted = inverted_tetrahedra(body, found.positions);
    const double enough = settings.residual * largest;
    const bool balanced = found.residual <= enough;
    if (!std::isfinite(found.residual) || !tangent.set(found.positions)) {
      found.outcome = Settling::kUnstable;
      return found;
    }
    if (balanced && tangent.is_definite()) {
      found.outcome = Settling::kSettled;
      return found;
    }
    Vectors direction;
    if (!tangent.solve(force, std::max(kLeft * norm(force), 0.3 * enough), direction)) {
      found.outcome = Settling::kUnstable;
      return found;
    }
    if (!balanced &&
        search_line(problem, direction, force, tangent.seems_definite(), found.positions)) {
      continue;
    }
    if (tangent.is_definite()) {
      break;
    }
    if (!leave_saddle(problem, tangent, force, extent, found.positions)) {
      found.outcome = Settling::kUnstable;
      return found;
    }
  }
  return found;
}

}  // namespace haptrial::deformable
