#include "analysis/statistics/base/hidden_markov.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace haptrial::analysis {
namespace {

constexpr double kImpossible = -std::numeric_limits<double>::infinity();

/// ln(sum(exp(x))) without overflow; impossible for a sum of nothing possible.
template <class Vector>
double log_sum(const Eigen::MatrixBase<Vector>& x) {
  const double most = x.maxCoeff();
  return std::isinf(most) ? kImpossible : most + std::log((x.array() - most).exp().sum());
}

void check_chain(const MarkovChain& chain, const Eigen::MatrixXd& emission) {
  const Eigen::Index n = chain.states();
  if (n < 1 || chain.transition.rows() != n || chain.transition.cols() != n ||
      emission.cols() != n || emission.rows() < 1) {
    throw std::invalid_argument(
        "hidden Markov model: start, transition and emission must have the same states, and there "
        "must be an observation");
  }
}

/// (times x states) ln p(observations up to a time, state then).
Eigen::MatrixXd forward(const MarkovChain& chain, const Eigen::MatrixXd& emission) {
  Eigen::MatrixXd alpha(emission.rows(), emission.cols());
  alpha.row(0) = chain.start.transpose() + emission.row(0);
  for (Eigen::Index t = 1; t < alpha.rows(); ++t) {
    for (Eigen::Index to = 0; to < alpha.cols(); ++to) {
      alpha(t, to) =
          log_sum(alpha.row(t - 1).transpose() + chain.transition.col(to)) + emission(t, to);
    }
  }
  return alpha;
}

/// (times x states) ln p(observations after a time | state then).
Eigen::MatrixXd backward(const MarkovChain& chain, const Eigen::MatrixXd& emission) {
  Eigen::MatrixXd beta = Eigen::MatrixXd::Zero(emission.rows(), emission.cols());
  for (Eigen::Index t = beta.rows() - 2; t >= 0; --t) {
    const Eigen::VectorXd later = (emission.row(t + 1) + beta.row(t + 1)).transpose();
    for (Eigen::Index from = 0; from < beta.cols(); ++from) {
      beta(t, from) = log_sum(chain.transition.row(from).transpose() + later);
    }
  }
  return beta;
}

}  // namespace

MarkovChain chain_of_counts(const Eigen::VectorXd& start, const Eigen::MatrixXd& transition,
                            double prior) {
  const Eigen::VectorXd first = start.array() + prior;
  Eigen::MatrixXd next = transition.array() + prior;
  for (Eigen::Index from = 0; from < next.rows(); ++from) {
    next.row(from) /= next.row(from).sum();
  }
  return {(first / first.sum()).array().log(), next.array().log()};
}

BestPath most_probable_path(const MarkovChain& chain, const Eigen::MatrixXd& emission) {
  check_chain(chain, emission);
  const Eigen::Index times = emission.rows();
  Eigen::VectorXd best = chain.start + emission.row(0).transpose();
  Eigen::MatrixXi from(times, chain.states());
  for (Eigen::Index t = 1; t < times; ++t) {
    Eigen::VectorXd next(chain.states());
    for (Eigen::Index to = 0; to < chain.states(); ++to) {
      Eigen::Index before = 0;
      next[to] = (best + chain.transition.col(to)).maxCoeff(&before) + emission(t, to);
      from(t, to) = static_cast<int>(before);
    }
    best = next;
  }
  BestPath path;
  Eigen::Index state = 0;
  path.log_probability = best.maxCoeff(&state);
  path.states.resize(static_cast<std::size_t>(times));
  for (Eigen::Index t = times - 1; t >= 0; --t) {
    path.states[static_cast<std::size_t>(t)] = static_cast<int>(state);
    state = t > 0 ? from(t, state) : state;
  }
  return path;
}

StatePosterior state_posterior(const MarkovChain& chain, const Eigen::MatrixXd& emission) {
  check_chain(chain, emission);
  const Eigen::MatrixXd alpha = forward(chain, emission);
  const Eigen::MatrixXd beta = backward(chain, emission);
  StatePosterior result;
  result.log_likelihood = log_sum(alpha.row(alpha.rows() - 1).transpose());
  result.states = (alpha + beta).array() - result.log_likelihood;
  result.states = result.states.array().exp();
  result.transitions = Eigen::MatrixXd::Zero(chain.states(), chain.states());
  for (Eigen::Index t = 0; t + 1 < alpha.rows(); ++t) {
    for (Eigen::Index from = 0; from < chain.states(); ++from) {
      const auto step = alpha(t, from) + chain.transition.row(from).array() +
                        emission.row(t + 1).array() + beta.row(t + 1).array();
      result.transitions.row(from) += (step - result.log_likelihood).exp().matrix();
    }
  }
  return result;
}

}  // namespace haptrial::analysis
