#include <cmath>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

#include "analysis/statistics/base/hidden_markov.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::hidden_markov_reference {
namespace {

void compare(Answers& r) {
  const std::vector<double> values = DataSet("hidden").numbers("value");
  const Eigen::Matrix3d rates{{-0.20, 0.15, 0.05}, {0.10, -0.25, 0.15}, {0.05, 0.15, -0.20}};
  const Eigen::Vector3d means(0.0, 1.2, 3.0), deviations(0.8, 0.7, 1.0);
  const MarkovChain chain{Eigen::Vector3d(0.5, 0.3, 0.2).array().log(),
                          Eigen::Matrix3d(rates.exp()).array().log()};
  Eigen::MatrixXd emission(static_cast<Eigen::Index>(values.size()), 3);
  for (Eigen::Index t = 0; t < emission.rows(); ++t) {
    const Eigen::Array3d z =
        (values[static_cast<std::size_t>(t)] - means.array()) / deviations.array();
    emission.row(t) =
        -0.5 * z.square() - deviations.array().log() - 0.5 * std::log(2.0 * std::numbers::pi);
  }
  const StatePosterior posterior = state_posterior(chain, emission);
  const BestPath path = most_probable_path(chain, emission);
  auto at = r.at("Hidden Markov model", "three states");
  at.is("log_likelihood", posterior.log_likelihood);
  for (Eigen::Index t = 0; t < emission.rows(); ++t) {
    at.is("path." + std::to_string(t + 1), path.states[static_cast<std::size_t>(t)] + 1.0);
    for (Eigen::Index state = 0; state < 3; ++state) {
      at.is("posterior." + std::to_string(3 * t + state + 1), posterior.states(t, state));
    }
  }
}

const Topic kTopic("hidden_markov", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::hidden_markov_reference
