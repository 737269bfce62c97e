// Training by an expert: who is watched, who leads the hand, and the test in which nobody does.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "protocols/force_training/recorded_pass.h"
#include "protocols/force_training/training_pass.h"
#include "protocols/force_training/trajectory_pass.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/free_mass.h"

namespace haptrial::protocols::expert_passes_test {
namespace {

using Eigen::Vector3d;
using record::Stage;
using stimulus::Instruction;

constexpr double kDt = 1e-3;

const stimulus::Stimulus& stimulus_of_study() {
  static const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 8);
  return stimulus;
}

struct Moment {
  std::uint64_t sequence{0};
  PointState tool;
  PassOutput out;
};

/// A hand in oil that resists along y; `held` stays where it is from the run on.
struct Hand {
  test::FreeMass mass{1.0,
                      {stimulus_of_study().path.points().front(), Vector3d::Zero()},
                      test::FreeMass::Rule::kSymplectic,
                      15.0};
  std::uint32_t buttons{0};
  std::uint32_t keys{0};
};

template <class During>
std::vector<Moment> run(TrajectoryPass& pass, During&& during) {
  Hand hand;
  std::vector<Moment> moments;
  pass.begin(100);
  while (pass.state() == PassState::kRunning && moments.size() < 200000) {
    const PointState tool = hand.mass.state();
    device::DeviceReading reading{tool};
    reading.buttons = hand.buttons;
    reading.keys = hand.keys;
    moments.push_back({100 + moments.size(), tool, pass.tick(reading, kDt)});
    const Vector3d own{0.0, -500.0 * tool.position.y() - 30.0 * tool.velocity.y(), 0.0};
    hand.mass.step(moments.back().out.force + own, kDt);
    during(moments.back(), hand);
  }
  return moments;
}

std::vector<record::TutoringRow> rows_of(ExpertLog& log) {
  std::vector<record::TutoringRow> rows;
  log.flush([&rows](std::span<const record::TutoringRow> some) {
    rows.insert(rows.end(), some.begin(), some.end());
  });
  return rows;
}

GuidanceParameters at_speed(double speed) {
  GuidanceParameters p;
  p.tutoring.speed = speed;
  return p;
}

/// A log that holds a whole pass.
std::unique_ptr<ExpertLog> large_log() { return std::make_unique<ExpertLog>(4096, 64); }

TEST(PlaybackTrainingTest, TheForceIsThatOfTheLawAtEverySpeed) {
  for (const double speed : {1.0, 0.5}) {
    const GuidanceParameters p = at_speed(speed);
    const auto pass = make_training_pass(kPlayback, stimulus_of_study(), p, 7);
    const auto log = large_log();
    pass->record_expert(*log);
    const auto moments = run(*pass, [](const Moment&, Hand&) {});
    ASSERT_EQ(pass->state(), PassState::kCompleted);
    const auto rows = rows_of(*log);
    const double duration = stimulus_of_study().path.duration();
    EXPECT_NEAR(static_cast<double>(rows.size()) * kDt, duration / speed, 0.01);
    int compared = 0;
    for (const record::TutoringRow& row : rows) {
      const Moment& m = moments.at(row.sequence - 100);
      ASSERT_EQ(m.out.stage, Stage::kRun);
      const PointState ideal = stimulus_of_study().path.at(row.time);
      ASSERT_LT((row.position - ideal.position).norm(), 1e-12);
      if (row.lead < 1.0 || m.out.saturated) {
        continue;
      }
      const Vector3d wanted = 80.0 * (ideal.position - m.tool.position) +
                              2.0 * (speed * ideal.velocity - m.tool.velocity) +
                              Vector3d(0.0, stimulus_of_study().force.at(row.time), 0.0);
      ASSERT_LT((m.out.force - wanted).norm(), 1e-9) << row.time;
      ASSERT_LT((row.played_force - wanted).norm(), 1e-9) << row.time;
      ++compared;
    }
    EXPECT_GT(compared, 4000);
  }
}

TEST(PlaybackTrainingTest, ItTakesTheLeadWithoutAStep) {
  const auto pass = make_training_pass(kWatchedPlayback, stimulus_of_study(), {}, 7);
  const auto moments = run(*pass, [](const Moment&, Hand&) {});
  for (std::size_t i = 1; i < moments.size(); ++i) {
    if (moments[i].out.stage == Stage::kRun) {
      EXPECT_LT((moments[i].out.force - moments[i - 1].out.force).norm(), 0.5) << i;
    }
  }
}

GuidanceParameters waiting_for_buttons() {
  GuidanceParameters p;
  p.tutoring.pause_buttons = 0b101;
  return p;
}

TEST(PlaybackTrainingTest, TheExpertWaitsForALostHandAndWhileAButtonOrKeyOfThePauseIsHeld) {
  const auto pass = make_training_pass(kPlayback, stimulus_of_study(), waiting_for_buttons(), 7);
  const auto log = large_log();
  pass->record_expert(*log);
  int ran = 0;
  const auto moments = run(*pass, [&ran](const Moment& m, Hand& hand) {
    ran += m.out.stage == Stage::kRun ? 1 : 0;
    hand.buttons = ran >= 1000 && ran < 1700 ? 4 : 2;  // the button between means nothing
    hand.keys = ran >= 2000 && ran < 2400 ? kPauseBit : 1;
    if (ran >= 3000 && ran < 6000) {  // it holds on to where it was
      hand.mass = test::FreeMass(1.0, {m.tool.position, Vector3d::Zero()},
                                 test::FreeMass::Rule::kSymplectic, 15.0);
    }
  });
  EXPECT_EQ(pass->state(), PassState::kCompleted);
  const auto rows = rows_of(*log);
  int waited = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const bool waits = rows[i].time == rows[i - 1].time;
    waited += waits ? 1 : 0;
    if ((i > 1081 && i < 1700) || (i > 2081 && i < 2400)) {
      ASSERT_TRUE(waits) << i;
    }
    const Vector3d step = moments.at(rows[i].sequence - 100).out.force -
                          moments.at(rows[i - 1].sequence - 100).out.force;
    EXPECT_LT(step.norm(), 0.1) << i;
    const Vector3d& hand = moments.at(rows[i].sequence - 100).tool.position;
    const Vector3d away = rows[i].position - hand;
    EXPECT_LT(std::hypot(away.x(), away.z()), 0.0308) << "it is hardly left farther behind";
  }
  EXPECT_GT(waited, 620 + 320 + 500);
}

