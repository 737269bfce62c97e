#pragma once

#include <array>
#include <cmath>

#include "core/record/table/table.h"
#include "protocols/interface/pass.h"

/// The participant's view; the drawing and the virtual participant take it from here.
struct SpringView {
  int trial{0};     // from 1
  int interval{0};  // which spring is felt, 1 or 2; 0: none
  bool asked{false};
  bool engaged() const { return interval > 0 || asked; }
};

/// The two springs of a pass: a row of the protocol's own table.
struct SpringRow {
  std::int32_t pass{0};               // row of /trials
  double difference{0.0};             // of the staircase [N/m]
  std::array<double, 2> stiffness{};  // [N/m]
};

/// One comparison: either spring pushes up below y = 0 for `interval` seconds; then the buttons.
class SpringPass final : public haptrial::protocols::Pass {
 public:
  SpringPass(int trial, const std::array<double, 2>& stiffness, double interval)
      : view_{trial}, stiffness_(stiffness), interval_(interval) {}

  haptrial::protocols::PassOutput tick(const haptrial::protocols::Readings& readings,
                                       double dt) noexcept override {
    time_ += dt;
    const double passed = time_ / interval_;
    view_.interval = passed < 2.0 ? 1 + static_cast<int>(passed) : 0;
    view_.asked = passed >= 2.0;
    haptrial::protocols::PassOutput out;
    out.stage = view_.asked ? haptrial::record::Stage::kWait : haptrial::record::Stage::kRun;
    out.shown = haptrial::stimulus::Shown(view_);
    out.shown.tool = readings[0].tool.position;
    if (view_.interval > 0) {
      out.force.y() =
          stiffness_[view_.interval - 1] * std::max(0.0, -readings[0].tool.position.y());
    } else if ((readings[0].buttons & 3u) != 0) {
      answer_ = (readings[0].buttons & 1u) != 0 ? 1 : 2;
    }
    return out;
  }
  haptrial::protocols::PassState state() const noexcept override {
    constexpr double kPatience = 30.0;  // [s]
    using haptrial::protocols::PassState;
    return answer_ != 0                          ? PassState::kCompleted
           : time_ > 2.0 * interval_ + kPatience ? PassState::kAborted
                                                 : PassState::kRunning;
  }
  int answer() const { return answer_; }                            // 1 or 2; 0: none yet
  double reaction_time() const { return time_ - 2.0 * interval_; }  // [s]

 private:
  SpringView view_;
  std::array<double, 2> stiffness_;
  double interval_;
  double time_{0.0};
  int answer_{0};
};
