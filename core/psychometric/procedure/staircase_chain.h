#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "core/psychometric/procedure/staircase_rule.h"

namespace haptrial::psychometric {

/// Probability of a right answer at a level.
using AnswerProbability = std::function<double(double level)>;

/// States of a track, each once. Two are the same when all but the number of trials is the same and
/// their levels differ by less than the resolution.
class ChainStates {
 public:
  /// @param most  states; more are std::invalid_argument
  ChainStates(const StaircaseParameters& parameters, std::size_t most);

  /// The index of a state; a new one is entered.
  std::size_t index_of(const StaircaseState& state);
  const StaircaseState& operator[](std::size_t index) const { return states_[index]; }
  std::size_t size() const noexcept { return states_.size(); }
  void clear();

 private:
  struct Key {
    std::int64_t x;
    std::int64_t counts;
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const noexcept;
  };

  double origin_;
  double resolution_;  // [axis]
  std::size_t most_;
  std::vector<StaircaseState> states_;
  std::unordered_map<Key, std::size_t, Hash> index_;
};

/// Next state after each answer, found when it is first asked for.
class Chain {
 public:
  struct Answer {
    std::size_t to;
    bool reversal;
  };
  struct Node {
    Answer right, wrong;
    double probability;  // of a right answer
  };

  Chain(const StaircaseParameters& parameters, const AnswerProbability& probability,
        std::size_t most_states);

  /// Answers from a state on trial `trial` (1, 2, ...).
  const Node& node(std::size_t state, int trial);
  const StaircaseState& state(std::size_t index) const { return states_[index]; }
  std::size_t size() const noexcept { return states_.size(); }
  std::size_t first() const noexcept { return 0; }
  /// Whether a track ends in a state, but for the number of trials.
  bool stops(std::size_t state) const { return stopped(parameters_, states_[state]); }

 private:
  Answer follow(std::size_t state, int trial, bool right);
  double probability_at(double x) const;
  std::size_t phase_of(int trial) const;

  StaircaseParameters parameters_;
  AnswerProbability probability_;
  ChainStates states_;
  std::vector<std::vector<std::optional<Node>>> nodes_;  // for each size of steps by trials
};

struct StaircasePrediction {
  double mean;              // expected estimate, given that there is one [axis]
  double deviation;         // its standard deviation [axis]
  double bias;              // mean - target [axis]
  double without_estimate;  // probability that there is no reversal to take a mean of
  double trials;            // expected number
  double trials_deviation;
};

/// Exact prediction of a staircase: its track is a Markov chain over level, counts of answers,
/// direction and number of reversals, and the first two moments of the sum of the chosen reversals
/// (or levels) are carried along with the probability of each state, trial by trial, until it
/// stops. Answers are independent of each other, and levels are applied as they are asked for.
///
/// The estimator is a mean: of reversals with any stop, of levels only with a stop by trials alone.
/// Work: trials times states; with steps up and down that have no common measure the levels that
/// can be reached grow with the square of the number of trials. Tracks that have not stopped after
/// 100,000 trials count as stopped.
///
/// @param target  the level that is sought
/// @throws std::invalid_argument naming the parameter that breaks its bound, when the estimator is
///         none of these, or with more than 2,000,000 states at a time
StaircasePrediction predict_staircase(const StaircaseParameters& parameters,
                                      const AnswerProbability& probability, double target);

}  // namespace haptrial::psychometric
