#include "protocols/psychophysics/sequence/trial_sequence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "core/base/random.h"
#include "core/record/rows/trial_rows.h"
#include "protocols/psychophysics/definition/counterbalance.h"

namespace haptrial::protocols {
namespace {

std::string label_of(const std::vector<GivenValue>& values) {
  return fmt::format("{}", fmt::join(levels_of(values), ", "));
}

/// The level of one factor, or of all of them, by which a rule tells trials apart.
std::string level_of(const std::vector<GivenValue>& values, const std::string& factor) {
  if (factor.empty()) {
    return label_of(values);
  }
  const auto found = std::ranges::find(values, factor, &GivenValue::name);
  return found == values.end() ? std::string() : found->formula;
}

/// A procedure that learns nothing would never finish.
bool is_open(const RunningTrack& running) {
  return !running.procedure->finished() && running.trials < 2 * running.track->most_trials;
}

std::vector<std::size_t> shuffled_indices(std::size_t count, RandomStream& random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) {
    std::swap(order[i - 1], order[random.below(i)]);
  }
  return order;
}

}  // namespace

SessionIdentity identity_of(const TrialsDefinition& d, const SessionPlace& place) {
  const std::string group = d.groups.size() > 1 ? group_of(d.groups, place.subject)
                            : d.groups.empty()  ? std::string()
                                                : d.groups.front().name;
  return {place.participant, group, place.seed, place.session_seed, place.session};
}

TrialSequence::TrialSequence(const TrialsDefinition& definition, const SessionIdentity& taker)
    : d_(definition), taker_(taker) {
  std::vector<std::size_t> others;
  for (const std::size_t i : d_.order.blocks_of(taker.session)) {
    (d_.order.blocks[i].practice ? blocks_ : others).push_back(i);
  }
  if (!others.empty()) {
    // Each session is balanced by itself.
    const std::uint64_t seed =
        taker.session > 1 ? derived_seed(taker.study_seed, fmt::format("session {}", taker.session))
                          : taker.study_seed;
    for (const int place : order_of_levels(d_.order.order, static_cast<int>(others.size()),
                                           taker.participant, seed, taker.session_seed)) {
      blocks_.push_back(others[static_cast<std::size_t>(place)]);
    }
  }
  if (!blocks_.empty()) {
    begin_block();
  }
}

void TrialSequence::begin_block() {
  running_.clear();
  fixed_.clear();
  fixed_at_ = 0;
  in_block_ = failed_ = right_in_a_row_ = 0;
  probe_before_ = true;  // a block does not begin with a probe
  combinations_.clear();
  ++(block().practice ? practice_blocks_ : study_blocks_);
  if (const std::string missing = missing_threshold(); !missing.empty()) {
    ended_early_.push_back(
        fmt::format("block {} was left out, since {} found no threshold", block().name, missing));
    return;
  }
  const std::vector<const Track*> asked = d_.tracks_in(block());
  if (asked.empty()) {
    make_fixed();
    return;
  }
  for (const Track* each : asked) {
    const Track& track = *each;
    for (const auto& combination : crossed(d_.varied_by(track, block()))) {
      const std::string label = label_of(combination);
      const std::string name = label.empty() ? track.name : track.name + ", " + label;
      const std::string stream = fmt::format("levels {} {}", at_, name);
      running_.push_back({&track, name, combination, track.begin(taker_.session_seed, stream), 0});
    }
  }
}

/// Keeps what the tracks of the block found; a later block of the same track stands before.
void TrialSequence::end_block() {
  for (const RunningTrack& running : running_) {
    const auto estimates = running.procedure->estimates();
    if (running.track->finds_level && !estimates.empty()) {
      found_.push_back(
          {running.track->name, running.values, running.track->applied(estimates.front().value)});
    }
  }
}

