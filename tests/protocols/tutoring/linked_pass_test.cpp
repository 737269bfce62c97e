// Two passes coupled by a wire in one thread: when they begin and end, and what each hand feels.

#include "protocols/tutoring/linked_trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/allocation_guard.h"

namespace haptrial::protocols {
namespace {

using Eigen::Vector3d;

/// A message of one side is there for the other at its next tick.
class DirectWire final : public tutoring::Wire {
 public:
  DirectWire() { inbox_.reserve(16); }
  std::int64_t tick() noexcept override { return now_ += 1'000'000; }
  void receive(tutoring::Listener& listener) noexcept override {
    for (const tutoring::TickMessage& m : inbox_) {
      listener.hear({m, now_});
    }
    inbox_.clear();
  }
  void send(const tutoring::TickMessage& m) noexcept override {
    if (open) {
      other->inbox_.push_back(m);
    }
  }
  bool closed() const noexcept override { return false; }
  void close(const tutoring::TickMessage& m) noexcept override { send(m); }
  tutoring::WireCounts counts() const noexcept override { return {}; }

  DirectWire* other{nullptr};
  bool open{true};

 private:
  std::int64_t now_{0};
  std::vector<tutoring::TickMessage> inbox_;
};

/// Pushes with a constant force, for a number of ticks; `stored` is what its springs would hold.
class Push final : public Pass {
 public:
  Push(int ticks, const Vector3d& force) : left_(ticks), force_(force) {}
  PassOutput tick(const Readings& readings, double) noexcept override {
    --left_;
    PassOutput out;
    out.force = force_;
    out.intent.stored = stored;
    out.stage = record::Stage::kRun;
    out.shown.tool = readings[0].tool.position;
    return out;
  }
  PassState state() const noexcept override {
    return broken ? PassState::kAborted : left_ > 0 ? PassState::kRunning : PassState::kCompleted;
  }
  bool broken{false};
  double stored{0.0};  // [J]

 private:
  int left_;
  Vector3d force_;
};

TutoringOptions options() {
  TutoringOptions o;
  o.ramp = 0.05;
  o.felt_back = 0.0;
  o.passivity = tutoring::Passivity::kNone;
  return o;
}

/// One side: a hand that is held at a place.
struct Side {
  Side(LinkRole role, int length, const Vector3d& own_force)
      : hand({kOptions, role, wire, nullptr, [this] { ++stops; }}),
        inner(length, own_force),
        pass(inner, hand, 16, true) {}

  void tick(device::Fault fault = device::Fault::kNone) {
    const Readings readings(reading);
    force.setZero();
    if (!running && !over && pass.may_begin()) {
      running = true;
      pass.begin(sequence);
    }
    if (running && fault == device::Fault::kNone) {
      const PassOutput out = pass.tick(readings, 1e-3);
      force = out.force;
      intent = out.intent;
      ++ticks;
    }
    hand.observe({}, stimulus::Forces(force), 1e-3);
    hand.record(sequence++, readings, fault);
    if (running && (pass.state() != PassState::kRunning || fault != device::Fault::kNone)) {
      running = false;
      over = true;
    }
  }

