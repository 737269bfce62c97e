#include "core/psychometric/procedure/staircase_chain.h"

#include <algorithm>
#include <cmath>

#include "core/psychometric/procedure/procedure.h"

namespace haptrial::psychometric {

ChainStates::ChainStates(const StaircaseParameters& parameters, std::size_t most)
    : origin_(parameters.axis.at(parameters.low)),
      resolution_(1e-9 * (parameters.axis.at(parameters.high) - origin_)),
      most_(most) {}

std::size_t ChainStates::Hash::operator()(const Key& key) const noexcept {
  auto h = static_cast<std::uint64_t>(key.x) * 0x9e3779b97f4a7c15u;
  h ^= static_cast<std::uint64_t>(key.counts) + (h >> 29);
  h *= 0xbf58476d1ce4e5b9u;
  return static_cast<std::size_t>(h ^ (h >> 32));
}

std::size_t ChainStates::index_of(const StaircaseState& state) {
  // Counts of answers are at most 100, blocked steps 1000 and reversals 100,000: no two overlap.
  std::int64_t counts = state.reversals;
  counts = counts * 128 + state.right;
  counts = counts * 128 + state.wrong;
  counts = counts * 4 + (state.direction + 1);
  counts = counts * 1024 + state.blocked;
  const Key key{std::llround((state.x - origin_) / resolution_), counts};
  const auto [at, entered] = index_.try_emplace(key, states_.size());
  if (entered) {
    checks::require(states_.size() < most_, "Staircase",
                    "steps up and down lead to more levels than can be predicted; "
                    "let both be multiples of a common size");
    states_.push_back(state);
  }
  return at->second;
}

void ChainStates::clear() {
  states_.clear();
  index_.clear();
}

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

namespace {

using Estimator = StaircaseParameters::Estimator;
constexpr int kMostTrials = 100'000;
constexpr double kNegligible = 1e-15;  // probability that is still under way

/// Probability, and moments of the sum S of the chosen levels, each times that probability.
struct Moments {
  double p{0.0}, s{0.0}, ss{0.0};

  void add(const Moments& other, double share, double x) {
    p += share * other.p;
    s += share * (other.s + x * other.p);
    ss += share * (other.ss + 2.0 * x * other.s + x * x * other.p);
  }
};

/// Levels first to last are in the sum: numbers of reversals or of trials, from 1 on.
struct Chosen {
  int first, last;
  bool holds(int number) const { return number >= first && number <= last; }
};

struct Sweep {
  std::vector<Moments> stopped;  // by number of reversals; of a mean of levels all in the first
  double trials{0.0};            // expected
  double trials_square{0.0};
};

/// All tracks at once, trial by trial.
class Walk {
 public:
  Walk(const StaircaseParameters& parameters, Chain& chain)
      : parameters_(parameters), chain_(chain), origin_(chain.state(chain.first()).x) {}

  Sweep sweep(const Chosen& chosen) {
    const int limit = parameters_.stop_trials > 0 ? parameters_.stop_trials : kMostTrials;
    Sweep result;
    place(chain_.first(), {1.0, 0.0, 0.0}, 1.0, 0.0);
    for (int trial = 1; trial <= limit && !active_.empty(); ++trial) {
      take_turn();
      double gone = 0.0;
      for (std::size_t i = 0; i < from_.size(); ++i) {
        const Chain::Node node = chain_.node(from_[i], trial);
        const double share = node.probability;
        gone += go(node.right, i, share, trial, limit, chosen, result);
        gone += go(node.wrong, i, 1.0 - share, trial, limit, chosen, result);
      }
      result.trials += gone * trial;
      result.trials_square += gone * trial * trial;
    }
    active_.clear();
    return result;
  }

 private:
  void place(std::size_t state, const Moments& moments, double share, double x) {
    if (slot_.size() < chain_.size()) {
      slot_.resize(chain_.size(), kNone);
    }
    if (slot_[state] == kNone) {
      slot_[state] = active_.size();
      active_.push_back(state);
      moments_.push_back({});
    }
    moments_[slot_[state]].add(moments, share, x);
  }

  void take_turn() {
    from_.clear();
    before_.clear();
    for (std::size_t i = 0; i < active_.size(); ++i) {
      slot_[active_[i]] = kNone;
      if (moments_[i].p > kNegligible) {
        from_.push_back(active_[i]);
        before_.push_back(moments_[i]);
      }
    }
    active_.clear();
    moments_.clear();
  }

