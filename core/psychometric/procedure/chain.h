#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/psychometric/procedure/answer_probability.h"
#include "core/psychometric/procedure/chain_states.h"

namespace haptrial::psychometric {

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

}  // namespace haptrial::psychometric
