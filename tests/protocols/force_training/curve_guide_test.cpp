// A pass at the participant's own pace.

#include "protocols/force_training/curve_guide.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "protocols/force_training/recorded_pass.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::protocols::curve_guide_test {
namespace {

using Eigen::Vector3d;
using record::Phase;
using record::Stage;

constexpr double kDt = 1e-3;

const stimulus::Stimulus& stimulus_of_study() {
  static const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  return stimulus;
}

GuidanceParameters own_pace() {
  GuidanceParameters p;
  p.kind = Guidance::kCurve;
  return p;
}

std::unique_ptr<TrajectoryPass> pass_of(const std::string& condition, Phase phase,
                                        const GuidanceParameters& parameters = own_pace()) {
  return make_pass(condition, phase, stimulus_of_study(), parameters, 3);
}

struct Moment {
  PointState tool;
  PassOutput out;
};

/// A hand that is where `place` says: waits at the start, then is at an arc position of the path
/// as a function of the time since the run began, plus an offset.
std::vector<Moment> run(TrajectoryPass& pass, const std::function<double(double)>& arc_at,
                        const Vector3d& offset = Vector3d::Zero(), int most_ticks = 100000) {
  const stimulus::SpatialTrajectory& path = stimulus_of_study().path;
  std::vector<Moment> moments;
  double time = 0.0;
  Vector3d before = path.points().front();
  bool running = false;
  while (pass.state() == PassState::kRunning && static_cast<int>(moments.size()) < most_ticks) {
    PointState tool{path.points().front(), Vector3d::Zero()};
    if (running) {
      time += kDt;
      tool.position = path.at(arc_at(time) / path.speed()).position + offset;
      tool.velocity = (tool.position - before) / kDt;
    }
    before = tool.position;
    moments.push_back({tool, pass.tick(device::DeviceReading{tool}, kDt)});
    running = moments.back().out.stage == Stage::kRun;
  }
  return moments;
}

std::vector<Moment> of_run(const std::vector<Moment>& all) {
  std::vector<Moment> runs;
  for (const Moment& m : all) {
    if (m.out.stage == Stage::kRun) {
      runs.push_back(m);
    }
  }
  return runs;
}

double arc_of(const Moment& m) {
  return stimulus::presentation_of(m.out.shown).progress * stimulus_of_study().path.length();
}

TEST(CurveGuideTest, TheForceBelongsToThePlaceAtAnyPace) {
  const double length = stimulus_of_study().path.length();
  for (const double speed : {0.008, 0.016, 0.05}) {
    const auto pass = pass_of("visual", Phase::kTraining);
    const auto moments = of_run(run(*pass, [&](double t) { return speed * t; }));
    ASSERT_EQ(pass->state(), PassState::kCompleted);
    EXPECT_NEAR(static_cast<double>(moments.size()) * kDt, length / speed, 0.001 / speed);
    for (std::size_t i = 1; i < moments.size(); ++i) {
      const double arc = speed * kDt * static_cast<double>(i);
      ASSERT_NEAR(arc_of(moments[i]), arc, 1e-5) << speed;
      const double wanted = stimulus_of_study().force.at(arc / stimulus_of_study().path.speed());
      ASSERT_NEAR(moments[i].out.target_force, wanted, 0.02) << speed;
      ASSERT_EQ(stimulus::presentation_of(moments[i].out.shown).target_force,
                moments[i].out.target_force);
    }
  }
}

TEST(CurveGuideTest, AHandThatRestsIsLeftWhereItIs) {
  const auto pass = pass_of("visual", Phase::kTest);
  const auto moments = of_run(run(
      *pass, [](double t) { return std::min(t, 2.0) * 0.016; }, Vector3d::Zero(), 10000));
  ASSERT_EQ(pass->state(), PassState::kRunning) << "the pace is the participant's";
  EXPECT_NEAR(arc_of(moments.back()), 0.032, 1e-5);
  EXPECT_LT(moments.back().out.force.norm(), 1e-6);
}

TEST(CurveGuideTest, ItHoldsAcrossThePathAndIsFreeAlongIt) {
  const auto pass = pass_of("visual", Phase::kTraining);
  const Vector3d aside(0.0, -0.001, 0.0);
  for (const Moment& m : of_run(run(
           *pass, [](double t) { return 0.03 * t; }, aside))) {
    const auto& seen = stimulus::presentation_of(m.out.shown);
    ASSERT_NEAR(seen.direction.norm(), 1.0, 1e-9);
    ASSERT_LT(std::abs(m.out.force.dot(seen.direction)), 0.02 * (1.0 + m.out.force.norm()))
        << "moving along it costs nothing";
    if (m.tool.velocity.y() == 0.0 && m.tool.position.y() < 0.0) {
      ASSERT_NEAR(m.out.force.y(), 2000.0 * 0.001, 1e-6) << "the plane holds";
    }
  }
  // The hand is in the plane, beside the path.
  GuidanceParameters gains = own_pace();
  gains.trajectory = {900.0, 0.0};
  const auto other = pass_of("visual", Phase::kTraining, gains);
  int seen = 0;
  for (const Moment& m : of_run(run(
           *other, [](double t) { return 0.016 * t; }, Vector3d(0.0, 0.0, 3e-4)))) {
    const Vector3d across =
        Vector3d(0.0, 0.0, 3e-4) - stimulus::presentation_of(m.out.shown).direction.z() * 3e-4 *
                                       stimulus::presentation_of(m.out.shown).direction;
    // While the path is straight, the spring sees the offset across it.
    if (std::abs(across.norm() - m.out.force.norm() / 900.0) < 2e-5) {
      ++seen;
    }
  }
  EXPECT_GT(seen, 5000);
}

TEST(CurveGuideTest, HapticTrainingPushesWithTheForceOfThePlace) {
  const auto pass = pass_of("haptic", Phase::kTraining);
  for (const Moment& m : of_run(run(*pass, [](double t) { return 0.01 * t * t; }))) {
    if (!m.out.saturated) {
      ASSERT_EQ(m.out.force.y(), m.out.target_force);
    }
  }
  EXPECT_EQ(pass->state(), PassState::kCompleted);
}

TEST(CurveGuideTest, AHandMayGoBack) {
  const auto pass = pass_of("visual", Phase::kTraining);
  const auto there_and_back = [](double t) {
    return t < 3.0 ? 0.016 * t : t < 4.0 ? 0.048 - 0.016 * (t - 3.0) : 0.032 + 0.016 * (t - 4.0);
  };
  const auto moments = of_run(run(*pass, there_and_back));
  ASSERT_EQ(pass->state(), PassState::kCompleted);
  EXPECT_NEAR(arc_of(moments[3000]), 0.048, 1e-4);
  EXPECT_NEAR(arc_of(moments[4000]), 0.032, 1e-4);
  EXPECT_NEAR(moments[3500].out.target_force, moments[2500].out.target_force, 0.02)
      << "the same place, the same force";
}

TEST(CurveGuideTest, WhoeverNeverArrivesIsLetGo) {
  GuidanceParameters p = own_pace();
  p.run_timeout = 4.0;
  const auto pass = pass_of("haptic", Phase::kTraining, p);
  const auto moments = of_run(run(*pass, [](double t) { return 0.001 * t; }));
  EXPECT_EQ(pass->state(), PassState::kAborted);
  EXPECT_NEAR(static_cast<double>(moments.size()) * kDt, 4.0, 3 * kDt);
}

TEST(CurveGuideTest, ItIsSaidWhoSetsThePace) {
  const auto pass = pass_of("visuohaptic", Phase::kTraining);
  for (const Moment& m : run(*pass, [](double t) { return 0.03 * t; })) {
    ASSERT_EQ(stimulus::presentation_of(m.out.shown).self_paced, m.out.stage == Stage::kRun);
  }
  const auto timed = pass_of("visuohaptic", Phase::kTraining, {});
  for (const Moment& m : run(*timed, [](double t) { return 0.016 * t; })) {
    ASSERT_FALSE(stimulus::presentation_of(m.out.shown).self_paced);
    ASSERT_TRUE(stimulus::presentation_of(m.out.shown).direction.isZero(0.0));
  }
}

TEST(CurveGuideTest, AReplayFindsThePlacesAgain) {
  const auto pass = pass_of("visuohaptic", Phase::kTraining);
  const auto moments = run(*pass, [](double t) { return 0.02 * t + 0.003 * std::sin(3.0 * t); });
  std::vector<record::Sample> samples;
  for (const Moment& m : moments) {
    record::Sample s;
    s.position = m.tool.position;
    s.velocity = m.tool.velocity;
    s.stage = m.out.stage;
    s.target_force = m.out.target_force;
    s.applied_force = m.out.force.y();
    s.saturated = m.out.saturated;
    samples.push_back(s);
  }
  const auto again = pass_of("visuohaptic", Phase::kTraining);
  const auto seen = presentations(*again, samples, 1.0 / kDt);
  ASSERT_EQ(seen.size(), moments.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const stimulus::Presentation& lived = stimulus::presentation_of(moments[i].out.shown);
    ASSERT_EQ(seen[i].progress, lived.progress) << i;
    ASSERT_EQ(seen[i].self_paced, lived.self_paced);
    ASSERT_EQ(seen[i].direction, lived.direction);
    ASSERT_EQ(seen[i].target_force, lived.target_force);
    ASSERT_EQ(seen[i].instruction, lived.instruction);
  }
}

TEST(CurveGuideTest, ATickDoesNotAllocate) {
  const auto pass = pass_of("haptic", Phase::kTraining);
  const Vector3d start = stimulus_of_study().path.points().front();
  const test::AllocationGuard guard;
  for (int i = 0; i < 5000 && pass->state() == PassState::kRunning; ++i) {
    const Vector3d moved(std::max(0, i - 1000) * 1.6e-5, 0.0, 0.0);
    pass->tick(device::DeviceReading{start + moved, Vector3d(0.016, 0.0, 0.0)}, kDt);
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(CurveGuideTest, TheKindOfGuidanceIsRead) {
  const std::string text =
      "force_limit = 9.0\napproach_speed = 0.05\nsettle_distance = 0.004\nwait = 1.0\n"
      "wait_timeout = 5.0\nrecovery = 2.0\ntrajectory = { stiffness = 900.0, damping = 100.0 }\n"
      "plane = { stiffness = 2000.0, damping = 300.0 }\n";
  const auto read = [](const std::string& from) {
    Table table = Table::parse(from, "f.toml");
    const GuidanceParameters p = guidance_schema().read(table);
    table.finish();
    return p;
  };
  EXPECT_EQ(read(text).kind, Guidance::kTrajectory);
  EXPECT_EQ(read("kind = \"trajectory\"\n" + text).kind, Guidance::kTrajectory);
  const std::string curve =
      "kind = \"curve\"\nrun_timeout = 60.0\n"
      "curve = { step = 0.002, reach = 0.004, margin = 0.0 }\n" +
      text;
  EXPECT_EQ(read(curve).kind, Guidance::kCurve);
  EXPECT_EQ(read(curve).curve.reach, 0.004);
  const auto problem = [&](const std::string& from) -> std::string {
    try {
      read(from);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(problem("kind = \"rail\"\n" + text),
              testing::HasSubstr("kind is 'rail'; allowed: trajectory, curve"));
  EXPECT_THAT(problem("kind = \"curve\"\n" + text), testing::HasSubstr("run_timeout is missing"));
  EXPECT_THAT(problem("run_timeout = 60.0\n" + text), testing::HasSubstr("not a known key"));
  std::string small = curve;
  small.replace(small.find("0.004"), 5, "0.001");
  EXPECT_THAT(problem(small), testing::HasSubstr("curve.reach is 0.001; allowed: "));
}

}  // namespace
}  // namespace haptrial::protocols::curve_guide_test
