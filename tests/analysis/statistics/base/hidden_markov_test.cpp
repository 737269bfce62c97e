// Hidden Markov models against all paths of small cases, enumerated one by one.
#include "analysis/statistics/base/hidden_markov.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace haptrial::analysis::hidden_markov_test {
namespace {

struct Case {
  MarkovChain chain;
  Eigen::MatrixXd emission;  // (times x states) logarithms
};

/// @param forbid  transitions from a state to itself are impossible
Case random_case(RandomStream& random, Eigen::Index states, Eigen::Index times, bool forbid) {
  const auto positive = [&](Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd m(rows, columns);
    for (double& x : m.reshaped()) {
      x = 0.01 + random.uniform();
    }
    return m;
  };
  Eigen::MatrixXd transition = positive(states, states);
  if (forbid) {
    transition.diagonal().setZero();
  }
  transition.array().colwise() /= transition.rowwise().sum().array().eval();
  const Eigen::VectorXd start = positive(states, 1);
  return {{(start / start.sum()).array().log(), transition.array().log()},
          positive(times, states).array().log()};
}

/// Sums and the best path over every path there is.
struct Enumerated {
  double likelihood{0.0};
  double best{0.0};
  std::vector<int> best_path;
  Eigen::MatrixXd states, transitions;  // as StatePosterior has them
};

Enumerated enumerate(const Case& c) {
  const Eigen::Index n = c.chain.states(), times = c.emission.rows();
  Enumerated all;
  all.states = Eigen::MatrixXd::Zero(times, n);
  all.transitions = Eigen::MatrixXd::Zero(n, n);
  std::vector<int> path(static_cast<std::size_t>(times), 0);
  const auto count = static_cast<long>(std::lround(std::pow(n, times)));
  for (long number = 0; number < count; ++number) {
    long rest = number;
    for (int& state : path) {
      state = static_cast<int>(rest % n);
      rest /= n;
    }
    double p = std::exp(c.chain.start[path[0]] + c.emission(0, path[0]));
    for (std::size_t t = 1; t < path.size(); ++t) {
      p *= std::exp(c.chain.transition(path[t - 1], path[t]) +
                    c.emission(static_cast<Eigen::Index>(t), path[t]));
    }
    all.likelihood += p;
    if (p > all.best) {
      all.best = p;
      all.best_path = path;
    }
    for (std::size_t t = 0; t < path.size(); ++t) {
      all.states(static_cast<Eigen::Index>(t), path[t]) += p;
      if (t > 0) {
        all.transitions(path[t - 1], path[t]) += p;
      }
    }
  }
  all.states /= all.likelihood;
  all.transitions /= all.likelihood;
  return all;
}

void expect_as_enumerated(const Case& c) {
  const Enumerated all = enumerate(c);
  const BestPath path = most_probable_path(c.chain, c.emission);
  EXPECT_EQ(path.states, all.best_path);
  EXPECT_NEAR(path.log_probability, std::log(all.best), 1e-12);
  const StatePosterior posterior = state_posterior(c.chain, c.emission);
  EXPECT_NEAR(posterior.log_likelihood, std::log(all.likelihood), 1e-12);
  EXPECT_LT((posterior.states - all.states).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((posterior.transitions - all.transitions).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(HiddenMarkovTest, EqualsTheSumOverAllPaths) {
  RandomStream random(1, "chains");
  for (int round = 0; round < 20; ++round) {
    expect_as_enumerated(random_case(random, 3, 6, false));
    expect_as_enumerated(random_case(random, 2, 1, false));
  }
}

TEST(HiddenMarkovTest, ImpossibleTransitionsStayImpossible) {
  RandomStream random(2, "chains");
  for (int round = 0; round < 10; ++round) {
    const Case c = random_case(random, 3, 5, true);
    expect_as_enumerated(c);
    EXPECT_EQ(state_posterior(c.chain, c.emission).transitions.diagonal().norm(), 0.0);
  }
}

TEST(HiddenMarkovTest, LongSequencesDoNotUnderflow) {
  RandomStream random(3, "chains");
  const Case c = random_case(random, 4, 20000, false);
  const StatePosterior posterior = state_posterior(c.chain, c.emission);
  EXPECT_TRUE(std::isfinite(posterior.log_likelihood));
  EXPECT_LT((posterior.states.rowwise().sum().array() - 1.0).abs().maxCoeff(), 1e-8);
  EXPECT_NEAR(posterior.transitions.sum(), 19999.0, 1e-4);
}

TEST(HiddenMarkovTest, CountsBecomeShares) {
  const MarkovChain chain =
      chain_of_counts(Eigen::Vector2d(3.0, 0.0), Eigen::Matrix2d{{7.0, 1.0}, {0.0, 0.0}}, 1.0);
  EXPECT_NEAR(std::exp(chain.start[0]), 0.8, 1e-15);
  EXPECT_NEAR(std::exp(chain.transition(0, 1)), 0.2, 1e-15);
  EXPECT_NEAR(std::exp(chain.transition(1, 0)), 0.5, 1e-15);
}

TEST(HiddenMarkovTest, RefusesSizesThatDoNotFit) {
  const MarkovChain chain = chain_of_counts(Eigen::Vector2d::Ones(), Eigen::Matrix2d::Ones(), 1.0);
  EXPECT_THROW(most_probable_path(chain, Eigen::MatrixXd::Zero(3, 3)), std::invalid_argument);
  EXPECT_THROW(state_posterior(chain, Eigen::MatrixXd::Zero(0, 2)), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis::hidden_markov_test