/// The first track whose threshold the block needs and that no earlier block found, with its
/// combination of factors.
std::string TrialSequence::missing_threshold() const {
  for (const std::string& name : block().needs) {
    const auto track = std::ranges::find(d_.tracks, name, &Track::name);
    for (std::vector<GivenValue> values : crossed(d_.varied_by(*track, block()))) {
      const std::string label = label_of(values);
      values.insert(values.end(), block().values.begin(), block().values.end());
      TrialValues trial;
      trial.values = values;
      give_thresholds(trial);
      if (std::ranges::find(trial.thresholds, name, &std::pair<std::string, double>::first) ==
          trial.thresholds.end()) {
        return label.empty() ? name : name + ", " + label;
      }
    }
  }
  return {};
}

void TrialSequence::give_thresholds(TrialValues& trial) const {
  const auto holds = [&](const GivenValue& of_track) {
    const auto last = std::ranges::find(trial.values.rbegin(), trial.values.rend(), of_track.name,
                                        &GivenValue::name);
    return last != trial.values.rend() && last->formula == of_track.formula;
  };
  for (const FoundThreshold& found : found_) {
    if (std::ranges::all_of(found.values, holds)) {
      trial.thresholds.emplace_back(found.track, found.level);
    }
  }
}

/// The trials' combinations in an order that keeps the rules, if there are any.
std::vector<int> TrialSequence::order_under_rules(
    const std::vector<std::vector<GivenValue>>& combinations, const std::vector<int>& which) const {
  std::vector<OrderRule> rules;
  for (const RunLimit& limit : d_.order.most_in_a_row) {
    std::vector<std::string> levels;
    OrderRule rule{
        limit.factor.empty() ? "combination of factors" : limit.factor, {}, limit.most, -1, 0};
    for (const int i : which) {
      const std::string level = level_of(combinations[static_cast<std::size_t>(i)], limit.factor);
      const auto known = std::ranges::find(levels, level);
      rule.values.push_back(static_cast<int>(known - levels.begin()));
      if (known == levels.end()) {
        levels.push_back(level);
      }
    }
    if (levels.size() > 1) {
      rules.push_back(std::move(rule));
    }
  }
  const bool shuffled = d_.order.trial_order == TrialOrder::kShuffled;
  if (rules.empty() && !shuffled) {
    return which;
  }
  RandomStream random(taker_.session_seed, fmt::format("order {}", at_));
  std::vector<int> ordered;
  for (const std::size_t i : constrained_order(which.size(), rules, random)) {
    ordered.push_back(which[i]);
  }
  return ordered;
}

/// Every combination once before any comes again, or each drawn anew; then under the rules.
void TrialSequence::make_fixed() {
  const auto combinations = crossed(d_.varied_in(block()));
  const auto count = static_cast<std::size_t>(block().trials);
  std::vector<int> which;
  for (std::size_t cycle = 0; which.size() < count; ++cycle) {
    RandomStream random(taker_.session_seed, fmt::format("cycle {} {}", at_, cycle));
    if (d_.order.trial_order == TrialOrder::kRandom) {
      which.push_back(static_cast<int>(random.below(combinations.size())));
      continue;
    }
    for (const std::size_t i : shuffled_indices(combinations.size(), random)) {
      which.push_back(static_cast<int>(i));
    }
  }
  which.resize(count);
  which = order_under_rules(combinations, which);
  std::vector<int> probes(count, 0);
  if (block().probe) {
    const auto number =
        static_cast<std::size_t>(std::lround(block().probe->share * static_cast<double>(count)));
    std::fill_n(probes.begin(), number, 1);
    RandomStream random(taker_.session_seed, fmt::format("probes {}", at_));
    const std::size_t first = std::min(combinations.size(), count / 4);
    const OrderRule rule{block().probe->name, probes, 1, 1, first};
    std::vector<int> ordered;
    for (const std::size_t i : constrained_order(count, std::span(&rule, 1), random)) {
      ordered.push_back(probes[i]);
    }
    probes = ordered;
  }
  for (std::size_t i = 0; i < count; ++i) {
    fixed_.push_back({combinations[static_cast<std::size_t>(which[i])],
                      probes[i] == 1 ? block().probe->name : ""});
  }
}

/// Trials that are never completed must not make an endless session.
bool TrialSequence::fails_for_ever() const {
  return failed_ > 20 + 2 * std::max(block().trials, d_.most_trials());
}

