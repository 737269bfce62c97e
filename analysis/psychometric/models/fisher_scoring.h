#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

namespace haptrial::analysis {

/// The logarithm of a likelihood at some parameters.
struct ScoringPoint {
  double value{0.0};
  Eigen::VectorXd slope;
  Eigen::MatrixXd information;  // Fisher's
};

/// Where a likelihood is highest.
struct ScoringMaximum {
  Eigen::VectorXd at;
  ScoringPoint point;
};

/// Nothing where the parameters are out of their range.
using ScoredLikelihood = std::function<std::optional<ScoringPoint>(const Eigen::VectorXd&)>;

/// Fisher's scoring with halved steps. Nothing if the likelihood rises without end (a parameter
/// beyond 50 in size) or its information is singular.
std::optional<ScoringMaximum> fisher_scoring(const ScoredLikelihood& likelihood,
                                             const Eigen::VectorXd& start);

}  // namespace haptrial::analysis
