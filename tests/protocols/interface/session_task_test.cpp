#include "protocols/interface/session_task.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <set>
#include <thread>

#include "core/stimulus/presentation.h"
#include "protocols/force_training/trajectory_pass.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/scripted_channel.h"
#include "tests/support/scripted_device.h"
#include "tests/support/wait.h"

namespace haptrial::protocols {
namespace {

using device::DeviceReading;
using device::Fault;
using Eigen::Vector3d;
using Leave = SessionTask::Leave;

constexpr double kDt = 1e-3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Asks for one force over a number of ticks.
class ConstantPass final : public Pass {
 public:
  ConstantPass(const Vector3d& force, int ticks, PassState end = PassState::kCompleted)
      : force_(force), ticks_(ticks), end_(end) {}
  PassOutput tick(const Readings& readings, double) noexcept override {
    ++done_;
    PassOutput out;
    out.force = force_;
    out.stage = record::Stage::kRun;
    out.target_force = 1.5;
    stimulus::Presentation seen;
    seen.tool = readings[0].tool.position;
    seen.block = 9;
    out.shown = seen;
    return out;
  }
  void note_suspension() noexcept override { ++suspensions_; }
  PassState state() const noexcept override { return done_ < ticks_ ? PassState::kRunning : end_; }
  void restart() { done_ = 0; }
  int done() const { return done_; }
  int suspensions() const { return suspensions_; }

 private:
  Vector3d force_;
  int ticks_;
  PassState end_;
  int done_{0};
  int suspensions_{0};
};

struct Witness final : stimulus::Observer {
  void observe(const stimulus::Shown& shown, const stimulus::Forces& all,
               double dt) noexcept override {
    blocks.push_back(stimulus::presentation_of(shown).block);
    forces.push_back(all[0]);
    time += dt;
  }
  std::vector<std::int32_t> blocks;
  std::vector<Vector3d> forces;
  double time{0.0};
};

class SessionTaskTest : public ::testing::Test {
 protected:
  explicit SessionTaskTest(Leave leave = Leave::kNever,
                           const device::EnvelopeLimits& envelope = limits())
      : log_(1024, 128), task_(device_, envelope, log_, {&witness_}, leave) {
    witness_.blocks.reserve(1 << 16);
    witness_.forces.reserve(1 << 16);
  }
  static device::EnvelopeLimits limits() {
    device::EnvelopeLimits l;
    l.ramp_in = 0.0;
    l.ramp_out = 0.0;
    l.max_force_rate = 1e6;
    return l;
  }
  bool tick() {
    const std::uint64_t i = index_++;
    return task_.tick({i, static_cast<std::int64_t>(i) * 1000000, kDt});
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) {
      tick();
    }
  }
  const std::vector<record::Sample>& samples() {
    log_.flush([&](auto rows) { samples_.insert(samples_.end(), rows.begin(), rows.end()); });
    return samples_;
  }
  /// Every tick was recorded, once and in order, with the force that went to the device.
  void expect_all_recorded() {
    const auto rows = samples();
    ASSERT_EQ(rows.size(), index_);
    ASSERT_EQ(device_.written.size(), index_);
    for (std::uint64_t i = 0; i < index_; ++i) {
      ASSERT_EQ(rows[i].sequence, i);
      ASSERT_EQ(rows[i].time_ns, static_cast<std::int64_t>(i) * 1000000);
      ASSERT_EQ(rows[i].force, device_.written[i]) << i;
      ASSERT_EQ(witness_.forces[i], device_.written[i]) << i;
    }
    EXPECT_EQ(log_.dropped(), 0u);
  }