TEST(PlaybackTrainingTest, AHandThatNeverComesEndsThePass) {
  GuidanceParameters p;
  p.pause_beyond = 0.001;
  p.run_timeout = 0.5;
  const auto pass = make_training_pass(kPlayback, stimulus_of_study(), p, 7);
  run(*pass, [](const Moment& m, Hand& hand) {
    if (m.out.stage == Stage::kRun) {
      hand.mass = test::FreeMass(1.0, {m.tool.position, Vector3d::Zero()},
                                 test::FreeMass::Rule::kSymplectic, 15.0);
    }
  });
  EXPECT_EQ(pass->state(), PassState::kAborted);
}

TEST(WatchingTrainingTest, TheHandRestsAndTheMarkerIsTheExpert) {
  const auto pass = make_training_pass(kWatching, stimulus_of_study(), {}, 7);
  const auto log = large_log();
  pass->record_expert(*log);
  const auto moments = run(*pass, [](const Moment&, Hand&) {});
  const Vector3d start = stimulus_of_study().path.points().front();
  const auto rows = rows_of(*log);
  ASSERT_GT(rows.size(), 5000u);
  for (const record::TutoringRow& row : rows) {
    const Moment& m = moments.at(row.sequence - 100);
    EXPECT_LT((m.tool.position - start).norm(), 0.003);
    EXPECT_EQ(row.lead, 0.0);
    EXPECT_TRUE(row.played_force.isZero(0.0));
    const auto seen = stimulus::presentation_of(m.out.shown);
    EXPECT_LT((seen.tool - row.position).norm(), 1e-9);
    EXPECT_EQ(seen.target_force, stimulus_of_study().force.at(row.time));
  }
}

