#include "core/device/envelope.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/message_of.h"

namespace haptrial::device::envelope_test {
namespace {

using Eigen::Vector3d;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kDt = 1e-3;

DeviceReading at(const Vector3d& position, const Vector3d& velocity = Vector3d::Zero()) {
  return {{position, velocity}, 0};
}

/// Passes on every force at once: no ramp, no limit of its rate.
EnvelopeLimits open_limits() {
  EnvelopeLimits limits;
  limits.ramp_in = 0.0;
  limits.max_force_rate = 1e6;
  return limits;
}

TEST(EnvelopeTest, LetsAGoodForcePassUnchanged) {
  Envelope envelope(open_limits());
  EXPECT_EQ(envelope.check(true, at({0.01, 0.0, 0.0})), Fault::kNone);
  EXPECT_EQ(envelope.limit({1.0, -2.0, 3.0}, kDt), Vector3d(1.0, -2.0, 3.0));
  EXPECT_EQ(envelope.limit({0.0, 12.0, 0.0}, kDt), Vector3d(0.0, 12.0, 0.0)) << "the limit itself";
}

/// One way to break the envelope, in an otherwise good tick.
struct Breach {
  Fault fault;
  std::function<void(Envelope&)> commit;
};

std::vector<Breach> breaches() {
  const auto reading = [](const DeviceReading& r) {
    return [r](Envelope& e) { e.check(true, r); };
  };
  const auto wanted = [](const Vector3d& f, double dt = kDt) {
    return [f, dt](Envelope& e) { e.limit(f, dt); };
  };
  const auto tripped = [](Fault fault) { return [fault](Envelope& e) { e.trip(fault); }; };
  return {{Fault::kReadFailed,
           [](Envelope& e) {
             e.check(false, at({0, 0, 0}));
           }},
          {Fault::kWriteFailed, tripped(Fault::kWriteFailed)},
          {Fault::kPositionNotFinite, reading(at({kNan, 0, 0}))},
          {Fault::kPositionNotFinite, reading(at({0, 0, -kInf}))},
          {Fault::kPositionNotFinite, reading(at({0, 0, 0}, {0, kNan, 0}))},
          {Fault::kJump, reading(at({0.00501, 0, 0}))},
          {Fault::kSpeed, reading(at({0, 0, 0}, {0, 0.8, 0.8}))},
          {Fault::kForceNotFinite, wanted({0, kNan, 0})},
          {Fault::kForceNotFinite, wanted({kInf, 0, 0})},
          {Fault::kForceNotFinite, wanted({0, 1, 0}, kNan)},
          {Fault::kForceNotFinite, wanted({0, 1, 0}, 0.0)},
          {Fault::kForceTooLarge, wanted({0, 12.001, 0})},
          {Fault::kForceTooLarge, wanted({7.5, 7.5, 7.5})},
          {Fault::kForceTooLarge, wanted({1e300, 1e300, 0})},
          {Fault::kForcesOff, reading({{}, 0, false})},
          {Fault::kStopButton, reading({{}, 1, true, true})},
          {Fault::kEmergencyStop, tripped(Fault::kEmergencyStop)}};
}

TEST(EnvelopeTest, EveryBreachBringsTheForceToZeroInTheSameTickAndLatches) {
  for (const Breach& breach : breaches()) {
    Envelope envelope(open_limits());
    envelope.check(true, at({0, 0, 0}));
    ASSERT_EQ(envelope.limit({0, 5, 0}, kDt), Vector3d(0, 5, 0));
    breach.commit(envelope);
    EXPECT_EQ(envelope.fault(), breach.fault) << describe(breach.fault);
    EXPECT_TRUE(envelope.limit({0, 5, 0}, kDt).isZero(0.0)) << describe(breach.fault);
    for (int i = 0; i < 100; ++i) {  // good ticks do not mend it
      EXPECT_EQ(envelope.check(true, at({0, 0, 0})), breach.fault);
      EXPECT_TRUE(envelope.limit({0, 1, 0}, kDt).isZero(0.0));
    }
    envelope.reset();
    EXPECT_EQ(envelope.check(true, at({0.03, 0, 0})), Fault::kNone) << "no jump after a reset";
    EXPECT_EQ(envelope.limit({0, 5, 0}, kDt), Vector3d(0, 5, 0));
  }
}

TEST(EnvelopeTest, TheWorkspaceIsABall) {
  Envelope inside(open_limits());
  EXPECT_EQ(inside.check(true, at({0.045, 0.06, 0.0})), Fault::kNone)
      << "its surface belongs to it";
  Envelope outside(open_limits());
  EXPECT_EQ(outside.check(true, at({0.046, 0.06, 0.0})), Fault::kWorkspace);
  EXPECT_TRUE(outside.limit({1, 0, 0}, kDt).isZero(0.0));
}

TEST(EnvelopeTest, MotionUpToTheLimitsIsNoFault) {
  EnvelopeLimits limits = open_limits();
  limits.max_jump = 0.0078125;  // exact in binary
  Envelope envelope(limits);
  for (int i = -4; i <= 4; ++i) {
    EXPECT_EQ(envelope.check(true, at({i * 0.0078125, 0, 0}, {0.6, 0.8, 0})), Fault::kNone);
  }
}

TEST(EnvelopeTest, TheFirstFaultIsKept) {
  for (const Breach& first : breaches()) {
    for (const Breach& second : breaches()) {
      Envelope envelope(open_limits());
      envelope.check(true, at({0, 0, 0}));
      envelope.limit({0, 1, 0}, kDt);
      first.commit(envelope);
      second.commit(envelope);
      EXPECT_EQ(envelope.fault(), first.fault) << describe(second.fault);
    }
  }
}

TEST(EnvelopeTest, ForceRampsInAfterAStartAndAfterAReset) {
  EnvelopeLimits limits = open_limits();
  limits.ramp_in = 0.2;
  Envelope envelope(limits);
  for (int round = 0; round < 2; ++round) {
    for (int tick = 1; tick <= 300; ++tick) {
      const Vector3d force = envelope.limit({0, 8, -6}, kDt);
      const double share = std::min(1.0, tick * kDt / 0.2);
      ASSERT_LT((force - share * Vector3d(0, 8, -6)).norm(), 1e-9) << tick;
    }
    envelope.reset();
  }
}

TEST(EnvelopeTest, AStepOfForceIsSpreadAtTheLimitedRate) {
  EnvelopeLimits limits = open_limits();
  limits.max_force_rate = 1000.0;  // 1 N a tick
  Envelope envelope(limits);
  for (int tick = 1; tick <= 15; ++tick) {
    EXPECT_NEAR(envelope.limit({0, 0, 10}, kDt).z(), std::min(10, tick), 1e-12);
  }
  EXPECT_NEAR(envelope.limit({0, 0, -10}, kDt).z(), 9.0, 1e-12) << "down as well";
}

/// Anything that a protocol or a device may come up with, mostly good.
Vector3d any_vector(RandomStream& random, double usual) {
  Vector3d v{random.uniform(-usual, usual), random.uniform(-usual, usual),
             random.uniform(-usual, usual)};
  const double bad[] = {kNan, kInf, -kInf, 1e300, -1e30, 1e-320};
  if (random.below(2000) == 0) {
    v[static_cast<int>(random.below(3))] = bad[random.below(6)];
  }
  return v;
}

TEST(EnvelopeTest, MotorsThatAreOffAreAFaultOnlyUnderForce) {
  Envelope envelope(open_limits());
  const DeviceReading off{{}, 0, false};
  for (int tick = 0; tick < 10; ++tick) {
    ASSERT_EQ(envelope.check(true, off), Fault::kNone) << "at rest they may be off";
    ASSERT_TRUE(envelope.limit(Vector3d::Zero(), kDt).isZero(0.0));
  }
  envelope.limit({0, 0.001, 0}, kDt);
  EXPECT_EQ(envelope.check(true, off), Fault::kForcesOff);
}

TEST(EnvelopeTest, AfterAReleaseTheForceFallsEvenlyWhateverIsWanted) {
  EnvelopeLimits limits = open_limits();
  limits.ramp_out = 0.1;
  for (const Vector3d& wanted : {Vector3d(0, 0, 0), Vector3d(0, 8, -6), Vector3d(12, 0, 0)}) {
    Envelope envelope(limits);
    envelope.limit({0, 8, -6}, kDt);
    envelope.release();
    for (int tick = 1; tick <= 300; ++tick) {
      const double share = std::max(0.0, 1.0 - tick * kDt / 0.1);
      const Vector3d force = envelope.limit(wanted, kDt);
      ASSERT_LT((force - share * Vector3d(0, 8, -6)).norm(), 1e-9) << tick;
      ASSERT_TRUE(tick <= 100 || force.isZero(0.0)) << tick;
      envelope.release();  // again: changes nothing
    }
    EXPECT_TRUE(envelope.released());
  }
}

TEST(EnvelopeTest, AReleaseWithoutARampIsStillBoundInItsRate) {
  EnvelopeLimits limits = open_limits();
  limits.ramp_out = 0.0;
  limits.max_force_rate = 1000.0;
  Envelope envelope(limits);
  for (int tick = 0; tick < 5; ++tick) {
    envelope.limit({0, 5, 0}, kDt);
  }
  envelope.release();
  for (int left = 4; left >= 0; --left) {
    EXPECT_NEAR(envelope.limit({0, 5, 0}, kDt).y(), left, 1e-12);
  }
}

TEST(EnvelopeTest, EngagingRampsInAgainAndMendsNoFault) {
  EnvelopeLimits limits = open_limits();
  limits.ramp_in = limits.ramp_out = 0.1;
  Envelope envelope(limits);
  envelope.release();
  EXPECT_TRUE(envelope.limit({0, 5, 0}, kDt).isZero(0.0));
  envelope.engage();
  for (int tick = 1; tick <= 200; ++tick) {
    EXPECT_NEAR(envelope.limit({0, 5, 0}, kDt).y(), 5.0 * std::min(1.0, tick / 100.0), 1e-9);
  }
  envelope.trip(Fault::kEmergencyStop);
  envelope.release();
  envelope.engage();
  EXPECT_EQ(envelope.fault(), Fault::kEmergencyStop);
  EXPECT_TRUE(envelope.limit({0, 5, 0}, kDt).isZero(0.0));
}

/// A device and a protocol that go wrong at random, and what the envelope made of it.
class RandomRun {
 public:
  void tick() {
    mood_left_ = mood_left_ > 0 ? mood_left_ - 1 : 0;
    if (mood_left_ == 0) {
      mood_ = random_.below(5000) == 0 ? 1 + static_cast<int>(random_.below(3)) : 0;
      mood_left_ = mood_ == 0 ? 0 : 150;
    }
    move();
    DeviceReading reading = at(hand_, any_vector(random_, 0.58));
    reading.forces_on = random_.below(2000) != 0;
    reading.stop_pressed = random_.below(5000) == 0;
    envelope_.check(random_.below(1000) != 0, reading);
    if (random_.below(2000) == 0) {
      constexpr std::array kFromOutside{Fault::kWriteFailed, Fault::kEmergencyStop,
                                        Fault::kOtherDevice};
      envelope_.trip(kFromOutside[random_.below(kFromOutside.size())]);
    }
    if (random_.below(500) == 0) {
      random_.below(2) ? envelope_.release() : envelope_.engage();
    }
    dt = random_.below(2000) == 0 ? any_vector(random_, 1e-3).x() : kDt;
    before = force;
    force = envelope_.limit(any_force(), dt);
    fault_before = fault;
    fault = envelope_.fault();
    released_for = envelope_.released() ? released_for + dt : 0.0;
  }
  void maybe_reset() {
    if (fault != Fault::kNone && random_.below(10) == 0) {
      envelope_.reset();
      fault = Fault::kNone;
      force.setZero();
      released_for = 0.0;
    }
  }