  test::ScriptedDevice device_;
  Witness witness_;
  SessionTask::Log log_;
  SessionTask task_;
  std::uint64_t index_{0};
  std::vector<record::Sample> samples_;
};

class LeavingTaskTest : public SessionTaskTest {
 protected:
  LeavingTaskTest() : SessionTaskTest(Leave::kAfterPassOrSlice) {}
};

TEST_F(SessionTaskTest, APassRunsAndEverythingElseIsRest) {
  ConstantPass pass({0, 5, 0}, 20);
  ticks(10);
  EXPECT_TRUE(task_.idle());
  task_.start(pass, 4);
  EXPECT_FALSE(task_.idle());
  ticks(30);
  EXPECT_TRUE(task_.idle());
  EXPECT_EQ(pass.done(), 20);
  EXPECT_EQ(task_.result().state, PassState::kCompleted);
  EXPECT_EQ(task_.result().fault, Fault::kNone);
  EXPECT_EQ(task_.result().first_sample, 10u);
  EXPECT_EQ(task_.result().last_sample, 29u);
  expect_all_recorded();
  for (const auto& row : samples()) {
    const bool within = row.sequence >= 10 && row.sequence <= 29;
    EXPECT_EQ(row.pass, within ? 4 : -1) << row.sequence;
    EXPECT_EQ(row.stage, within ? record::Stage::kRun : record::Stage::kIdle);
    EXPECT_EQ(row.force, within ? Vector3d(0, 5, 0) : Vector3d(0, 0, 0));
    EXPECT_EQ(row.target_force, within ? 1.5 : 0.0);
    EXPECT_EQ(row.applied_force, within ? 5.0 : 0.0) << "no pass says it";
    EXPECT_EQ(witness_.blocks[row.sequence], within ? 9 : 0);
  }
  EXPECT_NEAR(witness_.time, 40 * kDt, 1e-12);
}

/// Ten ticks of ramp either way.
class RampedTaskTest : public SessionTaskTest {
 protected:
  RampedTaskTest() : SessionTaskTest(Leave::kNever, ramped()) {}
  static device::EnvelopeLimits ramped() {
    device::EnvelopeLimits l = limits();
    l.ramp_in = l.ramp_out = 10 * kDt;
    return l;
  }
};

TEST_F(RampedTaskTest, AfterAPassTheForceIsLetGoAndTheNextOneWaitsUntilItHasGone) {
  ConstantPass pass({0, 5, 0}, 20);
  ConstantPass next({0, 3, 0}, 20);
  task_.start(pass, 0);
  ticks(20);
  ASSERT_TRUE(task_.idle());
  task_.start(next, 1);
  ticks(40);
  ASSERT_TRUE(task_.idle());
  const auto& rows = samples();
  for (int i = 0; i < 10; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_NEAR(rows[at].force.y(), 0.5 * (i + 1), 1e-12) << "the first one ramps in";
    EXPECT_NEAR(rows[20 + at].force.y(), 5.0 - 0.5 * (i + 1), 1e-12) << "and out";
    EXPECT_EQ(rows[20 + at].pass, -1);
    EXPECT_NEAR(rows[30 + at].force.y(), 0.3 * (i + 1), 1e-12) << "the next one ramps in again";
  }
  EXPECT_EQ(task_.result().first_sample, 30u);
  expect_all_recorded();
}

TEST_F(SessionTaskTest, APassWaitsUntilTheDeviceIsReady) {
  int asked = 0;
  device_.on_ready = [&asked] { return ++asked > 7; };
  ConstantPass pass({0, 5, 0}, 5);
  ticks(3);
  EXPECT_EQ(asked, 0) << "no pass wants to begin";
  task_.start(pass, 0);
  ticks(12);
  EXPECT_TRUE(task_.idle());
  EXPECT_EQ(asked, 8);
  EXPECT_EQ(task_.result().first_sample, 10u);
}

TEST_F(SessionTaskTest, APassThatWaitsCanBeBrokenOffOrStopped) {
  device_.on_ready = [] { return false; };
  ConstantPass pass({0, 5, 0}, 5);
  for (const bool stop : {false, true}) {
    task_.start(pass, 0);
    ticks(3);
    ASSERT_FALSE(task_.idle());
    stop ? task_.emergency_stop() : task_.break_off();
    ticks(1);
    ASSERT_TRUE(task_.idle());
    EXPECT_EQ(task_.result().state, PassState::kAborted);
    EXPECT_EQ(task_.result().fault, stop ? Fault::kEmergencyStop : Fault::kNone);
    EXPECT_EQ(pass.done(), 0);
  }
}

TEST_F(SessionTaskTest, APassIsBrokenOffAlsoBetweenTwoTicks) {
  ConstantPass pass({0, 5, 0}, 5);
  task_.start(pass, 0);
  task_.break_off();
  ticks(1);
  ASSERT_TRUE(task_.idle()) << "both came before the loop looked";
  EXPECT_EQ(task_.result().state, PassState::kAborted);
}

TEST_F(SessionTaskTest, WhoBreaksOffAPassThatHasEndedDoesNotMeanTheNext) {
  ConstantPass first({0, 5, 0}, 5);
  task_.start(first, 0);
  ticks(6);
  ASSERT_TRUE(task_.idle());
  task_.break_off();
  ConstantPass second({0, 5, 0}, 5);
  task_.start(second, 1);
  while (!task_.idle()) {
    ticks(1);
  }
  EXPECT_EQ(task_.result().state, PassState::kCompleted);
  EXPECT_EQ(second.done(), 5);
}

TEST_F(SessionTaskTest, TheStopButtonTakesTheForceAwayAtOnceAndForGood) {
  device_.on_read = [](std::size_t tick, DeviceReading& r) {
    r.stop_pressed = tick == 5;
    return true;
  };
  ConstantPass pass({0, 5, 0}, 20);
  task_.start(pass, 0);
  ticks(20);
  EXPECT_EQ(task_.result().fault, Fault::kStopButton);
  for (const auto& row : samples()) {
    EXPECT_EQ(row.force.y(), row.sequence < 5 ? 5.0 : 0.0) << row.sequence;
  }
}

TEST_F(SessionTaskTest, APassThatGivesUpIsAbortedWithoutAFault) {
  ConstantPass pass({0, 1, 0}, 5, PassState::kAborted);
  task_.start(pass, 0);
  ticks(6);
  EXPECT_EQ(task_.result().state, PassState::kAborted);
  EXPECT_EQ(task_.result().fault, Fault::kNone);
  pass.restart();
  task_.start(pass, 1);
  ticks(6);
  EXPECT_EQ(task_.result().last_sample, 10u) << "the next one needs no clearing";
}

/// A fault of a device at one tick, and its expected consequence.
struct Lie {
  const char* name;
  Fault fault;
  std::function<bool(DeviceReading&)> tell;
};

std::vector<Lie> lies() {
  return {
      {"silence", Fault::kReadFailed, [](DeviceReading&) { return false; }},
      {"nan", Fault::kPositionNotFinite,
       [](DeviceReading& r) { return r.tool.position.y() = kNan, true; }},
      {"infinite speed", Fault::kPositionNotFinite,
       [](DeviceReading& r) { return r.tool.velocity.x() = -1.0 / 0.0, true; }},
      {"jump", Fault::kJump, [](DeviceReading& r) { return r.tool.position.z() += 0.006, true; }},
      {"speed", Fault::kSpeed, [](DeviceReading& r) { return r.tool.velocity.x() = 1.1, true; }},
      {"far away", Fault::kJump, [](DeviceReading& r) { return r.tool.position.x() = 0.2, true; }}};
}

TEST_F(SessionTaskTest, ALyingDeviceIsStoppedInTheSameTick) {
  for (const Lie& lie : lies()) {
    ConstantPass pass({0, 5, 0}, 100);
    const std::uint64_t start = index_;
    const std::uint64_t bad = start + 50;
    device_.on_read = [&](std::size_t tick, DeviceReading& r) {
      return tick != bad || lie.tell(r);
    };
    task_.clear_fault();
    task_.start(pass, 1);
    ticks(80);
    EXPECT_TRUE(task_.idle()) << lie.name;
    EXPECT_EQ(task_.result().state, PassState::kAborted) << lie.name;
    EXPECT_EQ(task_.result().fault, lie.fault) << lie.name;
    EXPECT_EQ(task_.result().first_sample, start);
    EXPECT_EQ(task_.result().last_sample, bad) << lie.name;
    EXPECT_EQ(device_.written[bad - 1], Vector3d(0, 5, 0)) << lie.name;
    for (std::uint64_t tick = bad; tick < index_; ++tick) {
      EXPECT_TRUE(device_.written[tick].isZero(0.0)) << lie.name << " at " << tick;
    }
    EXPECT_EQ(pass.done(), 50) << "the pass never sees the lie: " << lie.name;
  }
  expect_all_recorded();
}

TEST_F(SessionTaskTest, ARefusedForceIsFollowedByNone) {
  ConstantPass pass({0, 5, 0}, 100);
  device_.on_write = [](std::size_t tick) { return tick != 50; };
  task_.start(pass, 1);
  ticks(80);
  EXPECT_EQ(task_.result().fault, Fault::kWriteFailed);
  EXPECT_EQ(task_.result().last_sample, 50u) << "it is known in the tick in which it happens";
  for (std::size_t tick = 51; tick < 80; ++tick) {
    EXPECT_TRUE(device_.written[tick].isZero(0.0)) << tick;
  }
  expect_all_recorded();
}

TEST_F(SessionTaskTest, APassThatAsksForTooMuchIsStopped) {
  for (const auto& [force, fault] : {std::pair{Vector3d(0, 12.1, 0), Fault::kForceTooLarge},
                                     std::pair{Vector3d(0, kNan, 0), Fault::kForceNotFinite}}) {
    ConstantPass pass(force, 10);
    task_.clear_fault();
    task_.start(pass, 1);
    ticks(5);
    EXPECT_EQ(task_.result().fault, fault);
    EXPECT_EQ(task_.result().state, PassState::kAborted);
    EXPECT_EQ(pass.done(), 1);
    EXPECT_TRUE(device_.written.back().isZero(0.0));
  }
  expect_all_recorded();
}

TEST_F(SessionTaskTest, AFaultHoldsUntilItIsCleared) {
  device_.on_read = [](std::size_t tick, DeviceReading&) { return tick != 3; };
  ticks(10);  // between passes
  ConstantPass pass({0, 5, 0}, 10);
  task_.start(pass, 1);
  ticks(1);
  EXPECT_TRUE(task_.idle());
  EXPECT_EQ(task_.result().fault, Fault::kReadFailed);
  EXPECT_EQ(pass.done(), 0);
  EXPECT_EQ(task_.result().first_sample, task_.result().last_sample);
  task_.clear_fault();
  task_.start(pass, 2);
  ticks(15);
  EXPECT_EQ(task_.result().state, PassState::kCompleted);
  EXPECT_EQ(task_.result().fault, Fault::kNone);
  EXPECT_EQ(pass.done(), 10);
  expect_all_recorded();
}

TEST_F(SessionTaskTest, ALostChannelEndsThePassThatNeedsItAndNoOther) {
  const auto instrument = std::make_shared<test::ScriptedInstrument>();
  Table table = Table::parse("quantities = { force = \"N\" }", "lab.toml");
  channel::ChannelOptions options;
  options.name = "grip";
  options.required = true;
  options.plan = test::scripted_kind(instrument).read(table);
  channel::ChannelSet channels({options}, {}, true);
  channels.start([] { return std::int64_t{0}; }, {});
  channels.begin();
  SessionTask task({.devices = {{&device_, limits()}}, .log = log_, .channels = &channels},
                   Leave::kNever);
  std::int64_t index = 0;
  const auto tick = [&] {
    task.tick({static_cast<std::uint64_t>(index), 1'000'000 * index, kDt});
    ++index;
  };
  const auto lose = [&] {
    instrument->give({.failure = "the plug was pulled"});
    test::wait_until([&] {
      tick();
      return channels.alarm() == channel::Alarm::kLost;
    });
  };
  const auto come_back = [&] {
    instrument->give({{1.0}});
    test::wait_until([&] {
      tick();
      return channels.values()[0] == 1.0;
    });
  };
  ConstantPass pass({0, 5, 0}, 10);
  const auto result_of_pass = [&] {
    pass.restart();
    task.start(pass, 1);
    for (int i = 0; i < 20; ++i) {
      tick();
    }
    EXPECT_TRUE(task.idle());
    return task.result();
  };
  come_back();
  lose();
  come_back();
  EXPECT_EQ(result_of_pass().state, PassState::kCompleted) << "it was lost between passes alone";
  lose();
  const PassResult lost = result_of_pass();
  EXPECT_EQ(lost.fault, Fault::kChannelLost);
  EXPECT_STREQ(lost.trouble, "channel grip is lost");
  EXPECT_EQ(pass.done(), 0);
}

TEST_F(SessionTaskTest, AnEmergencyStopTakesTheForceAwayAtOnce) {
  ConstantPass pass({0, 5, 0}, 100);
  task_.start(pass, 1);
  ticks(20);
  task_.emergency_stop();
  ticks(20);
  EXPECT_EQ(task_.result().state, PassState::kAborted);
  EXPECT_EQ(task_.result().fault, Fault::kEmergencyStop);
  EXPECT_EQ(task_.result().last_sample, 20u);
  EXPECT_EQ(device_.written[19], Vector3d(0, 5, 0));
  EXPECT_TRUE(device_.written[20].isZero(0.0));
  expect_all_recorded();
}

TEST_F(SessionTaskTest, AnEmergencyStopBetweenPassesStopsTheNextOne) {
  task_.emergency_stop();
  ticks(3);
  ConstantPass pass({0, 5, 0}, 100);
  task_.start(pass, 1);
  ticks(3);
  EXPECT_EQ(task_.result().fault, Fault::kEmergencyStop);
  EXPECT_EQ(pass.done(), 0);
}

TEST_F(SessionTaskTest, AStopThatComesWhileTheDeviceIsReadTakesTheForceOfThatTick) {
  ConstantPass pass({0, 5, 0}, 100);
  device_.on_read = [this](std::size_t tick, DeviceReading&) {
    if (tick == 20) {
      task_.emergency_stop();
    }
    return true;
  };
  task_.start(pass, 1);
  ticks(30);
  EXPECT_EQ(device_.written[19], Vector3d(0, 5, 0));
  EXPECT_TRUE(device_.written[20].isZero(0.0));
  EXPECT_EQ(task_.result().fault, Fault::kEmergencyStop);
  EXPECT_EQ(task_.result().last_sample, 20u);
  expect_all_recorded();
}

TEST_F(SessionTaskTest, SaysWhenAStopHasReachedTheDevice) {
  ConstantPass pass({0, 5, 0}, 100);
  task_.start(pass, 1);
  ticks(20);
  EXPECT_FALSE(task_.stopped());
  EXPECT_FALSE(task_.at_rest());
  task_.emergency_stop();
  EXPECT_FALSE(task_.stopped()) << "asked for, not done";
  ticks(1);
  EXPECT_TRUE(task_.stopped());
  EXPECT_TRUE(task_.at_rest());
}

TEST_F(SessionTaskTest, IsAtRestWhenTheForceThatWasLetGoHasGone) {
  device::EnvelopeLimits gentle = limits();
  gentle.ramp_out = 0.05;
  SessionTask task(device_, gentle, log_, {}, Leave::kNever);
  ConstantPass pass({0, 5, 0}, 20);
  EXPECT_TRUE(task.at_rest()) << "nothing was commanded yet";
  task.start(pass, 1);
  for (std::uint64_t i = 0; i < 120; ++i) {
    task.tick({i, 0, kDt});
    EXPECT_EQ(task.at_rest(), task.idle() && device_.written.back().isZero(0.0)) << i;
    if (i == 30) {
      EXPECT_TRUE(task.idle());
      EXPECT_FALSE(task.at_rest()) << "the pass is over, its force is not";
    }
  }
  EXPECT_TRUE(task.at_rest());
}

TEST_F(SessionTaskTest, AForceThatTheDeviceDidNotTakeIsNotAtRest) {
  device_.on_write = [](std::size_t tick) { return tick < 20; };
  ConstantPass pass({0, 5, 0}, 100);
  task_.start(pass, 1);
  ticks(30);
  EXPECT_TRUE(task_.idle());
  EXPECT_FALSE(task_.at_rest()) << "nobody knows what its motors do";
}

TEST_F(SessionTaskTest, ClearingAnOldFaultDoesNotWipeOutAnEmergencyStop) {
  ConstantPass pass({0, 5, 0}, 100);
  task_.clear_fault();
  task_.start(pass, 1);
  task_.emergency_stop();  // all three before the servo thread looks
  ticks(3);
  EXPECT_EQ(task_.result().fault, Fault::kEmergencyStop);
  EXPECT_EQ(pass.done(), 0);
}

TEST_F(SessionTaskTest, ObserversSeeWhatTheEnvelopeLeavesOfTheForce) {
  device::EnvelopeLimits gentle;
  gentle.ramp_in = 0.1;
  Witness witness;
  SessionTask task(device_, gentle, log_, {&witness, &witness_}, Leave::kNever);
  ConstantPass pass({0, 10, 0}, 50);
  task.start(pass, 1);
  for (std::uint64_t i = 0; i < 50; ++i) {
    task.tick({i, 0, kDt});
    EXPECT_NEAR(witness.forces.back().y(), 10.0 * static_cast<double>(i + 1) * kDt / 0.1, 1e-9);
    EXPECT_EQ(witness.forces.back(), device_.written.back());
  }
  EXPECT_EQ(witness.forces, witness_.forces) << "all observers see the same";
}

/// A process that was stopped for a second.
TEST_F(RampedTaskTest, AfterAGapTheForceRampsInAgain) {
  ConstantPass pass({0, 5, 0}, 200);
  task_.start(pass, 1);
  for (std::uint64_t i = 0; i < 60; ++i) {
    const std::int64_t suspended = i < 30 ? 0 : 1'000'000'000;
    task_.tick({i, static_cast<std::int64_t>(i) * 1'000'000 + suspended, kDt});
    const double share = std::min(1.0, 0.1 * static_cast<double>(i < 30 ? i + 1 : i - 29));
    EXPECT_NEAR(device_.written.back().y(), 5.0 * share, 1e-9) << i;
  }
}

TEST_F(SessionTaskTest, ASuspensionIsThatOfThePassInWhichItHappens) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  ConstantPass pass({0, 5, 0}, 20);
  std::int64_t time = 0;
  for (std::uint64_t i = 0; i < 40; ++i) {
    if (i == 5) {
      task_.start(pass, 1);
    }
    const std::int64_t suspended = i == 5 || i == 12 || i == 14 || i == 30 ? kSecond : 0;
    time += 1'000'000 + suspended;
    task_.tick({i, time, kDt, suspended});
  }
  EXPECT_EQ(task_.result().state, PassState::kCompleted);
  EXPECT_EQ(task_.result().suspended_ns, 2 * kSecond);
  EXPECT_EQ(pass.suspensions(), 2);
}

