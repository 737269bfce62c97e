// The onsets that the servo thread hands over: of a defined trial, and of any other pass.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/stream/onset_log.h"
#include "protocols/interface/session_task.h"
#include "protocols/psychophysics/presentation/trial_pass.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/scripted_device.h"

namespace haptrial::protocols::marked_task_test {
namespace {

using markers::TimedOnset;
using record::MarkerOf;

constexpr double kDt = 1e-3;

IntervalRun interval(int marker) {
  Stage ready, feel;
  ready.until.time = 0.01;
  feel.until.time = 0.02;
  std::vector<scene::Scene> scenes;
  scenes.emplace_back(std::vector<scene::Field>{}, 1.0 / kDt);
  IntervalRun run{std::move(scenes), StageMachine({ready, feel}, {}, 0), {}, 0, marker};
  run.sights.resize(2);
  run.sights[1].sound = 3;
  return run;
}

/// Two choices by buttons 0 and 1.
const TrialQuestion& question() {
  static const TrialQuestion asked = [] {
    TrialQuestion q;
    q.name = "answer";
    q.choices = {{"yes", "yes"}, {"no", "no"}};
    q.means = {{"", 0, 1}, {"", 0, 2}};
    return q;
  }();
  return asked;
}

/// The pass has stages of /samples, which no protocol names.
class StagedPass final : public Pass {
 public:
  PassOutput tick(const Readings&, double) noexcept override {
    PassOutput out;
    out.stage = done_ < 5    ? record::Stage::kApproach
                : done_ < 8  ? record::Stage::kWait
                : done_ < 20 ? record::Stage::kRun
                             : record::Stage::kReturn;
    ++done_;
    return out;
  }
  PassState state() const noexcept override {
    return done_ < 25 ? PassState::kRunning : PassState::kCompleted;
  }

 private:
  int done_{0};
};

class MarkedTaskTest : public testing::Test {
 protected:
  MarkedTaskTest()
      : task_({.devices = {{&device_, limits()}}, .log = log_, .onsets = &onsets_},
              SessionTask::Leave::kNever, {1000, 0}) {}
  static device::EnvelopeLimits limits() {
    device::EnvelopeLimits l;
    l.ramp_in = l.ramp_out = 0.0;
    return l;
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i, ++index_) {
      task_.tick({index_, static_cast<std::int64_t>(index_) * 1'000'000, kDt});
    }
  }
  std::vector<TimedOnset> taken() {
    std::vector<TimedOnset> all;
    onsets_.take([&](const TimedOnset& onset) { all.push_back(onset); });
    return all;
  }

