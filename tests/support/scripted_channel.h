#pragma once

#include <condition_variable>
#include <deque>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/channel/channel_kinds.h"

namespace haptrial::test {

/// An instrument that a test plays: what it gives, fails with or says comes in that order.
class ScriptedInstrument {
 public:
  struct Step {
    std::vector<double> values{};
    double device_time{std::numeric_limits<double>::quiet_NaN()};
    std::uint64_t lost{0};
    std::string failure{};  // the instrument is lost for this reason
    std::string fault{};    // a status says so, in the place of a sample
  };
  void give(Step step) {
    const std::lock_guard lock(mutex_);
    steps_.push_back(std::move(step));
    changed_.notify_all();
  }
  /// Why it cannot be opened; empty: it can.
  void refuse(const std::string& why) {
    const std::lock_guard lock(mutex_);
    refusal_ = why;
  }
  void open() {
    const std::lock_guard lock(mutex_);
    if (!refusal_.empty()) {
      throw RunError(refusal_);
    }
  }
  /// Whether everything was given on.
  bool is_idle() {
    const std::lock_guard lock(mutex_);
    return steps_.empty() && waits_;
  }
  void read(channel::ChannelInbox& into, std::chrono::milliseconds patience) {
    Step step;
    {
      std::unique_lock lock(mutex_);
      waits_ = steps_.empty();
      if (!changed_.wait_for(lock, patience, [this] { return !steps_.empty(); })) {
        return;
      }
      step = std::move(steps_.front());
      steps_.pop_front();
    }
    if (!step.failure.empty()) {
      throw RunError(step.failure);
    }
    if (!step.fault.empty()) {
      into.note(channel::Incident::kStatus, 1.0, step.fault);
      return;
    }
    into.take({step.values, step.device_time, 0.0, step.lost});
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Step> steps_;
  std::string refusal_;
  bool waits_{false};  // the last reading began without a step
};

/// A kind of channel of the tests' own: kind = "scripted", with quantities and a rate.
inline channel::ChannelKind scripted_kind(const std::shared_ptr<ScriptedInstrument>& instrument) {
  class Source final : public channel::ChannelSource {
   public:
    explicit Source(std::shared_ptr<ScriptedInstrument> played) : played_(std::move(played)) {
      played_->open();
    }
    void read(channel::ChannelInbox& into, std::chrono::milliseconds patience) override {
      played_->read(into, patience);
    }

   private:
    std::shared_ptr<ScriptedInstrument> played_;
  };
  return {"scripted", "an instrument that a test plays", [instrument](Table& table) {
            channel::ChannelPlan plan;
            plan.quantities = channel::read_quantities(table, "quantities");
            plan.rate = table.number_or("rate", 0, {0.0, 1e5}, "Hz");
            plan.open = [instrument] { return std::make_unique<Source>(instrument); };
            return plan;
          }};
}

}  // namespace haptrial::test
