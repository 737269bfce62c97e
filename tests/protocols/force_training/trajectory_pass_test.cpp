#include "protocols/force_training/trajectory_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "protocols/force_training/training_pass.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/free_mass.h"

namespace haptrial::protocols::trajectory_pass_test {
namespace {

using Eigen::Vector3d;
using record::Stage;
using stimulus::Instruction;

constexpr double kDt = 1e-3;
const std::vector<std::string> kKinds{"haptic", "visual", "visuohaptic", "recall"};

const stimulus::Stimulus& stimulus_of_study() {
  static const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  return stimulus;
}

std::unique_ptr<TrajectoryPass> make_pass(const std::string& kind,
                                          const GuidanceParameters& parameters = {}) {
  if (kind == "recall") {
    return std::make_unique<TrajectoryPass>(kRecallTest, stimulus_of_study(), parameters, 7);
  }
  return make_training_pass(kind, stimulus_of_study(), parameters, 7);
}

/// One tick as an observer of both sides sees it.
struct Moment {
  PointState tool;
  PassOutput out;
};

/// A hand without a will: 1 kg in oil, with a spring and damper of its own along y that stands for
/// a participant who resists the device there.
struct Hand {
  explicit Hand(const Vector3d& where)
      : mass(1.0, {where, Vector3d::Zero()}, test::FreeMass::Rule::kSymplectic, 15.0) {}
  void move(const Vector3d& device_force) {
    const PointState& s = mass.state();
    const Vector3d own{0.0, push - 500.0 * s.position.y() - 30.0 * s.velocity.y(), 0.0};
    mass.step(device_force + own, kDt);
  }
  test::FreeMass mass;
  double push{0.0};  // upward [N]
};

std::vector<Moment> run(TrajectoryPass& pass, Hand& hand, int most_ticks = 60000) {
  std::vector<Moment> moments;
  while (pass.state() == PassState::kRunning && static_cast<int>(moments.size()) < most_ticks) {
    const PointState tool = hand.mass.state();
    moments.push_back({tool, pass.tick(device::DeviceReading{tool}, kDt)});
    hand.move(moments.back().out.force);
  }
  return moments;
}

/// The same with a hand that nothing moves.
std::vector<Moment> run_still(TrajectoryPass& pass, const Vector3d& where) {
  std::vector<Moment> moments;
  while (pass.state() == PassState::kRunning && moments.size() < 60000) {
    const PointState tool{where, Vector3d::Zero()};
    moments.push_back({tool, pass.tick(device::DeviceReading{tool}, kDt)});
  }
  return moments;
}

std::vector<Moment> of_stage(const std::vector<Moment>& moments, Stage stage) {
  std::vector<Moment> some;
  std::copy_if(moments.begin(), moments.end(), std::back_inserter(some),
               [&](const Moment& m) { return m.out.stage == stage; });
  return some;
}

class EveryPass : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Kinds, EveryPass, ::testing::ValuesIn(kKinds),
                         [](const auto& kind) { return kind.param; });

TEST_P(EveryPass, GoesThroughItsStagesInOrder) {
  const auto pass = make_pass(GetParam());
  Hand hand({0.02, 0.01, -0.01});
  const auto moments = run(*pass, hand);
  EXPECT_EQ(pass->state(), PassState::kCompleted);
  std::vector<Stage> order;
  for (const Moment& m : moments) {
    if (order.empty() || order.back() != m.out.stage) {
      order.push_back(m.out.stage);
    }
  }
  EXPECT_EQ(order,
            (std::vector<Stage>{Stage::kApproach, Stage::kWait, Stage::kRun, Stage::kReturn}));
}

TEST_P(EveryPass, EveryStageLastsAsLongAsItsLawSays) {
  const GuidanceParameters p;
  const auto pass = make_pass(GetParam(), p);
  const Vector3d where{0.02, 0.01, -0.01};
  Hand hand(where);
  const auto moments = run(*pass, hand);
  const auto& path = stimulus_of_study().path;
  const Vector3d start = path.points().front();
  const auto ticks = [&](Stage s) { return static_cast<double>(of_stage(moments, s).size()); };

  const double approach = std::max(0.2, 1.875 * (start - where).norm() / p.approach_speed);
  EXPECT_NEAR(ticks(Stage::kApproach), approach / kDt, 1.01);
  EXPECT_NEAR(ticks(Stage::kRun), path.duration() / kDt, 1.01);
  const double back = 1.875 * (start - path.points().back()).norm() / p.approach_speed;
  EXPECT_NEAR(ticks(Stage::kReturn), back / kDt, 0.01 * back / kDt) << "from near the end";

  // The wait: the run starts when the hand has been close for `wait`, and not before.
  const auto wait = of_stage(moments, Stage::kWait);
  int close = 0;
  for (std::size_t i = 0; i < wait.size(); ++i) {
    const bool near = (wait[i].tool.position - start).norm() <= p.settle_distance;
    close = near ? close + 1 : 0;
    ASSERT_LT(close, p.wait / kDt + 1.5) << i;
  }
  EXPECT_NEAR(close, p.wait / kDt - 1, 1.01) << "the tick that completes it is the first to run";
}

TEST_P(EveryPass, TheGuideNeverJumps) {
  // Undamped gains and a still hand show the guide's position: target = tool + force / stiffness.
  GuidanceParameters p;
  p.trajectory = p.plane = {1000.0, 0.0};
  p.settle_distance = 1.0;
  p.force_limit = 1e9;
  const auto pass = make_pass(GetParam(), p);
  const Vector3d where{0.03, 0.02, -0.02};
  const auto moments = run_still(*pass, where);
  ASSERT_EQ(pass->state(), PassState::kCompleted);
  EXPECT_TRUE(moments.front().out.force.isZero(1e-9)) << "it starts where the hand is";
  const double most = std::max(p.approach_speed, stimulus_of_study().path.speed()) * kDt;
  Vector3d before = where;
  Stage stage_before = Stage::kApproach;
  for (const Moment& m : moments) {
    Vector3d guide = where + m.out.force / 1000.0;
    const bool free_y = GetParam() == "haptic" && m.out.stage == Stage::kRun;
    guide.y() = free_y ? where.y() : guide.y();
    if (free_y && stage_before != Stage::kRun) {
      before.y() = where.y();  // nothing guides y any more
    }
    if (GetParam() == "haptic" && m.out.stage == Stage::kReturn && stage_before == Stage::kRun) {
      EXPECT_NEAR(guide.y(), where.y(), 1e-12) << "the return starts where the hand is";
    }
    ASSERT_LE((guide - before).norm(), most * (1 + 1e-6)) << static_cast<int>(m.out.stage);
    before = guide;
    stage_before = m.out.stage;
  }
  EXPECT_LT((before - stimulus_of_study().path.points().front()).norm(), 1e-9);
}

TEST_P(EveryPass, PullsTheHandAlongThePath) {
  const auto pass = make_pass(GetParam());
  Hand hand({0.0, 0.0, 0.0});
  const auto moments = run(*pass, hand);
  const auto running = of_stage(moments, Stage::kRun);
  const std::size_t blending_out = running.size() - 80;  // the damper's part of the target goes
  for (std::size_t i = 1000; i < blending_out; ++i) {
    Vector3d apart = running[i].tool.position -
                     stimulus_of_study().path.at(static_cast<double>(i) * kDt).position;
    apart.y() = 0.0;
    // Drag over stiffness, 15 · 0.016 / 900 m, doubled for the curve.
    ASSERT_LT(apart.norm(), 2.0 * 15.0 * 0.016 / 900.0) << i;
  }
}

TEST_P(EveryPass, TheForceDoesNotJumpAtAChangeOfStage) {
  const auto pass = make_pass(GetParam());
  Hand hand({0.02, 0.0, -0.02});
  const auto moments = run(*pass, hand);
  // At either end of the run the guide's speed steps by 1.6 cm/s, of which 100 N·s/m would make
  // 1.6 N at once; blended over 80 ms that is 0.02 N a tick.
  for (std::size_t i = 1; i < moments.size(); ++i) {
    ASSERT_LT((moments[i].out.force - moments[i - 1].out.force).norm(), 0.15) << i;
  }
}

TEST(HapticTraining, ThePlaneTakesHoldOfAMovingHandByDegrees) {
  GuidanceParameters p;
  p.force_limit = 1e9;
  const auto pass = make_pass("haptic", p);
  constexpr double kSpeed = 0.05;  // along y, which nothing guides in the run
  PointState tool{stimulus_of_study().path.points().front(), Vector3d::Zero()};
  PassOutput before;
  double held = 0.0;
  for (int tick = 0; tick < 60000 && pass->state() == PassState::kRunning; ++tick) {
    const PassOutput out = pass->tick(device::DeviceReading{tool}, kDt);
    if (out.stage == Stage::kReturn) {
      // A tick adds an eightieth of the damper and what the spring gains; at once it were 15 N.
      ASSERT_LT(std::abs(out.force.y() - before.force.y()),
                1.2 * (300.0 / 80.0 + 2000.0 * kDt) * kSpeed)
          << tick;
      held = std::max(held, std::abs(out.force.y()));
    }
    if (before.stage == Stage::kRun) {
      tool.velocity.y() = kSpeed;
      tool.position.y() += kSpeed * kDt;
    }
    before = out;
  }
  EXPECT_GT(held, 300.0 * kSpeed) << "it holds in the end";
}

TEST_P(EveryPass, TheForceAlongYFollowsTheKindOfPass) {
  GuidanceParameters p;
  p.force_limit = 1e9;
  const auto pass = make_pass(GetParam(), p);
  Hand hand({0.0, 0.005, 0.0});
  hand.push = -4.0;
  const auto moments = run(*pass, hand);
  int ran = 0;
  for (const Moment& m : moments) {
    const bool runs = m.out.stage == Stage::kRun;
    const double target = stimulus_of_study().force.at(runs ? ran++ * kDt : 0.0);
    ASSERT_NEAR(m.out.target_force, target, 1e-9);
    if (GetParam() == "haptic" && runs) {
      ASSERT_EQ(m.out.force.y(), m.out.target_force) << "the opposite of what is to be learnt";
    } else if (runs || m.out.stage == Stage::kWait) {
      ASSERT_NEAR(m.out.force.y(), -2000.0 * m.tool.position.y() - 300.0 * m.tool.velocity.y(),
                  1e-9);
    }
  }
  EXPECT_NEAR(ran * kDt, stimulus_of_study().path.duration(), 2 * kDt);
}

TEST_P(EveryPass, ShowsWhatItsConditionShowsAndOnlyDuringTheRun) {
  struct Shown {
    bool target, applied;
    Instruction instruction;
  };
  const std::map<std::string, Shown> expected{{"haptic", {false, false, Instruction::kHoldPlane}},
                                              {"visual", {true, false, Instruction::kWatch}},
                                              {"visuohaptic", {true, true, Instruction::kMatch}},
                                              {"recall", {false, false, Instruction::kRecall}}};
  const Shown& during = expected.at(GetParam());
  const auto pass = make_pass(GetParam());
  Hand hand({0.0, 0.0, 0.0});
  double progress = 0.0;
  for (const Moment& m : run(*pass, hand)) {
    const auto& seen = stimulus::presentation_of(m.out.shown);
    const bool runs = m.out.stage == Stage::kRun;
    ASSERT_TRUE(seen.show_trajectory) << "in all conditions";
    ASSERT_EQ(seen.show_target_bar, runs && during.target);
    ASSERT_EQ(seen.show_applied_bar, runs && during.applied);
    ASSERT_EQ(seen.instruction, runs ? during.instruction : Instruction::kRest);
    ASSERT_EQ(seen.show_saturation, m.out.saturated);
    ASSERT_EQ(seen.target_force, seen.show_target_bar ? m.out.target_force : 0.0);
    ASSERT_EQ(seen.applied_force, seen.show_applied_bar ? m.out.force.y() : 0.0);
    ASSERT_EQ(seen.tool, m.tool.position);
    ASSERT_EQ(seen.block, 7);
    ASSERT_EQ(seen.pass_duration, stimulus_of_study().path.duration());
    ASSERT_GE(seen.progress, progress);
    progress = seen.progress;
  }
  EXPECT_EQ(progress, 1.0);
}

TEST_P(EveryPass, SaturationIsSaidWhereTheLimitIsReachedAndOnlyThere) {
  GuidanceParameters weak;
  weak.force_limit = 3.0;
  GuidanceParameters strong = weak;
  strong.force_limit = 1e9;
  const auto limited = make_pass(GetParam(), weak);
  const auto unlimited = make_pass(GetParam(), strong);
  Hand hand({0.0, 0.0, 0.0});
  int saturated = 0;
  int ticks = 0;
  while (limited->state() == PassState::kRunning && ++ticks < 60000) {
    hand.push = 6.0 * std::sin(0.002 * ticks);
    const PointState tool = hand.mass.state();
    const PassOutput a = limited->tick(device::DeviceReading{tool}, kDt);
    const PassOutput b = unlimited->tick(device::DeviceReading{tool}, kDt);
    ASSERT_EQ(a.saturated, b.force.norm() > 3.0) << ticks;
    ASSERT_LE(a.force.norm(), 3.0 * (1 + 1e-12));
    ASSERT_NEAR(a.force.dot(b.force), a.force.norm() * b.force.norm(), 1e-9) << "same direction";
    ASSERT_FALSE(b.saturated);
    saturated += a.saturated;
    hand.move(a.force);
  }
  EXPECT_EQ(limited->state(), PassState::kCompleted);
  EXPECT_GT(saturated, 500);
  EXPECT_LT(saturated, ticks);
}

TEST_P(EveryPass, GivesUpOnAHandThatIsHeldAway) {
  GuidanceParameters p;
  p.wait_timeout = 2.0;
  const auto pass = make_pass(GetParam(), p);
  const Vector3d where = stimulus_of_study().path.points().front() + Vector3d(0.0, 0.0, 0.0031);
  const auto moments = run_still(*pass, where);
  EXPECT_EQ(pass->state(), PassState::kAborted);
  const double approach = std::max(0.2, 1.875 * 0.0031 / p.approach_speed);
  EXPECT_NEAR(static_cast<double>(moments.size()) * kDt, approach + 2.0, 3 * kDt);
  EXPECT_TRUE(of_stage(moments, Stage::kRun).empty());
}

TEST_P(EveryPass, ABreakStartsTheWaitAnew) {
  const auto pass = make_pass(GetParam());
  const Vector3d start = stimulus_of_study().path.points().front();
  int ticks = 0;
  Stage stage = Stage::kIdle;
  while (stage != Stage::kRun && ticks < 5000) {
    ++ticks;  // close for 0.4 s, away for one tick, close again
    const Vector3d where = ticks == 400 ? Vector3d(start + Vector3d(0.004, 0, 0)) : start;
    stage = pass->tick(device::DeviceReading{where, Vector3d::Zero()}, kDt).stage;
  }
  EXPECT_NEAR(ticks, 400 + 500, 2);
}

TEST_P(EveryPass, ATickDoesNotAllocate) {
  const auto pass = make_pass(GetParam());
  Hand hand({0.0, 0.0, 0.0});
  const test::AllocationGuard guard;
  while (pass->state() == PassState::kRunning) {
    hand.move(pass->tick(device::DeviceReading{hand.mass.state()}, kDt).force);
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(TrajectoryPassTest, AppliedForceIsWhatTheHandPressesDown) {
  const auto pass = make_pass("recall");
  Hand hand({0.0, 0.0, 0.0});
  hand.push = -5.0;  // pressed on the plane, whose stiffness is 4 of 5 parts of what holds the hand
  const auto moments = run(*pass, hand);
  const auto running = of_stage(moments, Stage::kRun);
  EXPECT_NEAR(running[running.size() / 2].out.force.y(), 4.0, 0.05);
}

TEST(TrainingPassTest, EveryConditionHasAPassAndOthersAreRefused) {
  EXPECT_EQ(training_conditions(), (std::vector<std::string>{"haptic", "visual", "visuohaptic",
                                                             "watching", "playback", "both"}));
  for (const std::string& condition : training_conditions()) {
    EXPECT_NE(make_training_pass(condition, stimulus_of_study(), {}, 1), nullptr);
  }
  EXPECT_THROW(make_training_pass("olfactory", stimulus_of_study(), {}, 1), std::invalid_argument);
}

TEST(GuidanceTest, ParametersAreReadWithTheirBounds) {
  const std::string text =
      "force_limit = 9.0\napproach_speed = 0.05\nsettle_distance = 0.004\nwait = 1.0\n"
      "wait_timeout = 5.0\nrecovery = 2.0\ntrajectory = { stiffness = 900.0, damping = 100.0 }\n"
      "plane = { stiffness = 2000.0, damping = 300.0 }\n";
  Table good = Table::parse(text, "f.toml");
  const GuidanceParameters p = guidance_schema().read(good);
  EXPECT_NO_THROW(good.finish());
  EXPECT_EQ(p.plane.damping, 300.0);
  EXPECT_EQ(p.trajectory.stiffness, 900.0);
  EXPECT_EQ(p.wait_timeout, 5.0);
  std::string early = text;
  early.replace(early.find("5.0"), 3, "1.0");
  Table bad = Table::parse(early, "f.toml");
  guidance_schema().read(bad);
  try {
    bad.finish();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "f.toml:5: wait_timeout is 1; allowed: a number above wait, 1 [s]");
  }
}

}  // namespace
}  // namespace haptrial::protocols::trajectory_pass_test
