#pragma once

#include <functional>
#include <mutex>
#include <utility>

#include "core/record/rows/live_figures.h"

namespace haptrial::protocols {

/// Live figures that follow from one row a pass, of the protocol's own table.
template <class Row>
class RowFigures final : public record::LiveFigures {
 public:
  /// @param figures  of one row. Session's thread
  explicit RowFigures(std::function<std::vector<record::LiveState::Figure>(const Row&)> figures)
      : figures_(std::move(figures)) {}

  void begin_pass(const record::PassRow& pass, std::int32_t) override {
    trial_ = pass.practice ? 0 : pass.trial;
  }
  void rows(const record::Rows& rows) override {
    for (const Row& row : rows.as<Row>()) {
      add(figures_(row));
    }
  }
  std::optional<record::LiveState> now() const override {
    const std::lock_guard lock(mutex_);
    return states_.empty() ? std::nullopt : std::optional(states_.back());
  }
  std::vector<record::LiveState> done() const override {
    const std::lock_guard lock(mutex_);
    std::vector<record::LiveState> done = states_;
    std::erase_if(done, [](const record::LiveState& state) { return state.practice; });
    return done;
  }

 private:
  void add(std::vector<record::LiveState::Figure> figures) {
    record::LiveState state;
    state.trial = trial_;
    state.practice = trial_ == 0;
    state.title = state.practice ? "Practice" : "Trial " + std::to_string(trial_);
    state.line = state.title;
    for (const record::LiveState::Figure& figure : figures) {
      state.line += (&figure == figures.data() ? ": " : ", ") + figure.name + " " + figure.value;
    }
    state.figures = std::move(figures);
    const std::lock_guard lock(mutex_);
    states_.push_back(std::move(state));
  }

  std::function<std::vector<record::LiveState::Figure>(const Row&)> figures_;
  int trial_{0};  // session's thread
  mutable std::mutex mutex_;
  std::vector<record::LiveState> states_;
};

}  // namespace haptrial::protocols