  /// @return the probability that the track stops
  double go(const Chain::Answer& answer, std::size_t i, double share, int trial, int limit,
            const Chosen& chosen, Sweep& result) {
    const int reversals = chain_.state(answer.to).reversals;
    const bool of_levels = parameters_.estimator == Estimator::kMeanOfLevels;
    const bool counts =
        of_levels ? chosen.holds(trial) : answer.reversal && chosen.holds(reversals);
    const double x = counts ? chain_.state(from_[i]).x - origin_ : 0.0;
    if (trial < limit && !chain_.stops(answer.to)) {
      place(answer.to, before_[i], share, x);
      return 0.0;
    }
    const auto bucket = of_levels ? 0 : static_cast<std::size_t>(reversals);
    if (result.stopped.size() <= bucket) {
      result.stopped.resize(bucket + 1);
    }
    result.stopped[bucket].add(before_[i], share, x);
    return share * before_[i].p;
  }

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  const StaircaseParameters& parameters_;
  Chain& chain_;
  double origin_;
  std::vector<std::size_t> active_, from_, slot_;
  std::vector<Moments> moments_, before_;
};

/// Moments of the mean, from those of sums of `count` levels.
void add_mean(Moments& total, const Moments& sums, int count) {
  if (count > 0) {
    total.p += sums.p;
    total.s += sums.s / count;
    total.ss += sums.ss / count / count;
  }
}

void check_estimator(const StaircaseParameters& p) {
  checks::require(p.estimator != Estimator::kMedianOfReversals, "predict_staircase",
                  "estimator must be a mean");
  checks::require(p.estimator != Estimator::kMeanOfLevels ||
                      (p.stop_reversals == 0 && p.at_bound != StaircaseParameters::AtBound::kEnd),
                  "predict_staircase", "a mean of levels needs a stop by trials alone");
}

/// The mean of levels: which ones is known beforehand.
Moments mean_of_levels(const StaircaseParameters& p, const Sweep& sweep, const Chosen& chosen) {
  Moments mean;
  add_mean(mean, sweep.stopped.at(0), p.stop_trials - chosen.first + 1);
  return mean;
}

Chosen chosen_for(const StaircaseParameters& p, int total) {
  return {p.last > 0 ? std::max(1, total - p.last + 1) : p.skip + 1, total};
}

/// The mean of reversals: the last of so many are known only with their number, so each number of
/// them has a sweep of its own if `last` is set.
Moments mean_of_reversals(const StaircaseParameters& p, const Sweep& sweep, Walk& walk) {
  Moments mean;
  for (std::size_t n = 1; n < sweep.stopped.size(); ++n) {
    const int total = static_cast<int>(n);
    const Chosen chosen = chosen_for(p, total);
    if (sweep.stopped[n].p <= kNegligible) {
      continue;
    }
    const bool all = p.last == 0 || (p.stop_reversals == 0 && total <= p.last);
    const bool known = all || total == p.stop_reversals;
    add_mean(mean, known ? sweep.stopped[n] : walk.sweep(chosen).stopped[n],
             total - chosen.first + 1);
  }
  return mean;
}

}  // namespace

StaircasePrediction predict_staircase(const StaircaseParameters& parameters,
                                      const AnswerProbability& probability, double target) {
  check(parameters);
  check_estimator(parameters);
  Chain chain(parameters, probability, 2'000'000);
  Walk walk(parameters, chain);
  const bool of_levels = parameters.estimator == Estimator::kMeanOfLevels;
  const bool to_the_end = !of_levels && parameters.stop_reversals == 0 && parameters.last > 0;
  const int total = of_levels ? parameters.stop_trials : parameters.stop_reversals;
  Chosen chosen = chosen_for(parameters, total);
  if (!of_levels && parameters.last == 0) {
    chosen.last = kMostTrials;
  } else if (to_the_end) {
    chosen = {1, kMostTrials};
  }
  const Sweep sweep = walk.sweep(chosen);
  const Moments mean = of_levels ? mean_of_levels(parameters, sweep, chosen)
                                 : mean_of_reversals(parameters, sweep, walk);
  const double offset = mean.s / mean.p;
  const double variance = mean.ss / mean.p - offset * offset;
  StaircasePrediction result;
  result.mean = parameters.axis.at(parameters.start) + offset;
  result.deviation = std::sqrt(std::max(0.0, variance));
  result.bias = result.mean - parameters.axis.at(target);
  result.without_estimate = std::max(0.0, 1.0 - mean.p);
  result.trials = sweep.trials;
  result.trials_deviation =
      std::sqrt(std::max(0.0, sweep.trials_square - sweep.trials * sweep.trials));
  return result;
}

}  // namespace haptrial::psychometric