  Vector3d force{Vector3d::Zero()};
  Vector3d before{Vector3d::Zero()};
  Fault fault{Fault::kNone};
  Fault fault_before{Fault::kNone};
  double dt{kDt};
  double released_for{0.0};  // [s]

 private:
  void move() {
    if (mood_ == kFreezes) {
      return;
    }
    speed_ = 0.98 * speed_ + any_vector(random_, 2e-5);
    hand_ = 0.999 * (hand_ + speed_);
    if (!hand_.allFinite() || random_.below(5000) == 0) {
      hand_ = any_vector(random_, 0.04);
      speed_.setZero();
    }
    hand_ += mood_ == kJitters ? any_vector(random_, 0.002) : Vector3d(Vector3d::Zero());
  }
  Vector3d any_force() {
    if (mood_ == kShakes) {
      return {0.0, mood_left_ / 8 % 2 == 0 ? 11.0 : -11.0, 0.0};
    }
    wanted_ = 0.995 * wanted_ + any_vector(random_, 0.3);
    if (!wanted_.allFinite() || wanted_.norm() > 12.0) {
      return std::exchange(wanted_, Vector3d::Zero());
    }
    return wanted_;
  }

  static constexpr int kFreezes = 1;
  static constexpr int kJitters = 2;
  static constexpr int kShakes = 3;
  int mood_{0};
  int mood_left_{0};
  Vector3d speed_{Vector3d::Zero()};
  Vector3d wanted_{Vector3d::Zero()};
  Envelope envelope_{EnvelopeLimits{}};
  RandomStream random_{1, "envelope"};
  Vector3d hand_{Vector3d::Zero()};
};

TEST(EnvelopeTest, HoldsItsPromiseOverTenMillionRandomTicks) {
  constexpr EnvelopeLimits kLimits;
  RandomRun run;
  std::set<Fault> seen;
  std::uint64_t forces = 0;
  std::uint64_t released = 0;
  for (int tick = 0; tick < 10'000'000; ++tick) {
    run.tick();
    ASSERT_TRUE(run.force.allFinite()) << tick;
    ASSERT_LE(run.force.norm(), kLimits.max_force * (1.0 + 1e-12)) << tick;
    if (run.fault != Fault::kNone) {
      ASSERT_TRUE(run.force.isZero(0.0)) << tick << ": " << describe(run.fault);
    } else {
      ASSERT_LE((run.force - run.before).norm(),
                kLimits.max_force_rate * run.dt * (1.0 + 1e-9) + 1e-12)
          << tick;
    }
    if (run.released_for > 0.0) {
      ASSERT_LE(run.force.norm(), run.before.norm() + 1e-12) << tick << ": grew after a release";
    }
    if (run.released_for > kLimits.ramp_out + 2.0 * kDt) {
      ASSERT_TRUE(run.force.isZero(0.0)) << tick;
      ++released;
    }
    ASSERT_TRUE(run.fault_before == Fault::kNone || run.fault_before == run.fault)
        << tick << ": a fault was replaced";
    seen.insert(run.fault);
    forces += !run.force.isZero(0.0);
    run.maybe_reset();
  }
  for (int i = 0; i < kFaults; ++i) {
    const auto fault = static_cast<Fault>(i);
    const bool rare = fault == Fault::kOrientationNotFinite || fault == Fault::kSaturation ||
                      fault == Fault::kEnergy || fault == Fault::kChannelLost ||
                      fault == Fault::kBeyondLimit;  // the last two come from a session
    EXPECT_TRUE(rare || seen.count(fault) == 1) << "never came up: " << describe(fault);
  }
  EXPECT_GT(forces, 2'000'000u) << "and much of the time there was none";
  EXPECT_GT(released, 100'000u);
}

TEST(EnvelopeTest, ATickDoesNotAllocate) {
  Envelope envelope({});
  const test::AllocationGuard guard;
  for (int tick = 0; tick < 1000; ++tick) {
    envelope.check(tick != 500, at({1e-5 * tick, 0, 0}));
    envelope.limit({0, 3, 0}, kDt);
  }
  envelope.reset();
  EXPECT_EQ(guard.count(), 0u);
}

TEST(EnvelopeTest, EveryFaultHasItsOwnWords) {
  std::set<std::string> words;
  for (int fault = 0; fault < kFaults; ++fault) {
    const std::string text = describe(static_cast<Fault>(fault));
    EXPECT_FALSE(text.empty());
    EXPECT_NE(text, "unknown fault") << fault;
    words.insert(text);
  }
  EXPECT_EQ(words.size(), static_cast<std::size_t>(kFaults));
}

/// A course of readings and wanted forces that goes wrong only over many ticks.
struct SlowBreach {
  Fault fault;
  double latest;  // to be found by [s]
  std::function<Vector3d(double time)> position;
  std::function<Vector3d(double time, const Vector3d& position)> wanted;
};

std::vector<SlowBreach> slow_breaches() {
  const auto lies = [](double t) { return Vector3d(1e-5 * std::sin(300.0 * t), 0.0, 0.0); };
  const auto steady = [](double, const Vector3d&) { return Vector3d(0.0, 2.0, 0.0); };
  return {
      {Fault::kOscillation, 0.1, lies,
       [](double t, const Vector3d&) { return Vector3d(0.0, 11.0 * std::sin(280.0 * t), 0.0); }},
      {Fault::kSaturation, 3.1, lies,
       [](double, const Vector3d&) { return Vector3d(0.0, 12.0, 0.0); }},
      {Fault::kFrozen, 0.4, [](double) { return Vector3d(0.01, 0.0, 0.0); },
       [](double t, const Vector3d&) { return Vector3d(0.0, std::min(12.0, 14.4 * t), 0.0); }},
      {Fault::kJitter, 0.05,
       [](double t) { return Vector3d(std::lround(1e3 * t) % 2 == 0 ? 0.004 : 0.0, 0.0, 0.0); },
       steady},
      {Fault::kEnergy, 0.6, [](double t) { return Vector3d(0.1 * t, 0.0, 0.0); },
       [](double, const Vector3d& p) { return Vector3d(std::min(11.0, 500.0 * p.x()), 0.0, 0.0); }},
  };
}

TEST(EnvelopeTest, WhatOnlyManyTicksShowBringsTheForceToZeroToo) {
  for (const SlowBreach& breach : slow_breaches()) {
    Envelope envelope(open_limits());
    const auto tick = [&](int i) {
      const Vector3d p = breach.position(kDt * i);
      envelope.check(true, at(p));
      return envelope.limit(breach.wanted(kDt * i, p), kDt);
    };
    int i = 1;
    while (envelope.fault() == Fault::kNone && i < 5000) {
      const Vector3d force = tick(i++);
      ASSERT_TRUE(envelope.fault() == Fault::kNone || force.isZero(0.0)) << "in the same tick";
    }
    EXPECT_EQ(envelope.fault(), breach.fault) << describe(envelope.fault());
    EXPECT_LE(kDt * i, breach.latest) << describe(breach.fault);
    for (int after = 0; after < 1000; ++after) {
      ASSERT_TRUE(tick(i++).isZero(0.0)) << describe(breach.fault);
    }
    envelope.reset();
    envelope.check(true, at({0, 0, 0}));
    EXPECT_EQ(envelope.limit({0, 5, 0}, kDt), Vector3d(0, 5, 0)) << "a person cleared it";
  }
}

TEST(EnvelopeTest, TheForceDoesNotGrowWhileReadingsAreSuspicious) {
  for (const double size : {0.0, 0.004}) {  // frozen, jittering
    Envelope envelope(open_limits());
    double largest = 0.0;
    for (int i = 0; i < 100; ++i) {
      envelope.check(true, at({i % 2 == 0 ? size : 0.0, 0, 0}));
      largest = std::max(largest, envelope.limit({0, 0.1 * i, 0}, kDt).norm());
    }
    EXPECT_NE(envelope.fault(), Fault::kNone);
    EXPECT_LE(largest, 2.0) << size;
  }
}

/// A hand that keeps still gives readings that are equal, as a frozen device does.
TEST(EnvelopeTest, APulseThatIsHeldBackLeavesNothingBehind) {
  for (const int ticks : {5, 10, 20, 50}) {
    Envelope envelope(open_limits());
    double impulse = 0.0;
    for (int i = 0; i < 300; ++i) {
      // The hand gives way by a step of the encoder now and then, and is read again.
      envelope.check(true, at({0.0, i > 112 ? -1e-5 * (i / 7) : 0.0, 0.0}));
      const bool on = i >= 100 && i < 100 + ticks;
      ForceIntent intent;
      intent.stimulus = on ? Vector3d(0.0, -4.0, 0.0) : Vector3d::Zero();
      intent.ended = i == 100 + ticks ? Vector3d(0.0, -4.0, 0.0) : Vector3d::Zero();
      const double force = envelope.limit(intent.stimulus, kDt, intent).y();
      ASSERT_EQ(envelope.fault(), Fault::kNone);
      ASSERT_LE(force, 0.0) << "never the other way, " << ticks << " ms, tick " << i;
      ASSERT_TRUE(on || force == 0.0) << ticks << " ms, tick " << i;
      impulse += kDt * force;
    }
    EXPECT_LT(impulse, -0.2 * 4.0 * kDt * ticks) << "some of it comes";
    EXPECT_GE(impulse, -4.0 * kDt * ticks - 1e-9);
  }
}

/// A hand that pushes just as hard as a wall that grows stays where it is, to the last bit.
TEST(EnvelopeTest, AHandThatTensesAgainstAWallIsNotFrozen) {
  constexpr double kMass = 1.0;
  constexpr double kFriction = 0.15;  // of the handle [N]
  for (const double most : {0.9, 3.0, 7.0}) {
    for (const double grows : {0.1, 0.4}) {  // [s]
      Envelope envelope(open_limits());
      double x = 0.0;
      double v = 0.0;
      double given = 0.0;
      double least = most;
      for (int i = 0; i < 3000; ++i) {
        const double wanted = most * std::min(1.0, kDt * i / grows);
        const double net = given - wanted;  // the hand pushes against what is to come
        const double pull = std::abs(net) > kFriction || v != 0.0
                                ? net - std::copysign(std::min(kFriction, std::abs(net)), net)
                                : 0.0;
        v = std::abs(pull) > 0.0 ? v + kDt * (pull / kMass - 40.0 * v) : 0.0;
        x += kDt * v;
        envelope.check(true, at({1e-5 * std::round(1e5 * x), 0.0, 0.0}));
        given = envelope.limit({wanted - 300.0 * x, 0.0, 0.0}, kDt).x();
        ASSERT_EQ(envelope.fault(), Fault::kNone) << most << " N at " << i << " ms";
        least = kDt * i > grows + 0.05 ? std::min(least, given) : least;
      }
      EXPECT_GT(least, most - 0.9) << "it loses little before it is told from a frozen reading";
    }
  }
}

/// A protocol goes over to other forces, in contact or not.
TEST(EnvelopeTest, WhatChangesByGoingOverFades) {
  EnvelopeLimits limits = open_limits();
  limits.change_time = 0.1;
  Envelope envelope(limits);
  double x = 0.0;
  const auto tick = [&](const Vector3d& wanted, const ForceIntent& intent = {}) {
    envelope.check(true, at({x += 1e-6, 0, 0}));
    return envelope.limit(wanted, kDt, intent);
  };
  Vector3d before = tick({0, 5, 0});
  envelope.go_over();
  for (int i = 0; i < 99; ++i) {
    const Vector3d force = tick({0, -3, 0});
    ASSERT_LT((force - before).norm(), 0.13) << i;
    before = force;
  }
  EXPECT_EQ(tick({0, -3, 0}), Vector3d(0, -3, 0));
  EXPECT_EQ(tick({0, 2, 0}), Vector3d(0, 2, 0)) << "other changes are not held back";
  envelope.go_over();
  ForceIntent pulse;
  pulse.stimulus = {4, 0, 0};
  EXPECT_EQ(tick({4, 2, 0}, pulse), Vector3d(4, 2, 0)) << "a stimulus begins as it is meant to";
}

/// One of two stimuli ends with the change, and one goes on: an alternating force of 3 N.
TEST(EnvelopeTest, AStimulusThatEndsByGoingOverFades) {
  EnvelopeLimits limits = open_limits();
  limits.change_time = 0.1;
  Envelope envelope(limits);
  double x = 0.0;
  const auto tick = [&](double pulse, double alternating, double ended) {
    ForceIntent intent;
    intent.stimulus = {pulse, alternating, 0};
    intent.ended = {ended, 0, 0};
    envelope.check(true, at({x += 1e-6, 0, 0}));
    return envelope.limit({pulse, 1.0 + alternating, 0}, kDt, intent);
  };
  tick(5, 3, 0);
  envelope.go_over();
  for (int i = 1; i <= 120; ++i) {
    const double u = std::min(1.0, i / 100.0);
    const Vector3d force = tick(0, i % 2 == 0 ? 3 : -3, i == 1 ? 5 : 0);
    ASSERT_NEAR(force.x(), 5.0 * (1.0 - u * u * (3.0 - 2.0 * u)), 1e-9) << i;
    ASSERT_EQ(force.y(), i % 2 == 0 ? 4.0 : -2.0) << i;
  }
}

TEST(EnvelopeTest, AfterAGapTheForceRampsInFromZero) {
  EnvelopeLimits limits;
  limits.ramp_in = 0.2;
  Envelope envelope(limits);
  const auto tick = [&](double x) {
    envelope.check(true, at({x, 0, 0}));
    return envelope.limit({0, 5, 0}, kDt).y();
  };
  for (int i = 0; i < 300; ++i) {
    tick(1e-6 * i);
  }
  EXPECT_EQ(tick(0.001), 5.0);
  envelope.resume();
  double before = tick(0.05);
  EXPECT_LE(before, 0.026);
  for (int i = 0; i < 199; ++i) {
    const double force = tick(0.05 + 1e-6 * i);
    ASSERT_NEAR(force - before, 0.025, 1e-9);
    before = force;
  }
  EXPECT_EQ(envelope.fault(), Fault::kNone) << "the hand may have moved meanwhile";
}

TEST(EnvelopeTest, NoKeyTakesACheckOutOfUse) {
  const auto refused = [](const std::string& line) {
    Table table = Table::parse(
        "max_force = 8.0\nworkspace_radius = 0.08\nmax_speed = 1.0\nmax_jump = 0.005\n" + line +
            "\n",
        "study.toml");
    const EnvelopeLimits limits = envelope_schema().read(table);
    EXPECT_NO_THROW(table.finish()) << "recordings may have it";
    check_new_envelope(table, limits);
    const std::string said = test::message_of([&] { table.finish(); });
    EXPECT_NE(said.find(line.substr(0, line.find(' '))), std::string::npos) << said;
  };
  const std::string rest = "max_force_rate = 4000.0\nramp_in = 0.2\nramp_out = 0.2\n";
  refused("max_saturation = 600.0\n" + rest);
  refused("holding_force = 10.0\n" + rest);
  refused("change_time = 0.0\n" + rest);
  refused("change_time = 0.3\n" + rest);
  refused("ramp_in = 0.0\nramp_out = 0.2\nmax_force_rate = 4000.0");
  refused("ramp_out = 0.0\nramp_in = 0.2\nmax_force_rate = 4000.0");
  refused("ramp_out = 1.0\nramp_in = 0.2\nmax_force_rate = 4000.0");
  refused("max_force_rate = 1e6\nramp_in = 0.2\nramp_out = 0.2");
}

TEST(EnvelopeTest, LimitsOutOfBoundsAreRefused) {
  const auto refused = [](double EnvelopeLimits::*limit, double value) {
    EnvelopeLimits limits;
    limits.*limit = value;
    EXPECT_THROW(Envelope{limits}, std::invalid_argument) << value;
  };
  for (const double bad : {0.0, -1.0, kNan}) {
    refused(&EnvelopeLimits::max_force, bad);
    refused(&EnvelopeLimits::max_force_rate, bad);
    refused(&EnvelopeLimits::workspace_radius, bad);
    refused(&EnvelopeLimits::max_speed, bad);
    refused(&EnvelopeLimits::max_jump, bad);
    refused(&EnvelopeLimits::max_saturation, bad);
    refused(&EnvelopeLimits::holding_force, bad);
  }
  refused(&EnvelopeLimits::ramp_in, -0.1);
  refused(&EnvelopeLimits::ramp_in, kNan);
  refused(&EnvelopeLimits::ramp_out, -0.1);
  refused(&EnvelopeLimits::ramp_out, kNan);
}

TEST(EnvelopeTest, AnOrientationThatIsNoneStopsTheForce) {
  const auto fault_of = [](const Eigen::Quaterniond& orientation) {
    Envelope envelope{EnvelopeLimits{}};
    DeviceReading reading;
    reading.orientation = orientation;
    return envelope.check(true, reading);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fault_of({nan, 0.0, 0.0, 0.0}), Fault::kOrientationNotFinite);
  EXPECT_EQ(fault_of({0.0, 0.0, 0.0, 0.0}), Fault::kOrientationNotFinite);
  EXPECT_EQ(fault_of({0.0, 2.0, 0.0, 0.0}), Fault::kOrientationNotFinite);
  EXPECT_EQ(fault_of({0.0, 0.6, 0.0, 0.8}), Fault::kNone);
  EXPECT_STREQ(describe(Fault::kOrientationNotFinite),
               "the device gave an orientation that is not a unit quaternion");
}

TEST(EnvelopeTest, LimitsAreReadWithTheirBounds) {
  Table good = Table::parse(
      "max_force = 8.0\nmax_force_rate = 100.0\nworkspace_radius = 0.05\nmax_speed = 0.5\n"
      "max_jump = 0.001\nramp_in = 0.05\nramp_out = 0.3\n",
      "f.toml");
  const EnvelopeLimits limits = envelope_schema().read(good);
  EXPECT_NO_THROW(good.finish());
  EXPECT_NO_THROW(Envelope{limits});
  EXPECT_EQ(limits.max_force, 8.0);
  EXPECT_EQ(limits.max_jump, 0.001);
  EXPECT_EQ(limits.ramp_out, 0.3);
  Table bad = Table::parse(
      "max_force = 0.0\nmax_force_rate = 0.0\nworkspace_radius = 0.0\nmax_speed = 0.0\n"
      "max_jump = 0.0\nramp_in = -1.0\nramp_out = 11.0\n",
      "f.toml");
  envelope_schema().read(bad);
  try {
    bad.finish();
    FAIL();
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_EQ(std::count(what.begin(), what.end(), '\n'), 6) << what;
  }
}

}  // namespace
}  // namespace haptrial::device::envelope_test
