#include "protocols/psychophysics/live_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/short_numbers.h"

namespace haptrial::protocols {
namespace {

std::string mark_of(const record::ResponseRow& response) {
  return response.correct == 1 ? "✓" : response.correct == 0 ? "✗" : response.text;
}

/// "✓ 0.84 s"
std::string words_of(const record::ResponseRow& response) {
  const std::string answer = mark_of(response).empty() && std::isfinite(response.value)
                                 ? fmt::format("{:.4g}", response.value)
                                 : mark_of(response);
  return std::isfinite(response.reaction_time)
             ? fmt::format("{} {:.2f} s", answer, response.reaction_time)
             : answer;
}

}  // namespace

void LiveTrials::begin(const NextTrial& next, const std::vector<RunningTrack>& running) {
  now_ = next;
  track_.clear();
  reversals_ = -1;
  if (next.track < 0) {
    return;
  }
  const RunningTrack& track = running[static_cast<std::size_t>(next.track)];
  track_ = track.name;
  variable_ = track.track->variables().front();
  unit_ = track.track->unit;
  reversals_ = track.procedure->counted_reversals().value_or(-1);
}

void LiveTrials::conclude(const Outcome& outcome) {
  if (!now_ || outcome.end != TrialEnd::kCompleted || outcome.responses.empty()) {
    return;
  }
  AnsweredTrial answered{outcome.trial.condition, now_->track, 0.0, outcome.responses.front(),
                         outcome.trial.practice};
  answered.level = now_->applied.empty() ? 0.0 : now_->applied.front();
  answered_.push_back(std::move(answered));
}

std::optional<record::LiveState> LiveTrials::state() const {
  if (!now_) {
    return std::nullopt;
  }
  record::LiveState state;
  state.trial = now_->plan.trial;
  state.practice = now_->plan.practice;
  state.title = fmt::format("{} {}", state.practice ? "Practice trial" : "Trial", state.trial);
  state.figures.push_back({"Condition", short_numbers(now_->plan.condition)});
  if (!track_.empty()) {
    state.figures.push_back({fmt::format("Level now, {}", variable_),
                             fmt::format("{:.4g} {}", now_->applied.front(), unit_)});
  }
  if (reversals_ >= 0) {
    state.figures.push_back({"Reversals", fmt::format("{}", reversals_)});
  }
  add_shares(state);
  add_last_answers(state);
  add_track(state);
  state.line = state.title;
  for (const record::LiveState::Figure& figure : state.figures) {
    state.line += fmt::format(", {} {}", figure.name, figure.value);
  }
  return state;
}

/// The newest first.
void LiveTrials::add_last_answers(record::LiveState& state) const {
  constexpr std::size_t kLast = 10;
  std::string last;
  for (std::size_t i = answered_.size(); i > 0 && answered_.size() - i < kLast; --i) {
    last += (last.empty() ? "" : ", ") + words_of(answered_[i - 1].first);
  }
  if (!last.empty()) {
    state.figures.push_back({"Last answers, newest first", last});
  }
}

/// Practice is counted apart; a condition without right answers has no line.
void LiveTrials::add_shares(record::LiveState& state) const {
  std::map<std::string, std::pair<int, int>> counts;  // correct, answered
  for (const AnsweredTrial& each : answered_) {
    if (each.first.correct >= 0) {
      auto& [correct, all] = counts[each.practice ? "practice" : short_numbers(each.condition)];
      correct += each.first.correct;
      ++all;
    }
  }
  for (const auto& [condition, count] : counts) {
    const auto& [correct, all] = count;
    state.figures.push_back({"Correct, " + condition, fmt::format("{} of {} ({:.0f} %)", correct,
                                                                  all, 100.0 * correct / all)});
  }
}

void LiveTrials::add_track(record::LiveState& state) const {
  for (const AnsweredTrial& each : answered_) {
    if (now_->track >= 0 && each.track == now_->track) {
      state.track.push_back({each.level, each.first.correct});
    }
  }
  state.track_name = track_;
}

}  // namespace haptrial::protocols