/// A pass that turns its force about with its stage.
class TwoStagePass final : public Pass {
 public:
  PassOutput tick(const Readings&, double) noexcept override {
    PassOutput out;
    const bool first = ++done_ <= 300;
    out.stage = first ? record::Stage::kRun : record::Stage::kReturn;
    out.force.y() = first ? 5.0 : -3.0;
    return out;
  }
  PassState state() const noexcept override {
    return done_ < 600 ? PassState::kRunning : PassState::kCompleted;
  }

 private:
  int done_{0};
};

TEST_F(SessionTaskTest, WhatChangesWithAStageFades) {
  TwoStagePass pass;
  device_.on_read = [](std::size_t tick, DeviceReading& reading) {
    reading.tool.position.x() = 1e-6 * static_cast<double>(tick);
    return true;
  };
  task_.start(pass, 1);
  ticks(300);
  EXPECT_EQ(device_.written.back(), Vector3d(0, 5, 0));
  for (int i = 0; i < 60; ++i) {
    const Vector3d before = device_.written.back();
    tick();
    ASSERT_LE((device_.written.back() - before).norm(), 0.25) << i;
  }
  EXPECT_EQ(device_.written.back(), Vector3d(0, -3, 0));
}

/// Swings the force of the second device by 4 N at 25 Hz, as that of a handle that oscillates.
class SecondSwingsPass final : public Pass {
 public:
  static constexpr int kTicks = 200;