TEST(FreeRecallTest, NothingPullsTheHandAlongThePathAndThePlaneCarriesIt) {
  GuidanceParameters p;
  p.free_recall = true;
  const auto pass = make_pass(kPlayback, record::Phase::kTest, stimulus_of_study(), p, 7);
  int ran = 0;
  const auto moments = run(*pass, [&ran](const Moment& m, Hand& hand) {
    ran += m.out.stage == Stage::kRun ? 1 : 0;
    if (ran == 1000) {  // somewhere else
      hand.mass = test::FreeMass(1.0, {{0.02, -0.001, 0.03}, {0.1, 0.0, 0.0}},
                                 test::FreeMass::Rule::kSymplectic, 15.0);
    }
  });
  EXPECT_EQ(pass->state(), PassState::kCompleted);
  int in_run = 0;
  for (const Moment& m : moments) {
    in_run += m.out.stage == Stage::kRun ? 1 : 0;
    if (m.out.stage != Stage::kRun || in_run < 600) {
      continue;
    }
    EXPECT_NEAR(m.out.force.x(), 0.0, 1e-9);
    EXPECT_NEAR(m.out.force.z(), 0.0, 1e-9);
    if (in_run == 1001) {
      EXPECT_NEAR(m.out.force.y(), 2000.0 * 0.001, 0.01);
    }
    EXPECT_FALSE(stimulus::presentation_of(m.out.shown).show_trajectory);
  }
  EXPECT_NEAR(in_run * kDt, stimulus_of_study().path.duration(), 0.01);
}

TEST(ExpertPassesTest, InstructionsAndPicturesFollowTheCondition) {
  struct Expected {
    const char* condition;
    Instruction instruction;
    bool path, bar;
  };
  for (const Expected& e : {Expected{kWatching, Instruction::kWatch, true, true},
                            Expected{kPlayback, Instruction::kFollow, false, false},
                            Expected{kWatchedPlayback, Instruction::kFollow, true, true}}) {
    const auto pass = make_training_pass(e.condition, stimulus_of_study(), {}, 7);
    PassMoment moment;
    moment.stage = Stage::kRun;
    moment.along = 3.0;
    const auto seen = pass->presentation(moment);
    EXPECT_EQ(seen.instruction, e.instruction) << e.condition;
    EXPECT_EQ(seen.show_trajectory, e.path) << e.condition;
    EXPECT_EQ(seen.show_target_bar, e.bar) << e.condition;
    EXPECT_FALSE(seen.show_applied_bar);
  }
}

TEST(ExpertPassesTest, WhatWasSeenFollowsFromTheRecordAlsoOverAPause) {
  GuidanceParameters waiting = waiting_for_buttons();
  waiting.tutoring.speed = 0.8;
  const auto pass = make_training_pass(kWatchedPlayback, stimulus_of_study(), waiting, 7);
  const auto log = large_log();
  pass->record_expert(*log);
  int ran = 0;
  const auto moments = run(*pass, [&ran](const Moment& m, Hand& hand) {
    ran += m.out.stage == Stage::kRun ? 1 : 0;
    hand.buttons = ran >= 1000 && ran < 1500 ? 1 : 0;
  });
  std::vector<record::Sample> samples;
  for (const Moment& m : moments) {
    record::Sample s;
    s.sequence = m.sequence;
    s.position = m.tool.position;
    s.stage = m.out.stage;
    s.target_force = m.out.target_force;
    samples.push_back(s);
  }
  const auto rows = rows_of(*log);
  const auto again = presentations(*pass, samples, 1000.0, rows);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const auto seen = stimulus::presentation_of(moments[i].out.shown);
    ASSERT_EQ(again[i].progress, seen.progress) << i;
    ASSERT_EQ(again[i].tool, seen.tool) << i;
  }
}

TEST(ExpertPassesTest, ATickDoesNotAllocate) {
  const auto pass = make_training_pass(kPlayback, stimulus_of_study(), {}, 7);
  const auto log = large_log();
  pass->record_expert(*log);
  pass->begin(0);
  const device::DeviceReading reading{
      {stimulus_of_study().path.points().front(), Vector3d::Zero()}};
  const test::AllocationGuard guard;
  for (int i = 0; i < 2000; ++i) {
    pass->tick(reading, kDt);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::protocols::expert_passes_test
