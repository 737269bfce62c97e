#pragma once

#include <Eigen/Core>
#include <vector>

namespace haptrial::analysis {

/// g(P) = predictors times coefficients.
enum class BinomialLink { kProbit, kLogit };

/// Answers and what they depend on, a row for each group of trials that share all of it.
struct BinomialData {
  std::vector<int> yes;        // (rows) >= 0
  std::vector<int> trials;     // (rows) >= yes, > 0
  Eigen::MatrixXd predictors;  // (rows x predictors) without a column for the intercept
};

}  // namespace haptrial::analysis