  PassOutput tick(const Readings&, double) noexcept override {
    second_.force.y() = done_++ / 20 % 2 == 0 ? 2.0 : -2.0;
    PassOutput out;
    out.stage = record::Stage::kRun;
    return out;
  }
  std::span<const Drive> others() const noexcept override { return {&second_, 1}; }
  PassState state() const noexcept override {
    return done_ < kTicks ? PassState::kRunning : PassState::kCompleted;
  }

 private:
  Drive second_;
  int done_{0};
};

TEST_F(SessionTaskTest, GainsThatASecondDeviceLosesAreKnown) {
  test::ScriptedDevice first;
  test::ScriptedDevice second;
  SessionTask::Log log;
  SessionTask task(
      SessionTask::Parts{.devices = {{&first, limits()}, {&second, limits()}}, .log = log},
      Leave::kNever);
  SecondSwingsPass pass;
  task.start(pass, 0);
  for (std::uint64_t i = 0; i < 2 * SecondSwingsPass::kTicks && !task.idle(); ++i) {
    task.tick({i, static_cast<std::int64_t>(i) * 1'000'000, kDt});
  }
  ASSERT_TRUE(task.idle());
  EXPECT_EQ(task.result().state, PassState::kCompleted);
  EXPECT_GT(task.result().reduced_ticks, 50u);
  EXPECT_LT(task.result().least_gains.damping, 0.5);
}

