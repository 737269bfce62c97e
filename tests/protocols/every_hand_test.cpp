// Nobody is hurt: a pass with every hand from the bare handle to 2 kg, on every loop, and a handle
// that is let go in the middle of it.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/device/virtual_device.h"
#include "protocols/recall_test.h"
#include "protocols/session_task.h"
#include "protocols/training_pass.h"

namespace haptrial::protocols {
namespace {

using Eigen::Vector3d;

/// A hand of some mass whose posture yields, on a handle of 0.22 kg with 0.1 N of friction.
class HandOnHandle final : public device::HandlePhysics {
 public:
  explicit HandOnHandle(double mass) { hold(mass); }
  void hold(double mass) {
    mass_ = 0.22 + mass;
    damping_ = 15.0 * mass / 0.8;
    stiffness_ = 250.0 * mass / 0.8;
  }
  double press{0.0};  // downward [N]

  PointState step(const Vector3d& motor, double dt) noexcept override {
    constexpr int kSteps = 4;
    constexpr double kFriction = 0.1;     // [N]
    constexpr double kPostureTime = 0.1;  // [s]
    const double h = dt / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      Vector3d f = motor - stiffness_ * (state_.position - posture_) - damping_ * state_.velocity;
      f.y() -= press;
      posture_ += h / kPostureTime * (state_.position - posture_);
      state_.velocity += h / mass_ * f;
      const double stop = kFriction / mass_ * h;
      const double speed = state_.velocity.norm();
      state_.velocity *= speed > stop ? 1.0 - stop / speed : 0.0;
      state_.position += h * state_.velocity;
    }
    return state_;
  }
  PointState state() const noexcept override { return state_; }

 private:
  double mass_{0.0};
  double damping_{0.0};
  double stiffness_{0.0};
  PointState state_{Vector3d::Zero(), Vector3d::Zero()};
  Vector3d posture_{Vector3d::Zero()};
};

struct Loop {
  double rate;
  int delay;
};
std::vector<Loop> loops() {
  return {{1000.0, 1}, {1000.0, 2}, {1000.0, 3}, {2000.0, 1},
          {2000.0, 3}, {4000.0, 1}, {4000.0, 3}};
}

/// A pass that runs on a loop, tick by tick.
class PassRun {
 public:
  PassRun(Pass& pass, const Loop& loop, double hand) : loop_(loop), hand_(hand) {
    device::VirtualDeviceParameters parameters;
    parameters.force_delay = loop.delay;
    device_ = std::make_unique<device::VirtualDevice>(parameters, hand_, loop.rate);
    task_ = std::make_unique<SessionTask>(*device_, device::EnvelopeLimits{}, log_,
                                          std::vector<stimulus::Observer*>{},
                                          SessionTask::Leave::kNever);
    task_->start(pass, 0);
  }

  HandOnHandle& hand() { return hand_; }
  bool idle() const { return task_->idle(); }
  device::Fault fault() const { return task_->result().fault; }

  /// @returns the seconds with the force at its limit.
  double advance(double seconds) {
    int at_limit = 0;
    for (int i = 0; i < static_cast<int>(seconds * loop_.rate) && !task_->idle(); ++i) {
      const auto at =
          static_cast<std::int64_t>(std::llround(1e9 * static_cast<double>(tick_) / loop_.rate));
      task_->tick({tick_++, at, 1.0 / loop_.rate});
      log_.flush([&](auto samples) {
        for (const record::Sample& sample : samples) {
          at_limit += sample.force.norm() >= 0.98 * 12.0;
          stage = sample.stage;
          force = sample.force;
        }
      });
    }
    return at_limit / loop_.rate;
  }
  double advance_to(record::Stage wanted) {
    double at_limit = 0.0;
    for (int i = 0; i < 2000 && stage != wanted && !task_->idle(); ++i) {
      at_limit += advance(0.01);
    }
    return at_limit;
  }

  record::Stage stage{record::Stage::kIdle};
  Vector3d force{Vector3d::Zero()};

 private:
  Loop loop_;
  HandOnHandle hand_;
  std::unique_ptr<device::VirtualDevice> device_;
  SessionTask::Log log_;
  std::unique_ptr<SessionTask> task_;
  std::uint64_t tick_{0};
};

GuidanceParameters published(const Loop& loop) {
  GuidanceParameters p;
  p.loop.rate = loop.rate;
  p.loop.force_delay = loop.delay;
  return p;
}

constexpr double kBurst = 0.030;  // [s]

TEST(EveryHandTest, APassIsQuietWithEveryHandOnEveryLoop) {
  const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  for (const Loop& loop : loops()) {
    for (const double mass : {0.001, 0.1, 0.3, 0.5, 0.8, 2.0}) {
      SCOPED_TRACE(testing::Message() << mass << " kg, " << loop.rate << " Hz, " << loop.delay);
      RecallTest pass(stimulus, published(loop), 1);
      PassRun run(pass, loop, mass);
      double at_limit = run.advance_to(record::Stage::kRun);
      ASSERT_EQ(run.stage, record::Stage::kRun) << device::describe(run.fault());
      run.hand().press = 4.0;
      at_limit += run.advance(4.0);
      EXPECT_LE(at_limit, kBurst);
      EXPECT_FALSE(run.idle()) << device::describe(run.fault());
    }
  }
}

TEST(EveryHandTest, AHandleThatIsLetGoInMidPassIsQuiet) {
  const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  for (const Loop& loop : loops()) {
    for (const char* condition : {"visual", "visuohaptic"}) {
      for (const double press : {0.0, 3.0, 8.0}) {
        SCOPED_TRACE(testing::Message() << condition << " pressed with " << press << " N, "
                                        << loop.rate << " Hz, " << loop.delay);
        const auto pass = make_training_pass(condition, stimulus, published(loop), 1);
        PassRun run(*pass, loop, 1.0);
        run.advance_to(record::Stage::kRun);
        run.hand().press = press;
        run.advance(2.0);
        run.hand().hold(0.0);
        run.hand().press = 0.0;
        EXPECT_LE(run.advance(0.3), kBurst);
        EXPECT_EQ(run.advance(3.0), 0.0);
      }
    }
  }
}

/// The damping of the source, whatever the hand: what the loop did before it was governed.
TEST(EveryHandTest, WhatOscillatesAllTheSameIsEndedWithin100Milliseconds) {
  const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  for (const double mass : {0.0, 0.1, 0.3}) {
    const Loop loop{1000.0, 1};
    GuidanceParameters ungoverned = published(loop);
    ungoverned.loop.handle_mass = 1000.0;  // a handle so heavy that it carries everything
    RecallTest pass(stimulus, ungoverned, 1);
    PassRun run(pass, loop, 1.0);
    run.advance_to(record::Stage::kRun);
    run.hand().press = 2.0;
    run.advance(1.0);
    ASSERT_FALSE(run.idle());
    run.hand().hold(mass);
    run.hand().press = 0.0;
    const double at_limit = run.advance(3.0);
    EXPECT_TRUE(run.idle()) << mass;
    EXPECT_EQ(run.fault(), device::Fault::kOscillation) << device::describe(run.fault());
    EXPECT_TRUE(run.force.isZero(0.0));
    EXPECT_LE(at_limit, 0.100) << mass;
  }
}

}  // namespace
}  // namespace haptrial::protocols
