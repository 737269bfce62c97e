#include "core/psychometric/prediction/settled_staircase.h"

#include <cmath>
#include <stdexcept>

#include "core/psychometric/prediction/chain.h"

namespace haptrial::psychometric {
namespace {

constexpr int kMostRounds = 1'000'000;
constexpr double kSettled = 1e-12;  // change of all probabilities together in a round

/// A rule that never stops and has its last size of steps from the start.
StaircaseParameters endless(StaircaseParameters p) {
  p.steps = {p.steps.back()};
  p.steps[0].from = 0;
  p.schedule = StaircaseParameters::Schedule::kReversals;
  p.stop_reversals = 0;
  p.stop_trials = 1;
  if (p.at_bound == StaircaseParameters::AtBound::kEnd) {
    p.at_bound = StaircaseParameters::AtBound::kHold;
  }
  return p;
}

std::vector<Chain::Node> nodes_of(Chain& chain) {
  std::vector<Chain::Node> nodes;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Chain::Node node = chain.node(i, 1);
    nodes.push_back(node);
  }
  return nodes;
}

/// Half of the probability stays in each round, so that a chain that alternates settles too.
std::vector<double> stationary(const std::vector<Chain::Node>& nodes) {
  std::vector<double> now(nodes.size(), 0.0);
  now[0] = 1.0;
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<double> then(nodes.size(), 0.0);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double half = 0.5 * now[i];
      then[i] += half;
      then[nodes[i].right.to] += half * nodes[i].probability;
      then[nodes[i].wrong.to] += half * (1.0 - nodes[i].probability);
    }
    double change = 0.0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      change += std::abs(then[i] - now[i]);
    }
    now.swap(then);
    if (change < kSettled) {
      return now;
    }
  }
  throw std::invalid_argument(
      "settle: steps, and the distances of low and high from start, must be multiples of a common "
      "size");
}

}  // namespace

SettledStaircase settle(const StaircaseParameters& parameters,
                        const AnswerProbability& probability) {
  check(parameters);
  Chain chain(endless(parameters), probability, true, 200'000);
  const auto nodes = nodes_of(chain);
  const auto shares = stationary(nodes);
  double mean = 0.0;
  double reversals = 0.0;
  double at_reversals = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double x = chain.state(i).x;
    const double turns = shares[i] * (nodes[i].right.reversal * nodes[i].probability +
                                      nodes[i].wrong.reversal * (1.0 - nodes[i].probability));
    mean += shares[i] * x;
    reversals += turns;
    at_reversals += turns * x;
  }
  return {mean, at_reversals / reversals, 1.0 / reversals, nodes.size()};
}

}  // namespace haptrial::psychometric