TEST_F(SessionTaskTest, ATickDoesNotAllocate) {
  const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 1);
  TrajectoryPass pass(kRecallTest, stimulus, {}, 1);
  device_.position = stimulus.path.points().front();
  device_.on_read = [](std::size_t tick, DeviceReading&) { return tick != 3000; };
  const test::AllocationGuard guard;
  task_.start(pass, 1);
  ticks(4000);
  task_.clear_fault();
  ticks(1000);
  task_.emergency_stop();
  ticks(1000);
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_EQ(task_.result().last_sample, 3000u);
}

TEST_F(SessionTaskTest, NeverAsksToLeaveUnlessToldTo) {
  ConstantPass pass({0, 5, 0}, 5);
  task_.start(pass, 1);
  task_.leave_before(7);
  for (std::uint64_t i = 0; i < SessionTask::kSlice + 10; ++i) {
    ASSERT_TRUE(tick()) << i;
  }
}

TEST_F(LeavingTaskTest, LeavesAfterAPassASliceAndWhereAsked) {
  ConstantPass pass({0, 5, 0}, 5);
  task_.start(pass, 1);
  task_.leave_before(100);
  std::set<std::uint64_t> left_after;
  for (std::uint64_t i = 0; i < 2 * SessionTask::kSlice + 10; ++i) {
    if (!tick()) {
      left_after.insert(i);
    }
  }
  EXPECT_EQ(left_after,
            (std::set<std::uint64_t>{4, 99, SessionTask::kSlice - 1, 2 * SessionTask::kSlice - 1}));
}

