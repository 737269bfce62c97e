#include "experiments/studies/trials/live_trials.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <exception>
#include <map>
#include <set>
#include <utility>

#include "core/base/text/exception_words.h"
#include "core/record/read/session_reader.h"
#include "core/record/trials/trial_rows.h"

namespace haptrial::experiments {

LiveTrials::LiveTrials(std::string unit, const std::filesystem::path& resumed)
    : unit_(std::move(unit)) {
  if (!resumed.empty()) {
    add_resumed(resumed);
  }
}

void LiveTrials::add_resumed(const std::filesystem::path& file) {
  try {
    const record::SessionReader reader(file);
    const auto passes = reader.passes();
    std::set<std::int32_t> out;  // passes whose answers do not count
    std::map<int, std::int32_t> last;
    for (std::size_t i = 0; i < passes.size(); ++i) {
      if (passes[i].practice) {
        out.insert(static_cast<std::int32_t>(i));
      } else if (const auto [at, fresh] =
                     last.try_emplace(passes[i].trial, static_cast<std::int32_t>(i));
                 !fresh) {
        out.insert(std::exchange(at->second, static_cast<std::int32_t>(i)));
      }
    }
    for (const record::OutOfTimeRow& row : reader.rows<record::OutOfTimeRow>()) {
      if (row.again) {
        out.insert(row.pass);
      }
    }
    for (const record::ResponseRow& row : reader.responses()) {
      const auto at = static_cast<std::size_t>(row.pass);
      if (row.correct >= 0 && row.pass >= 0 && at < passes.size() && !out.contains(row.pass)) {
        Judged& own = judged_[passes[at].trial];
        own.right += row.correct;
        ++own.answers;
      }
    }
  } catch (const std::exception& error) {  // nothing that a session should end for
    trouble_ = fmt::format("live figures leave out the trials before the session was resumed: {}",
                           sentence_of(error));
  }
}

void LiveTrials::begin_pass(const record::PassRow& pass, std::int32_t row) {
  const std::lock_guard lock(mutex_);
  present_ = row;
  trials_[row] = {pass.trial, pass.practice, false, "", {}, false, false};
  if (!pass.practice) {
    judged_.erase(pass.trial);
  }
}

void LiveTrials::end_pass(const record::PassRow&) {
  const std::lock_guard lock(mutex_);
  if (const auto at = trials_.find(present_); at != trials_.end()) {
    at->second.ended = true;
  }
}

void LiveTrials::rows(const record::Rows& rows) {
  const std::lock_guard lock(mutex_);
  for (const record::LevelRow& row : rows.as<record::LevelRow>()) {
    if (const auto at = trials_.find(row.pass); at != trials_.end()) {
      at->second.level += fmt::format("{}{:.4g}{}", at->second.level.empty() ? "" : ", ",
                                      row.applied, unit_.empty() ? "" : " " + unit_);
    }
  }
  for (const record::OutOfTimeRow& row : rows.as<record::OutOfTimeRow>()) {
    const auto at = trials_.find(row.pass);
    if (row.again && at != trials_.end() && !at->second.practice) {
      at->second.again = true;
      judged_.erase(at->second.number);
    }
  }
  for (const record::ResponseRow& row : rows.as<record::ResponseRow>()) {
    add(row);
  }
}

void LiveTrials::add(const record::ResponseRow& row) {
  const auto at = trials_.find(row.pass >= 0 ? row.pass : present_);
  if (at == trials_.end()) {
    return;
  }
  Trial& trial = at->second;
  std::string answer = row.text.empty() ? fmt::format("{:g}", row.value) : row.text;
  if (row.correct >= 0) {
    answer += row.correct == 1 ? " (right)" : " (wrong)";
    trial.wrong = trial.wrong || row.correct == 0;
    if (!trial.practice && !trial.again) {
      Judged& own = judged_[trial.number];
      own.right += row.correct;
      ++own.answers;
    }
  }
  trial.answers.push_back(std::move(answer));
}

record::LiveState LiveTrials::state_of(const Trial& trial) const {
  const std::string none = "\u2013";
  record::LiveState state;
  state.trial = trial.practice ? 0 : trial.number;
  state.practice = trial.practice;
  state.title = trial.practice ? "Practice" : fmt::format("Trial {}", trial.number);
  const std::string answer =
      trial.answers.empty() ? none : fmt::format("{}", fmt::join(trial.answers, ", "));
  state.figures = {{"Level", trial.level.empty() ? none : trial.level, false},
                   {"Answer", answer, false}};
  state.line = state.title;
  state.line += trial.level.empty() ? "" : ": level " + trial.level;
  state.line += trial.answers.empty() ? "" : ", answer " + answer;
  Judged all;
  for (const auto& [number, own] : judged_) {
    all.right += own.right;
    all.answers += own.answers;
  }
  if (all.answers > 0) {
    const std::string right = fmt::format("{} of {} ({:.0f} %)", all.right, all.answers,
                                          100.0 * all.right / static_cast<double>(all.answers));
    state.figures.push_back({"Right so far", right, false});
    state.line += ", right so far " + right;
  }
  return state;
}

std::optional<record::LiveState> LiveTrials::now() const {
  const std::lock_guard lock(mutex_);
  const auto at = trials_.find(present_);
  return at == trials_.end() ? std::nullopt : std::optional(state_of(at->second));
}

std::vector<record::LiveState> LiveTrials::done() const {
  const std::lock_guard lock(mutex_);
  std::vector<record::LiveState> states;
  for (const auto& [row, trial] : trials_) {
    if (trial.ended && !trial.practice) {
      states.push_back(state_of(trial));
    }
  }
  return states;
}

std::string LiveTrials::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

}  // namespace haptrial::experiments
