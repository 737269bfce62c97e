#include "core/deformable/calibration/starting_constants.h"

#include <algorithm>
#include <cmath>

namespace haptrial::deformable {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Forces on the free vertices with one parameter 1 and the others 0, column by column.
MatrixXd forces_of_parameters(const CalibrationProblem& problem, const SpringParameters& parameters,
                              const CalibrationLoad& load) {
  SpringBody body = problem.body();
  MatrixXd columns(3 * static_cast<Eigen::Index>(body.rest.size()),
                   static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    body.constants = parameters.shares(j);
    const std::vector<Eigen::Vector3d> forces = spring_forces(body, load.reference);
    for (std::size_t v = 0; v < forces.size(); ++v) {
      columns.block<3, 1>(3 * static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(j)) =
          forces[v];
    }
  }
  for (const Hold& hold : load.load.holds) {
    columns.middleRows(3 * Eigen::Index{hold.vertex}, 3).setZero();
  }
  return columns;
}

VectorXd acting_forces(const CalibrationLoad& load, Eigen::Index rows) {
  VectorXd acting = VectorXd::Zero(rows);
  for (const NodalForce& nodal : load.load.forces) {
    acting.segment<3>(3 * Eigen::Index{nodal.vertex}) += nodal.force;
  }
  for (const Hold& hold : load.load.holds) {
    acting.segment<3>(3 * Eigen::Index{hold.vertex}).setZero();
  }
  return acting;
}

/// min |A x - b|² with x >= 0, by A^T A and A^T b: one unknown after another, each to its best.
VectorXd non_negative(const MatrixXd& normal, const VectorXd& right) {
  constexpr int kRounds = 20000;
  constexpr double kSame = 1e-12;
  VectorXd x = VectorXd::Zero(right.size());
  for (int round = 0; round < kRounds; ++round) {
    double change = 0.0;
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      if (!(normal(j, j) > 0.0)) {
        continue;
      }
      const double slope = right[j] - normal.row(j).dot(x);
      const double next = std::max(0.0, x[j] + slope / normal(j, j));
      change = std::max(change, std::abs(next - x[j]));
      x[j] = next;
    }
    if (change <= kSame * x.maxCoeff()) {
      break;
    }
  }
  return x;
}

}  // namespace

std::vector<double> starting_constants(const CalibrationProblem& problem,
                                       const SpringParameters& parameters,
                                       std::span<const SearchRange> ranges) {
  const auto size = static_cast<Eigen::Index>(parameters.size());
  MatrixXd normal = MatrixXd::Zero(size, size);
  VectorXd right = VectorXd::Zero(size);
  for (const CalibrationLoad& load : problem.loads()) {
    const MatrixXd a = forces_of_parameters(problem, parameters, load);
    normal += a.transpose() * a;
    right -= a.transpose() * acting_forces(load, a.rows());
  }
  const VectorXd x = non_negative(normal, right);
  std::vector<double> logarithms;
  for (Eigen::Index j = 0; j < size; ++j) {
    const SearchRange& range = ranges[static_cast<std::size_t>(j)];
    const double logarithm = x[j] > 0.0 ? std::log10(x[j]) : range.low;
    logarithms.push_back(std::clamp(logarithm, range.low, range.high));
  }
  return logarithms;
}

}  // namespace haptrial::deformable
