// A session that starts with the hand away from the start position never jerks.

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/random.h"
#include "core/device/handle_physics.h"
#include "core/device/virtual_device.h"
#include "protocols/force_training/training_pass.h"
#include "protocols/force_training/trajectory_pass.h"
#include "protocols/interface/session_task.h"

namespace haptrial::protocols {
namespace {

using Eigen::Vector3d;

struct Start {
  double greatest_change{0.0};  // of the force between two ticks [N]
  double first_force{0.0};      // in the first 5 ms [N]
  double greatest_force{0.0};   // [N]
  double fastest{0.0};          // the hand [m/s]
};

/// The first three seconds of a pass, with the hand held by its owner at `where`.
Start start_from(const Vector3d& where, Pass& pass) {
  device::CoupledMass hand({1.0, 250.0, 15.0}, where);
  device::VirtualDevice device({}, hand, 1000.0);
  SessionTask::Log log;
  SessionTask task(device, device::EnvelopeLimits{}, log, {}, SessionTask::Leave::kNever);
  Start start;
  Vector3d before = Vector3d::Zero();
  for (std::uint64_t i = 0; i < 3000; ++i) {
    if (i == 10) {
      task.start(pass, 0);
    }
    task.tick({i, static_cast<std::int64_t>(i) * 1'000'000, 1e-3});
  }
  log.flush([&](auto samples) {
    for (const record::Sample& sample : samples) {
      if (task.result().fault != device::Fault::kNone &&
          sample.sequence >= task.result().last_sample) {
        break;  // a fault cuts the force
      }
      start.greatest_change = std::max(start.greatest_change, (sample.force - before).norm());
      start.greatest_force = std::max(start.greatest_force, sample.force.norm());
      start.fastest = std::max(start.fastest, sample.velocity.norm());
      if (sample.sequence < 15) {
        start.first_force = std::max(start.first_force, sample.force.norm());
      }
      before = sample.force;
    }
  });
  return start;
}

TEST(StartAwayTest, NeverJerksWhereverTheHandIs) {
  const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  const Vector3d centre = stimulus.path.points().front();
  RandomStream random(1, "start");
  for (int round = 0; round < 40; ++round) {
    const Vector3d away{random.uniform(-0.04, 0.04), random.uniform(-0.04, 0.04),
                        random.uniform(-0.04, 0.04)};
    TrajectoryPass recall(kRecallTest, stimulus, {}, 1);
    const auto training = make_training_pass(
        training_conditions()[random.below(training_conditions().size())], stimulus, {}, 1);
    for (Pass* pass : {static_cast<Pass*>(training.get()), static_cast<Pass*>(&recall)}) {
      const Start start = start_from(away, *pass);
      // The guide starts at the hand and goes at 0.1 m/s at most: 0.09 N a tick by its spring. One
      // step of the encoders adds up to 0.25 N through the damper of the plane (300 N·s/m).
      EXPECT_LT(start.greatest_change, 0.6) << "from " << away.transpose();
      EXPECT_LT(start.first_force, 0.3);
      EXPECT_LT(start.fastest, 0.2);
      EXPECT_TRUE((away - centre).norm() < 0.02 || start.greatest_force > 1.0)
          << "and yet it was guided";
    }
  }
}

/// Pulls at once with all that it has, as a protocol should not.
class Tug final : public Pass {
 public:
  PassOutput tick(const Readings& readings, double) noexcept override {
    PassOutput out;
    out.force = -12.0 * readings[0].tool.position.normalized();
    return out;
  }
  PassState state() const noexcept override { return PassState::kRunning; }
};

TEST(StartAwayTest, AProtocolThatWouldJerkIsHeldByTheEnvelope) {
  Tug tug;
  const Start start = start_from({0.05, 0.0, 0.0}, tug);
  EXPECT_LE(start.greatest_change, 4.0 * (1.0 + 1e-9)) << "max_force_rate over a tick";
  EXPECT_LT(start.first_force, 12.0 * 15e-3 / 0.2 + 1e-9) << "ramp_in";
}

}  // namespace
}  // namespace haptrial::protocols