  static const TutoringOptions kOptions;
  DirectWire wire;
  LinkedHand hand;
  Push inner;
  LinkedPass pass;
  device::DeviceReading reading;
  Vector3d force{Vector3d::Zero()};
  device::ForceIntent intent;  // of it
  std::uint64_t sequence{0};
  int ticks{0};
  int stops{0};
  bool running{false};
  bool over{false};
};
const TutoringOptions Side::kOptions = options();

struct Pair {
  Pair(int first, int second)
      : teaches(LinkRole::kTeaches, first, {0.0, 2.0, 0.0}),
        learns(LinkRole::kLearns, second, {1.0, 0.0, 0.0}) {
    teaches.wire.other = &learns.wire;
    learns.wire.other = &teaches.wire;
  }
  void tick() {
    teaches.tick();
    learns.tick();
  }
  Side teaches;
  Side learns;
};

TEST(LinkedPassTest, BothBeginAndEndTogetherWithinAMessage) {
  Pair pair(100, 300);
  for (int i = 0; i < 50; ++i) {  // the other side is not there yet
    pair.teaches.tick();
  }
  EXPECT_FALSE(pair.teaches.running);
  for (int i = 0; i < 1000; ++i) {
    pair.tick();
  }
  EXPECT_EQ(pair.teaches.pass.state(), PassState::kCompleted);
  EXPECT_EQ(pair.learns.pass.state(), PassState::kCompleted);
  EXPECT_NEAR(pair.teaches.ticks, pair.learns.ticks, 3) << "the shorter one waits for the other";
}

TEST(LinkedPassTest, WhoLearnsFeelsTheLawAndWhoTeachesTheOwnWorld) {
  Pair pair(1000, 1000);
  pair.teaches.reading.tool.position = {0.01, 0.0, 0.0};
  for (int i = 0; i < 900; ++i) {
    pair.tick();
  }
  // Spring over 1 cm at 80 N/m, and the 2 N of the other world; of the own one nothing.
  EXPECT_LT((pair.learns.force - Vector3d(0.8, 2.0, 0.0)).norm(), 1e-9);
  EXPECT_LT((pair.teaches.force - Vector3d(0.0, 2.0, 0.0)).norm(), 1e-9);
}

/// More would be a fault of the protocol, and a hand far away is none.
TEST(LinkedPassTest, WhatIsFeltStaysWithinTheEnvelope) {
  Pair pair(1000, 1000);
  pair.teaches.reading.tool.position = {0.0, 0.5, 0.0};  // 40 N of the spring, 2 N played
  for (int i = 0; i < 900; ++i) {
    pair.tick();
    ASSERT_LE(pair.learns.force.norm(), 12.0 * (1.0 + 1e-12));
  }
  EXPECT_LT((pair.learns.force - Vector3d(0.0, 12.0, 0.0)).norm(), 1e-9);
}

TEST(LinkedPassTest, WhoLearnsCanAlwaysTakeTheLead) {
  Pair pair(2000, 2000);
  pair.teaches.reading.tool.position = {0.01, 0.0, 0.0};
  for (int i = 0; i < 500; ++i) {
    pair.tick();
  }
  pair.learns.hand.take_lead(true);
  double most_step = 0.0;
  Vector3d last = pair.learns.force;
  for (int i = 0; i < 500; ++i) {
    pair.tick();
    most_step = std::max(most_step, (pair.learns.force - last).norm());
    last = pair.learns.force;
  }
  EXPECT_LT((pair.learns.force - Vector3d(1.0, 0.0, 0.0)).norm(), 1e-9) << "the own world alone";
  EXPECT_LT((pair.teaches.force - Vector3d(1.0 - 0.8, 0.0, 0.0)).norm(), 1e-9) << "and is led";
  EXPECT_LT(most_step, 0.2) << "by a ramp";
  pair.learns.hand.take_lead(false);
  for (int i = 0; i < 500; ++i) {
    pair.tick();
  }
  EXPECT_LT((pair.learns.force - Vector3d(0.8, 2.0, 0.0)).norm(), 1e-9);
}

/// A hand that does not move gets no energy, however far the own world's springs are stretched and
/// whoever leads.
TEST(LinkedPassTest, AChangeOfTheLeadIsNoEnergyForTheHand) {
  Pair pair(4000, 4000);
  pair.learns.inner.stored = 0.5;
  device::EnergyWatch watch;
  double least_lead = 1.0;
  for (int i = 0; i < 2000; ++i) {
    pair.learns.hand.take_lead(i % 400 > 200);
    pair.teaches.wire.open = i % 700 < 500;
    pair.tick();
    if (pair.learns.ticks > 0) {
      EXPECT_FALSE(watch.look(pair.learns.force, Vector3d::Zero(), pair.learns.intent, 1e-3)) << i;
      least_lead = std::min(least_lead, pair.learns.intent.stored / 0.5);
    }
  }
  EXPECT_LT(watch.generated(), 1e-9);
  EXPECT_LT(least_lead, 0.01) << "the partner led";
}

TEST(LinkedPassTest, AnAbortOnOneSideIsOneOnBoth) {
  Pair pair(1000, 1000);
  for (int i = 0; i < 100; ++i) {
    pair.tick();
  }
  pair.teaches.inner.broken = true;
  pair.tick();
  EXPECT_EQ(pair.teaches.pass.state(), PassState::kAborted);
  pair.tick();
  EXPECT_EQ(pair.learns.pass.state(), PassState::kAborted);
  EXPECT_EQ(pair.learns.pass.why(), tutoring::PassBarrier::Step::kBreak);
  EXPECT_EQ(pair.learns.stops, 0);
}

TEST(LinkedPassTest, AnEmergencyStopReachesTheOtherSideWithTheNextMessage) {
  Pair pair(1000, 1000);
  for (int i = 0; i < 100; ++i) {
    pair.tick();
  }
  pair.teaches.tick(device::Fault::kEmergencyStop);
  pair.learns.tick();
  pair.teaches.tick(device::Fault::kEmergencyStop);
  pair.learns.tick();
  EXPECT_EQ(pair.learns.stops, 1);
  pair.tick();
  EXPECT_EQ(pair.learns.stops, 1) << "one stop is asked for once";
}

TEST(LinkedPassTest, SilenceFadesTheForceAfterTheDeadline) {
  Pair pair(3000, 3000);
  pair.teaches.reading.tool.position = {0.01, 0.0, 0.0};
  for (int i = 0; i < 500; ++i) {
    pair.tick();
  }
  pair.teaches.wire.open = false;
  for (int i = 0; i < 99; ++i) {
    pair.tick();
    ASSERT_GT(pair.learns.force.norm(), 1.0) << i;
  }
  for (int i = 0; i < 53; ++i) {
    const Vector3d was = pair.learns.force;
    pair.tick();
    EXPECT_LT((pair.learns.force - was).norm(), 0.15) << "a step of the force, tick " << i;
  }
  EXPECT_LT((pair.learns.force - Vector3d(1.0, 0.0, 0.0)).norm(), 1e-9)
      << "the hand has its own world to rest on again";
  pair.teaches.wire.open = true;
  double last = 0.0;
  for (int i = 0; i < 200; ++i) {
    pair.tick();
    EXPECT_LT(std::abs(pair.learns.force.y() - last), 0.1) << "back by a ramp";
    last = pair.learns.force.y();
  }
  EXPECT_NEAR(last, 2.0, 1e-9);
}

TEST(LinkedPassTest, TicksDoNotAllocate) {
  Pair pair(1000, 1000);
  for (int i = 0; i < 10; ++i) {
    pair.tick();
  }
  const test::AllocationGuard guard;
  for (int i = 0; i < 500; ++i) {
    pair.tick();
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::protocols
