#pragma once

#include <Eigen/Core>
#include <vector>

namespace haptrial::analysis {

/// The hidden part of a hidden Markov model: a first-order chain of states. Probabilities are kept
/// as natural logarithms, so that long sequences do not underflow; -infinity is impossible.
struct MarkovChain {
  Eigen::VectorXd start;       // (states)
  Eigen::MatrixXd transition;  // (states x states), a row for the state that is left

  Eigen::Index states() const { return start.size(); }
};

/// The chain with the largest posterior probability under counts of starts and transitions, each
/// cell having a prior count.
/// @param start, transition  (states), (states x states), >= 0
/// @param prior              of each cell > 0
MarkovChain chain_of_counts(const Eigen::VectorXd& start, const Eigen::MatrixXd& transition,
                            double prior);

struct BestPath {
  std::vector<int> states;      // (times)
  double log_probability{0.0};  // of the states together with the observations
};

/// The most probable states of a whole sequence, of equally probable ones the lower state.
/// @param emission  (times x states) log density of each observation in each state
/// Source: Viterbi 1967. @throws std::invalid_argument where the sizes do not fit. Any thread.
BestPath most_probable_path(const MarkovChain& chain, const Eigen::MatrixXd& emission);

/// A sequence tells this about its states.
struct StatePosterior {
  double log_likelihood{0.0};
  Eigen::MatrixXd states;       // (times x states) probability
  Eigen::MatrixXd transitions;  // (states x states) expected number
};

/// Forward-backward algorithm, in logarithms throughout.
/// Source: Baum et al. 1970; Rabiner 1989. As most_probable_path().
StatePosterior state_posterior(const MarkovChain& chain, const Eigen::MatrixXd& emission);

}  // namespace haptrial::analysis
