#include "protocols/force_training/recorded_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "protocols/force_training/training_pass.h"
#include "protocols/interface/session_task.h"
#include "tests/support/scripted_device.h"

namespace haptrial::protocols::recorded_pass_test {
namespace {

using record::Phase;
using stimulus::Presentation;

constexpr double kRate = 1000.0;

const stimulus::Stimulus& stimulus_of_study() {
  static const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  return stimulus;
}

struct Witness final : stimulus::Observer {
  void observe(const stimulus::Shown& shown, const stimulus::Forces&, double) noexcept override {
    seen.push_back(stimulus::presentation_of(shown));
  }
  std::vector<Presentation> seen;
};

struct Lived {
  std::vector<Presentation> seen;
  std::vector<record::Sample> samples;
  PassResult result;
};

/// A pass as the servo thread runs it, with a hand that trembles at the start of the path.
Lived live(Pass& pass, std::size_t jump_at = 0) {
  test::ScriptedDevice device;
  const Eigen::Vector3d start = stimulus_of_study().path.points().front();
  device.on_read = [&](std::size_t tick, device::DeviceReading& reading) {
    const double tremble = 1e-3 * std::sin(0.01 * static_cast<double>(tick));
    reading.tool.position = start + Eigen::Vector3d(tremble, -tremble, 0.5 * tremble);
    if (jump_at > 0 && tick >= jump_at) {
      reading.tool.position.y() += 0.03;
    }
    return true;
  };
  Witness witness;
  SessionTask::Log log;
  device::EnvelopeLimits limits;
  limits.max_saturation = 600.0;  // this hand does not follow
  SessionTask task(device, limits, log, {&witness}, SessionTask::Leave::kAfterPassOrSlice);
  realtime::ServoLoop loop(realtime::ClockKind::kSimulated, kRate);
  Lived lived;
  const auto keep = [&](std::span<const record::Sample> rows) {
    lived.samples.insert(lived.samples.end(), rows.begin(), rows.end());
  };
  task.start(pass, 0);
  while (!task.idle()) {
    loop.run(task);
    log.drain(keep);
  }
  log.flush(keep);
  lived.seen = witness.seen;
  lived.result = task.result();
  return lived;
}

void expect_same(const Presentation& a, const Presentation& b) {
  EXPECT_EQ(a.tool, b.tool);
  EXPECT_EQ(a.show_trajectory, b.show_trajectory);
  EXPECT_EQ(a.show_target_bar, b.show_target_bar);
  EXPECT_EQ(a.show_applied_bar, b.show_applied_bar);
  EXPECT_EQ(a.show_saturation, b.show_saturation);
  EXPECT_EQ(a.target_force, b.target_force);
  EXPECT_EQ(a.applied_force, b.applied_force);
  EXPECT_EQ(a.progress, b.progress);
  EXPECT_EQ(a.pass_duration, b.pass_duration);
  EXPECT_EQ(a.block, b.block);
  EXPECT_EQ(a.instruction, b.instruction);
}

void expect_replayed(const std::string& condition, Phase phase, std::size_t jump_at) {
  const auto lived_pass = make_pass(condition, phase, stimulus_of_study(), {}, 4);
  const Lived lived = live(*lived_pass, jump_at);
  const auto replayed_pass = make_pass(condition, phase, stimulus_of_study(), {}, 4);
  const auto seen = presentations(*replayed_pass, lived.samples, kRate);
  ASSERT_EQ(seen.size(), lived.seen.size());
  ASSERT_GT(seen.size(), 3000u);
  for (std::size_t i = 0; i < seen.size() && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << condition << ", tick " << i);
    expect_same(seen[i], lived.seen[i]);
  }
  const auto runs = std::ranges::count_if(
      lived.seen, [](const Presentation& p) { return p.progress > 0.0 && p.progress < 1.0; });
  EXPECT_GT(runs, 1000) << "the pass came to its run";
  EXPECT_EQ(lived.result.state, jump_at > 0 ? PassState::kAborted : PassState::kCompleted);
}

TEST(RecordedPassTest, EveryKindOfPassIsSeenAgainAsItWas) {
  for (const std::string& condition : training_conditions()) {
    if (has_expert(condition)) {
      continue;  // they are seen again from their rows (ExpertPassesTest)
    }
    expect_replayed(condition, Phase::kTraining, 0);
  }
  expect_replayed("visual", Phase::kTest, 0);
}

TEST(RecordedPassTest, AFaultTakesThePictureAwayInTheReplayToo) {
  expect_replayed("visuohaptic", Phase::kTraining, 4000);
}

TEST(RecordedPassTest, TheTestIsTheSameForEveryCondition) {
  const auto one = make_pass("visual", Phase::kTest, stimulus_of_study(), {}, 1);
  const auto other = make_pass("haptic", Phase::kTest, stimulus_of_study(), {}, 1);
  const PassMoment moment{Eigen::Vector3d::Zero(), record::Stage::kRun, 1.0, 2.0, 3.0, false};
  expect_same(one->presentation(moment), other->presentation(moment));
  EXPECT_FALSE(one->presentation(moment).show_target_bar);
  EXPECT_TRUE(make_pass("visual", Phase::kTraining, stimulus_of_study(), {}, 1)
                  ->presentation(moment)
                  .show_target_bar);
  EXPECT_THROW(make_pass("smell", Phase::kTraining, stimulus_of_study(), {}, 1),
               std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::protocols::recorded_pass_test
