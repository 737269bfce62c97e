#include "experiments/runner/reported_mistakes.h"

#include <fmt/format.h>

#include <utility>

namespace haptrial::experiments {

ReportedMistakes::ReportedMistakes(std::function<void(const std::string& trial)> report)
    : report_(std::move(report)) {}

void ReportedMistakes::see_to(const record::PassRow& last) {
  if (pressed_ns_.exchange(kNever) != kNever) {
    note(answered_.value_or(last));
  }
}

void ReportedMistakes::close_pass(const record::PassRow& pass,
                                  std::optional<std::int64_t> answered_ns) {
  if (const std::int64_t pressed_ns = pressed_ns_.exchange(kNever); pressed_ns != kNever) {
    const bool after = answered_ns && *answered_ns <= pressed_ns;
    note(after ? pass : answered_.value_or(pass));
  }
  if (answered_ns) {
    answered_ = pass;
  }
}

void ReportedMistakes::note(const record::PassRow& pass) {
  const std::string trial =
      fmt::format("{} {}", pass.practice ? "practice trial" : "trial", pass.trial);
  if (pass.trial > 0 && reported_.insert(trial).second) {
    report_(trial);
  }
}

}  // namespace haptrial::experiments
