#include "analysis/psychophysics/data/trials_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <shared_mutex>
#include <unordered_map>

namespace haptrial::analysis::trials {

bool TrialsData::simulated() const {
  return std::any_of(sessions.begin(), sessions.end(),
                     [](const StudySession& session) { return session.simulated; });
}

const GivenAnswer* answer_to(const StudyTrial& trial, const std::string& question) {
  const auto at = std::find_if(trial.answers.begin(), trial.answers.end(), [&](const auto& each) {
    return question.empty() || each.question == question;
  });
  return at == trial.answers.end() ? nullptr : &*at;
}

const StageTime* last_stage(const StudyTrial& trial, const std::string& stage) {
  const auto at = std::find_if(trial.stages.rbegin(), trial.stages.rend(),
                               [&](const StageTime& each) { return each.stage == stage; });
  return at == trial.stages.rend() ? nullptr : &*at;
}

const GivenVariable* variable_of(const StudyTrial& trial, const std::string& name, int interval) {
  const auto at = std::find_if(
      trial.variables.begin(), trial.variables.end(),
      [&](const auto& each) { return each.name == name && each.interval == interval; });
  return at == trial.variables.end() ? nullptr : &*at;
}

std::string word_of(const GivenVariable& variable) {
  return variable.word.empty() ? fmt::format("{}", variable.value) : variable.word.text();
}

std::string factor_level(const TrialsData& data, const StudyTrial& trial,
                         const std::string& factor) {
  if (factor == "group") {
    return data.session_of(trial).group;
  }
  if (factor == "session") {
    const StudySession& session = data.session_of(trial);
    return session.name.empty() ? fmt::format("{}", session.session) : session.name;
  }
  if (factor == "condition") {
    return trial.condition;
  }
  if (factor == "probe") {
    return trial.probe;
  }
  if (factor == "track") {
    return trial.levels.empty() ? std::string() : trial.levels.front().track.text();
  }
  const GivenVariable* variable = variable_of(trial, factor);
  if (variable == nullptr && factor == "block") {
    return fmt::format("{}", trial.block);
  }
  return variable != nullptr ? word_of(*variable) : std::string();
}

namespace {

/// Words by number. Those that are there stay where they are while others are added, so that
/// looking at one takes no lock.
class TextStore {
 public:
  TextStore() { add({}); }

  std::uint32_t number_of(std::string_view text) {
    {
      const std::shared_lock reading(mutex_);
      if (const auto at = numbers_.find(text); at != numbers_.end()) {
        return at->second;
      }
    }
    const std::scoped_lock writing(mutex_);
    const auto at = numbers_.find(text);
    return at != numbers_.end() ? at->second : add(text);
  }

  const std::string& text(std::uint32_t number) const noexcept {
    return blocks_[number / kBlock].load(std::memory_order_acquire)[number % kBlock];
  }

 private:
  static constexpr std::uint32_t kBlock = 1024;

  std::uint32_t add(std::string_view text) {
    const std::uint32_t number = count_;
    auto& block = blocks_.at(number / kBlock);  // throws if there is no room
    if (number % kBlock == 0) {
      block.store(new std::string[kBlock], std::memory_order_release);  // lives as long as we do
    }
    std::string& kept = block.load(std::memory_order_relaxed)[number % kBlock];
    kept = text;
    numbers_.emplace(kept, number);
    count_ = number + 1;
    return number;
  }

  std::shared_mutex mutex_;
  std::uint32_t count_{0};
  std::array<std::atomic<std::string*>, 4096> blocks_{};
  std::unordered_map<std::string_view, std::uint32_t> numbers_;
};

TextStore& words() {
  static auto* const all = new TextStore;  // never gone: others look at it to the end
  return *all;
}

}  // namespace

std::uint32_t Word::number_of(std::string_view text) {
  return text.empty() ? 0 : words().number_of(text);
}

const std::string& Word::text() const noexcept { return words().text(number_); }

}  // namespace haptrial::analysis::trials
