#include "core/deformable/springs/equilibrium.h"

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/deformable/springs/free_hessian.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using Positions = std::vector<Vector3d>;
using Matrix = Eigen::SparseMatrix<double>;

constexpr double kEnough = 1e-4;      // of the fall that the slope promises (Armijo)
constexpr int kHalvings = 30;         // of a step of the line search
constexpr double kFirstShift = 1e-4;  // of the mean of the Hessian's diagonal
constexpr double kMoreShift = 10.0;
constexpr int kShifts = 12;

/// Energy, forces and Hessian by the coordinates of free vertices.
class FreeProblem {
 public:
  FreeProblem(const SpringBody& body, const LoadCase& load)
      : body_(body), hessian_(body, load.holds) {
    external_.assign(body.rest.size(), Vector3d::Zero());
    for (const NodalForce& nodal : load.forces) {
      external_[static_cast<std::size_t>(nodal.vertex)] += nodal.force;
    }
  }
  Eigen::Index size() const { return hessian_.size(); }

  double energy(const Positions& x) const {
    double energy = spring_energy(body_, x);
    for (std::size_t v = 0; v < x.size(); ++v) {
      energy -= external_[v].dot(x[v] - body_.rest[v]);
    }
    return energy;
  }

  /// The forces that nothing balances; `largest` receives the largest that acts anywhere.
  VectorXd unbalanced(const Positions& x, double& largest) const {
    const Positions inner = spring_forces(body_, x);
    VectorXd r(size());
    largest = 0;
    for (std::size_t v = 0; v < x.size(); ++v) {
      if (!hessian_.is_free(v)) {
        largest = std::max(largest, inner[v].norm());
        continue;
      }
      largest = std::max(largest, external_[v].norm());
      r.segment<3>(hessian_.first_of(v)) = inner[v] + external_[v];
    }
    return r;
  }

  Positions moved(const Positions& x, const VectorXd& by, double share) const {
    Positions next = x;
    for (std::size_t v = 0; v < x.size(); ++v) {
      if (hessian_.is_free(v)) {
        next[v] += share * by.segment<3>(hessian_.first_of(v));
      }
    }
    return next;
  }

  Matrix matrix(const Positions& x) { return hessian_.lower(body_, x); }

 private:
  const SpringBody& body_;
  FreeHessian hessian_;
  Positions external_;
};

/// Directions that lower the energy.
class Descent {
 public:
  Descent() { solver_.cholmod().print = 0; }  // what is not positive definite is no fault here
  /// @returns false where no shift makes the matrix positive definite.
  bool factorize(const Matrix& matrix) {
    if (!analyzed_) {
      solver_.analyzePattern(matrix);
      analyzed_ = true;
    }
    const double mean = matrix.diagonal().cwiseAbs().mean();
    double shift = 0;
    for (int i = 0; i < kShifts; ++i) {
      solver_.setShift(shift);
      solver_.factorize(matrix);
      if (solver_.info() == Eigen::Success) {
        definite_ = shift == 0;
        return true;
      }
      shift = shift == 0 ? kFirstShift * mean : kMoreShift * shift;
    }
    return false;
  }
  VectorXd direction(const VectorXd& force) const { return solver_.solve(force); }
  bool definite() const { return definite_; }  // without a shift

 private:
  Eigen::CholmodSupernodalLLT<Matrix> solver_;
  bool analyzed_{false};
  bool definite_{false};
};

/// @returns whether `x` has moved to where the energy is lower, or, where energies cannot tell any
/// more, to where less is unbalanced.
bool search_line(const FreeProblem& problem, const VectorXd& direction, const VectorXd& force,
                 bool definite, Positions& x) {
  const double before = problem.energy(x);
  const double slope = force.dot(direction);
  const double rounding = 1e-14 * std::abs(before) + 1e-300;
  double share = 1;
  for (int i = 0; i < kHalvings; ++i, share *= 0.5) {
    Positions next = problem.moved(x, direction, share);
    const double fall = before - problem.energy(next);
    double unused = 0;
    const bool lower = fall >= kEnough * share * slope && slope * share > 10 * rounding;
    const bool calmer = !lower && definite && std::abs(fall) <= 1e3 * rounding &&
                        problem.unbalanced(next, unused).norm() < force.norm();
    if (!lower && !calmer) {
      continue;
    }
    x = std::move(next);
    return true;
  }
  return false;
}

/// From a saddle along its most falling direction, by inverse iteration with the shifted matrix.
/// @returns whether the energy has fallen.
bool leave_saddle(const FreeProblem& problem, const Descent& descent, const VectorXd& force,
                  double extent, Positions& x) {
  constexpr int kInverseIterations = 10;
  RandomStream random(0, "saddle");
  VectorXd direction(problem.size());
  for (double& d : direction) {
    d = random.normal();
  }
  for (int i = 0; i < kInverseIterations; ++i) {
    direction = descent.direction(direction.normalized());
  }
  direction *= (direction.dot(force) < 0 ? -1 : 1) / direction.cwiseAbs().maxCoeff();
  const double before = problem.energy(x);
  double way = 0.1 * extent;
  for (int i = 0; i < kHalvings; ++i, way *= 0.5) {
    for (const double side : {way, -way}) {
      Positions next = problem.moved(x, direction, side);
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

double extent_of(const Positions& x) {
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
                        const NewtonSettings& settings, Positions start) {
  check_free_load(body, load);
  Equilibrium found;
  found.positions = start.empty() ? body.rest : std::move(start);
  for (const Hold& hold : load.holds) {
    const auto v = static_cast<std::size_t>(hold.vertex);
    found.positions[v] = body.rest[v] + hold.displacement;
  }
  FreeProblem problem(body, load);
  const double extent = extent_of(body.rest);
  Descent descent;
  for (; found.iterations <= settings.iterations; ++found.iterations) {
    double largest = 0;
    const VectorXd force = problem.unbalanced(found.positions, largest);
    found.residual = force.size() > 0 ? force.cwiseAbs().maxCoeff() : 0;
    found.inverted = inverted_tetrahedra(body, found.positions);
    const bool balanced = found.residual <= settings.residual * largest;
    if (!std::isfinite(found.residual) || !descent.factorize(problem.matrix(found.positions))) {
      found.outcome = Settling::kUnstable;
      return found;
    }
    if (balanced && descent.definite()) {
      found.outcome = Settling::kSettled;
      return found;
    }
    const VectorXd direction = descent.direction(force);
    if (!balanced && search_line(problem, direction, force, descent.definite(), found.positions)) {
      continue;
    }
    if (descent.definite()) {
      break;
    }
    if (!leave_saddle(problem, descent, force, extent, found.positions)) {
      found.outcome = Settling::kUnstable;
      return found;
    }
  }
  return found;
}

}  // namespace haptrial::deformable