  test::ScriptedDevice device_;
  SessionTask::Log log_{256, 64};
  markers::OnsetLog onsets_;
  SessionTask task_;
  std::uint64_t index_{0};
};

TEST_F(MarkedTaskTest, ATrialTellsWhatBeginsOnWhichTick) {
  TrialPass::Setup setup;
  setup.intervals.push_back(interval(1));
  setup.intervals.push_back(interval(0));
  setup.questions = {{&question()}};
  setup.questions[0].marker = 4;
  TrialPass pass(std::move(setup));
  device_.on_read = [](std::size_t tick, device::DeviceReading& reading) {
    reading.buttons = tick == 90 ? 2 : 0;  // "no"
    return true;
  };
  ticks(3);
  task_.start(pass, 7);
  ticks(120);
  ASSERT_TRUE(task_.idle());
  const auto all = taken();
  // trial; interval and two stages, twice; the answer; the end
  ASSERT_EQ(all.size(), 9u);
  EXPECT_EQ(all[0].onset.what, MarkerOf::kTrial);
  EXPECT_EQ(all[0].sequence, 1003u);
  EXPECT_EQ(all[0].sequence, task_.result().first_sample);
  std::uint64_t number = 0;
  for (const TimedOnset& onset : all) {
    EXPECT_EQ(onset.pass, 7);
    EXPECT_EQ(onset.time_ns, static_cast<std::int64_t>(onset.sequence - 1000) * 1'000'000);
    EXPECT_EQ(onset.over, &onset == &all.back());
    EXPECT_EQ(onset.number, onset.over ? 0 : ++number);
  }
  EXPECT_EQ(onsets_.count(), 8u);
  for (const int at : {1, 4}) {
    const auto i = static_cast<std::size_t>(at);
    const auto place = static_cast<std::size_t>(at == 1 ? 0 : 1);
    EXPECT_EQ(all[i].onset.what, MarkerOf::kInterval);
    EXPECT_EQ(all[i].onset.index, at == 1 ? 1 : 0) << "which of the definition";
    EXPECT_EQ(all[i].onset.interval, at == 1 ? 1 : 2) << "its place in the trial";
    EXPECT_EQ(all[i].sequence, pass.first_tick(place));
    for (const std::size_t stage : {0u, 1u}) {
      const TimedOnset& onset = all[i + 1 + stage];
      EXPECT_EQ(onset.onset.what, MarkerOf::kStage);
      EXPECT_EQ(onset.onset.index, static_cast<int>(stage));
      EXPECT_EQ(onset.onset.sound, stage == 1 ? 3 : -1);
      EXPECT_EQ(onset.sequence,
                pass.first_tick(place) +
                    static_cast<std::uint64_t>(pass.machine(place).times()[stage].begin))
          << "as /stages has it";
    }
  }
  EXPECT_EQ(all[7].onset.what, MarkerOf::kResponse);
  EXPECT_EQ(all[7].onset.index, 5) << "the second answer from 4 on";
  EXPECT_EQ(all[7].sequence, pass.answers().at(0).sequence);
  EXPECT_EQ(all[7].sequence, 1090u) << "the tick of the button";
}

TEST_F(MarkedTaskTest, TheFeedbackHasItsSound) {
  TrialPass::Setup setup;
  setup.intervals.push_back(interval(-1));
  setup.questions = {{&question(), 1, true}};  // "no" is right, and told
  setup.feedback_time = 0.01;
  setup.sound_right = 5;
  setup.sound_wrong = 6;
  TrialPass pass(std::move(setup));
  device_.on_read = [](std::size_t tick, device::DeviceReading& reading) {
    reading.buttons = tick == 50 ? 2 : 0;
    return true;
  };
  task_.start(pass, 0);
  ticks(80);
  const auto all = taken();
  ASSERT_EQ(all.size(), 5u) << "no interval: there is one only";
  EXPECT_EQ(all[3].onset.what, MarkerOf::kResponse);
  EXPECT_EQ(all[3].onset.sound, 5);
}

TEST_F(MarkedTaskTest, APassThatNamesNoOnsetsHasThoseOfItsStages) {
  StagedPass pass;
  task_.start(pass, 2);
  ticks(40);
  const auto all = taken();
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[0].onset.what, MarkerOf::kTrial);
  const std::vector<std::uint64_t> begins{1000, 1005, 1008, 1020};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(all[i + 1].onset.what, MarkerOf::kStage);
    EXPECT_EQ(all[i + 1].onset.index, static_cast<int>(i));
    EXPECT_EQ(all[i + 1].sequence, begins[i]);
  }
  EXPECT_TRUE(all[5].over);
}

TEST_F(MarkedTaskTest, TheTickAllocatesNothing) {
  TrialPass::Setup setup;
  setup.intervals.push_back(interval(0));
  setup.intervals.push_back(interval(1));
  TrialPass pass(std::move(setup));
  const test::AllocationGuard guard;
  task_.start(pass, 0);
  ticks(100);
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_EQ(onsets_.count(), 7u);
  EXPECT_EQ(onsets_.dropped(), 0u);
}

}  // namespace
}  // namespace haptrial::protocols::marked_task_test
