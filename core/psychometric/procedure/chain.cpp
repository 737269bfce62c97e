#include "core/psychometric/procedure/chain.h"

#include "core/psychometric/procedure/procedure.h"

namespace haptrial::psychometric {

Chain::Chain(const StaircaseParameters& parameters, const AnswerProbability& probability,
             std::size_t most_states)
    : parameters_(parameters),
      probability_(probability),
      states_(parameters, most_states),
      nodes_(parameters.schedule == StaircaseParameters::Schedule::kTrials ? parameters.steps.size()
                                                                           : 1) {
  checks::require(static_cast<bool>(probability), "Staircase", "probability must be given");
  states_.index_of(begin(parameters_));
}

std::size_t Chain::phase_of(int trial) const {
  std::size_t phase = nodes_.size() - 1;
  while (phase > 0 && parameters_.steps[phase].from > trial) {
    --phase;
  }
  return phase;
}

const Chain::Node& Chain::node(std::size_t state, int trial) {
  const std::size_t phase = phase_of(trial);
  if (nodes_[phase].size() <= state) {
    nodes_[phase].resize(states_.size());
  }
  if (!nodes_[phase][state]) {
    const Answer right = follow(state, trial, true);
    const Answer wrong = follow(state, trial, false);
    nodes_[phase][state] = Node{right, wrong, probability_at(states_[state].x)};
  }
  return *nodes_[phase][state];
}

Chain::Answer Chain::follow(std::size_t index, int trial, bool right) {
  StaircaseState state = states_[index];
  state.trials = trial - 1;
  const bool reversal = advance(parameters_, state, right, state.x);
  state.trials = 0;
  return {states_.index_of(state), reversal};
}

double Chain::probability_at(double x) const {
  const double p = probability_(parameters_.axis.level(x));
  checks::require(p >= 0.0 && p <= 1.0, "Staircase", "probability must be from 0 to 1");
  return p;
}

}  // namespace haptrial::psychometric
