#include "core/psychometric/procedure/staircase_rule.h"

#include <algorithm>
#include <cmath>

#include "core/psychometric/procedure/procedure.h"

namespace haptrial::psychometric {
namespace {

using Parameters = StaircaseParameters;

// A step that a bound cuts to less than this share of its size is no step but rounding.
constexpr double kNoStep = 1e-9;

void require(bool holds, const std::string& sentence) {
  checks::require(holds, "Staircase", sentence);
}

void require_count(int value, int least, int most, const std::string& name) {
  require(value >= least && value <= most,
          name + " must be from " + std::to_string(least) + " to " + std::to_string(most));
}

void check_levels(const Parameters& p) {
  require(std::isfinite(p.axis.at(p.low)),
          "low must be finite, and above the origin of a logarithmic scale");
  require(std::isfinite(p.high) && p.low < p.high, "high must be finite and above low");
  require(p.start >= p.low && p.start <= p.high, "start must be from low to high");
}

void check_steps(const Parameters& p) {
  require(!p.steps.empty() && p.steps[0].from == 0, "steps must begin with one from 0 on");
  int before = -1;
  for (const StaircaseStep& step : p.steps) {
    require(step.down > 0.0 && std::isfinite(step.down) && step.up > 0.0 && std::isfinite(step.up),
            "steps must be finite and above 0");
    require(step.from > before, "steps must rise in what they begin from");
    before = step.from;
  }
}

const StaircaseStep& step_in_force(const Parameters& p, const StaircaseState& state) {
  const int done = p.schedule == Parameters::Schedule::kTrials ? state.trials : state.reversals;
  std::size_t i = p.steps.size() - 1;
  while (i > 0 && p.steps[i].from > done) {
    --i;
  }
  return p.steps[i];
}

/// -1, +1 or, with too few answers for a step, 0. Counts the answer.
int called_for(const Parameters& p, StaircaseState& state, bool right) {
  const bool first = state.reversals == 0;
  const int down = first && p.first_down > 0 ? p.first_down : p.down;
  const int up = first && p.first_up > 0 ? p.first_up : p.up;
  int& counted = right ? state.right : state.wrong;
  if (p.counting == Parameters::Counting::kInSequence) {
    (right ? state.wrong : state.right) = 0;
  }
  ++counted;
  if (counted < (right ? down : up)) {
    return 0;
  }
  state.right = 0;
  state.wrong = 0;
  return right ? -1 : 1;
}

}  // namespace

void check(const StaircaseParameters& p) {
  check_levels(p);
  require_count(p.down, 1, 100, "down");
  require_count(p.up, 1, 100, "up");
  require_count(p.first_down, 0, 100, "first_down");
  require_count(p.first_up, 0, 100, "first_up");
  check_steps(p);
  require_count(p.blocked_steps, 1, 1000, "blocked_steps");
  require_count(p.stop_reversals, 0, 100'000, "stop_reversals");
  require_count(p.stop_trials, 0, 1'000'000, "stop_trials");
  require(p.stop_reversals > 0 || p.stop_trials > 0,
          "stop_reversals or stop_trials must be above 0");
  require_count(p.skip, 0, 1'000'000, "skip");
  require_count(p.last, 0, 1'000'000, "last");
  require(p.skip == 0 || p.last == 0, "skip and last must not both be above 0");
}

double balance_of(int down, const StaircaseStep& step) {
  require(down >= 1, "down must be at least 1");
  require(step.down > 0.0 && step.up > 0.0, "steps must be above 0");
  return std::pow(step.up / (step.up + step.down), 1.0 / down);
}

StaircaseState begin(const StaircaseParameters& parameters) {
  StaircaseState state;
  state.x = parameters.axis.at(parameters.start);
  return state;
}

bool advance(const StaircaseParameters& p, StaircaseState& state, bool right, double from) {
  ++state.trials;
  const int way = called_for(p, state, right);
  if (way == 0) {
    return false;
  }
  const bool from_bound = state.blocked > 0;
  const bool turned = state.direction != 0 && way != state.direction;
  const bool uncounted = from_bound && p.at_bound == Parameters::AtBound::kHoldUncounted;
  const bool reversal = turned && !uncounted;
  state.direction = way;
  state.reversals += reversal;
  const StaircaseStep& step = step_in_force(p, state);
  const double size = way < 0 ? -step.down : step.up;
  const double wanted = from + (p.right_raises ? -size : size);
  state.x = std::clamp(wanted, p.axis.at(p.low), p.axis.at(p.high));
  const bool stays = std::abs(state.x - from) <= kNoStep * std::abs(size);
  // No more is counted than matters, so that a track has few states.
  const int most = p.at_bound == Parameters::AtBound::kEnd ? p.blocked_steps : 1;
  state.blocked = stays ? std::min(state.blocked + 1, most) : 0;
  return reversal;
}

bool stopped(const StaircaseParameters& p, const StaircaseState& state) {
  return (p.stop_reversals > 0 && state.reversals >= p.stop_reversals) ||
         (p.stop_trials > 0 && state.trials >= p.stop_trials) ||
         (p.at_bound == Parameters::AtBound::kEnd && state.blocked >= p.blocked_steps);
}

}  // namespace haptrial::psychometric