bool TrialSequence::block_is_over() const {
  if (block().practice && block().right_in_a_row > 0 && right_in_a_row_ >= block().right_in_a_row) {
    return true;
  }
  if (fails_for_ever()) {
    return true;
  }
  if (running_.empty()) {
    return fixed_at_ >= fixed_.size();
  }
  const bool enough = block().trials > 0 && in_block_ - failed_ >= block().trials;
  return enough || std::none_of(running_.begin(), running_.end(), is_open);
}

std::optional<NextTrial> TrialSequence::next() {
  if (next_) {
    return next_;
  }
  while (at_ < blocks_.size() && block_is_over()) {
    if (fails_for_ever()) {
      ended_early_.push_back(fmt::format(
          "block {} ended with trials left, after {} that were not completed or came too late",
          block().name, failed_));
    }
    end_block();
    if (++at_ < blocks_.size()) {
      begin_block();
    }
  }
  if (at_ >= blocks_.size()) {
    return std::nullopt;
  }
  next_ = make_next();
  return next_;
}

NextTrial TrialSequence::make_next() {
  NextTrial next;
  const bool practice = block().practice;
  PlannedTrial& plan = next.plan;
  plan.trial = ++numbers_[practice ? 1 : 0];
  plan.block = practice ? -practice_blocks_ : study_blocks_;
  plan.repetition = ++in_block_;
  plan.practice = practice;
  plan.block_name = block().name;
  const std::string number = fmt::format("{} {}", practice ? "practice" : "trial", plan.trial);
  plan.stimulus_seed = derived_seed(taker_.session_seed, number);
  TrialValues& values = next.values;
  values.trial = plan.trial;
  values.block = blocks_[at_];
  values.participant = taker_.participant + 1;
  values.session = taker_.session;
  values.group = taker_.group;
  RandomStream random(plan.stimulus_seed, "intervals");
  values.intervals = shuffled_indices(d_.intervals.size(), random);
  if (!d_.random_intervals) {
    std::sort(values.intervals.begin(), values.intervals.end());
  }
  values.values = block().values;
  if (!running_.empty()) {
    choose_track(next);
  } else {
    const Fixed& fixed = fixed_[fixed_at_];
    values.probe = fixed.probe;
    values.values.insert(values.values.end(), fixed.values.begin(), fixed.values.end());
    plan.condition = record::condition_label(levels_of(fixed.values));
  }
  if (!values.probe.empty()) {
    const auto& probe = block().probe->values;
    values.values.insert(values.values.end(), probe.begin(), probe.end());
  }
  if (plan.condition.empty()) {
    plan.condition = record::condition_label({block().name});
  }
  give_thresholds(values);
  ++begun_;
  return next;
}

/// Whether a probe comes: in blocks with procedures, whose number of trials is open, it comes by
/// chance.
bool TrialSequence::probe_comes(const Block& block) const {
  if (!block.probe || probe_before_) {
    return false;
  }
  RandomStream random(taker_.session_seed, fmt::format("probe {} {}", at_, in_block_));
  // A trial after a probe is never one, so the others take its share.
  const double share = block.probe->share;
  return random.uniform() < share / (1.0 - share);
}

/// Whether a trial with these values would be one too many in a row.
bool TrialSequence::breaks_rule(const std::vector<GivenValue>& values) const {
  return std::ranges::any_of(d_.order.most_in_a_row, [&](const RunLimit& limit) {
    const auto most = static_cast<std::ptrdiff_t>(limit.most);
    const std::string level = level_of(values, limit.factor);
    return !level.empty() && std::ssize(combinations_) >= most &&
           std::all_of(combinations_.end() - most, combinations_.end(),
                       [&](const auto& each) { return level_of(each, limit.factor) == level; });
  });
}