TEST_F(LeavingTaskTest, DrivenByTheSimulatedLoopEveryTickIsARecord) {
  realtime::ServoLoop loop(realtime::ClockKind::kSimulated, 1000.0);
  for (int row = 0; row < 5; ++row) {
    ConstantPass pass({0, 1.0 * row, 0}, 700 + row);
    task_.start(pass, row);
    while (!task_.idle()) {
      loop.run(task_);
    }
    EXPECT_EQ(task_.result().last_sample - task_.result().first_sample + 1, 700u + row);
    EXPECT_EQ(task_.result().last_sample + 1, loop.ticks());
  }
  index_ = loop.ticks();
  expect_all_recorded();
  const auto& rows = samples();
  EXPECT_EQ(std::count_if(rows.begin(), rows.end(), [](const auto& r) { return r.pass >= 0; }),
            3510);
}

/// A servo thread on the real clock, as in a session; the test is the session's thread.
class RealThreadTest : public SessionTaskTest {
 protected:
  ~RealThreadTest() override { join(); }
  void launch(double rate) {
    loop_ = std::make_unique<realtime::ServoLoop>(realtime::ClockKind::kReal, rate);
    servo_ = std::thread([this] { loop_->run(task_); });
  }
  void join() {
    if (servo_.joinable()) {
      loop_->request_stop();
      servo_.join();
    }
  }
  void wait_idle() {
    while (!task_.idle()) {
      std::this_thread::sleep_for(std::chrono::microseconds(50));
      samples();  // the consumer's side of the log, at the same time
    }
  }
  std::unique_ptr<realtime::ServoLoop> loop_;
  std::thread servo_;
};

TEST_F(RealThreadTest, PassesAreHandedOverWhileTheLoopRuns) {
  launch(1000.0);
  std::vector<PassResult> results;
  for (int row = 0; row < 6; ++row) {
    ConstantPass pass({0, 1, 0}, 50);  // without ramps 2 N would be a swing
    task_.start(pass, row);
    wait_idle();
    results.push_back(task_.result());
    EXPECT_EQ(pass.done(), 50);
  }
  join();
  const auto rows = samples();
  ASSERT_EQ(rows.size(), loop_->ticks());
  EXPECT_GE(rows.back().time_ns, 290000000) << "300 ticks take 0.3 s";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].sequence, i);
  }
  for (int row = 0; row < 6; ++row) {
    EXPECT_EQ(results[row].state, PassState::kCompleted) << device::describe(results[row].fault);
    EXPECT_EQ(results[row].last_sample - results[row].first_sample, 49u);
    EXPECT_EQ(rows[results[row].first_sample].pass, row);
    EXPECT_EQ(rows[results[row].last_sample].pass, row);
  }
}

TEST_F(RealThreadTest, AnEmergencyStopFromAnotherThreadEndsThePass) {
  launch(1000.0);
  ConstantPass pass({0, 2, 0}, 1000000);
  task_.start(pass, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  std::thread([this] { task_.emergency_stop(); }).join();
  wait_idle();
  join();
  EXPECT_EQ(task_.result().fault, Fault::kEmergencyStop);
  EXPECT_TRUE(device_.written[task_.result().last_sample].isZero(0.0));
}

/// Lies still and takes every force.
struct QuietDevice final : device::Device {
  const device::DeviceInfo& info() const noexcept override { return info_; }
  bool read(DeviceReading&) noexcept override { return true; }
  bool write(const device::Wrench&) noexcept override { return true; }
  device::DeviceInfo info_;
};

TEST(SessionTaskRaceTest, ClearAndStartArriveTogetherWheneverTheLoopLooks) {
  QuietDevice device;
  SessionTask::Log log(16, 2);  // full at once: nobody reads it
  SessionTask task(device, {}, log, {}, Leave::kNever);
  ConstantPass greedy({0, 50, 0}, 10);
  ConstantPass modest({0, 1, 0}, 1);
  std::atomic<bool> stop{false};
  std::thread servo([&] {  // without a pause, so that it looks at every instant
    for (std::uint64_t i = 0; !stop.load(std::memory_order_relaxed); ++i) {
      task.tick({i, 0, kDt});
    }
  });
  const auto result = [&](Pass& pass) {
    task.clear_fault();
    task.start(pass, 0);
    while (!task.idle()) {
      std::this_thread::yield();
    }
    return task.result().fault;
  };
  int wrong = 0;
  for (int round = 0; round < 4000; ++round) {
    greedy.restart();
    modest.restart();
    wrong += result(greedy) != Fault::kForceTooLarge;
    wrong += result(modest) != Fault::kNone;
  }
  stop = true;
  servo.join();
  EXPECT_EQ(wrong, 0) << "a pass met the fault whose clearing had come before it";
}

}  // namespace
}  // namespace haptrial::protocols