/// One of the open tracks, by the share of trials that each still has; not one that would break the
/// rule, unless all would.
std::size_t TrialSequence::pick(const std::vector<std::size_t>& open) const {
  if (open.size() == 1) {
    return open.front();
  }
  std::vector<std::size_t> allowed;
  for (const std::size_t i : open) {
    if (!breaks_rule(running_[i].values)) {
      allowed.push_back(i);
    }
  }
  const std::vector<std::size_t>& among = allowed.empty() ? open : allowed;
  std::vector<double> weights;
  for (const std::size_t i : among) {
    const RunningTrack& each = running_[i];
    weights.push_back(each.track->listed
                          ? static_cast<double>(std::max(1, each.track->most_trials - each.trials))
                          : 1.0);
  }
  RandomStream random(taker_.session_seed, fmt::format("interleave {} {}", at_, in_block_));
  double place = random.uniform() * std::accumulate(weights.begin(), weights.end(), 0.0);
  for (std::size_t k = 0; k + 1 < among.size(); ++k) {
    if ((place -= weights[k]) < 0.0) {
      return among[k];
    }
  }
  return among.back();
}

void TrialSequence::choose_track(NextTrial& next) {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < running_.size(); ++i) {
    if (is_open(running_[i])) {
      open.push_back(i);
    }
  }
  const std::size_t chosen = pick(open);
  RunningTrack& running = running_[chosen];
  next.track = static_cast<int>(chosen);
  next.asked = running.procedure->next();
  if (chooser_ != nullptr) {
    next.asked = chooser_->choose(
        {next.plan.trial, next.plan.practice, running.name, *running.track, next.asked});
  }
  next.applied = running.track->applied(next.asked);
  const std::vector<std::string> variables = running.track->variables();
  for (std::size_t i = 0; i < variables.size(); ++i) {
    next.values.levels.emplace_back(variables[i], next.applied[i]);
  }
  next.values.values.insert(next.values.values.end(), running.values.begin(), running.values.end());
  add_factors(next, running.track->by, chosen, running.trials);
  next.plan.condition = record::condition_label(levels_of(running.values));
  if (probe_comes(block())) {
    next.values.probe = block().probe->name;
    next.track = -1;
  } else {
    combinations_.push_back(running.values);
  }
}

/// The factors that no track is settled by come in cycles of their own within each track.
void TrialSequence::add_factors(NextTrial& next, const std::vector<std::string>& settled,
                                std::size_t stream, int count) const {
  std::vector<const Factor*> factors;
  for (const Factor* factor : d_.varied_in(block())) {
    if (std::find(settled.begin(), settled.end(), factor->name) == settled.end()) {
      factors.push_back(factor);
    }
  }
  if (factors.empty()) {
    return;
  }
  const auto combinations = crossed(factors);
  const auto size = static_cast<int>(combinations.size());
  RandomStream random(taker_.session_seed,
                      fmt::format("factors {} {} {}", at_, stream, count / size));
  const auto order = shuffled_indices(combinations.size(), random);
  const auto& values = combinations[order[static_cast<std::size_t>(count % size)]];
  next.values.values.insert(next.values.values.end(), values.begin(), values.end());
}

void TrialSequence::conclude(bool presented, double outcome, bool right) {
  if (!next_) {
    throw std::logic_error("TrialSequence: no trial has been asked for");
  }
  const NextTrial done = std::move(*next_);
  next_.reset();
  failed_ += presented ? 0 : 1;
  if (!presented) {
    return;
  }
  right_in_a_row_ = right ? right_in_a_row_ + 1 : 0;
  probe_before_ = !done.values.probe.empty();
  if (running_.empty()) {
    ++fixed_at_;
  } else if (done.track >= 0) {
    RunningTrack& running = running_[static_cast<std::size_t>(done.track)];
    ++running.trials;
    if (std::isfinite(outcome)) {
      running.procedure->report(outcome, done.applied);
      if (chooser_ != nullptr) {
        chooser_->told(running.name, {outcome, done.applied});
      }
    }
  }
}

void TrialSequence::postpone() {
  if (!next_) {
    throw std::logic_error("TrialSequence: no trial has been asked for");
  }
  const NextTrial done = *std::exchange(next_, std::nullopt);
  ++failed_;
  if (running_.empty()) {
    const Fixed again = fixed_[fixed_at_++];
    fixed_.push_back(again);
  } else if (done.track >= 0) {
    running_[static_cast<std::size_t>(done.track)].procedure->postpone();
  }
}

}  // namespace haptrial::protocols
