#include "experiments/runner/session.h"
#include "experiments/runner/session_opening.h"
#include "experiments/studies/curve_analysis.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "analysis/force_training/score/score.h"
#include "core/base/error.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/stimulus/stimulus.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_protocol.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using record::Phase;
using record::Sample;
using record::Stage;

record::SessionReader record_session(const protocols::ForceDefinition& definition,
                                     const std::filesystem::path& file, int trials,
                                     std::uint64_t seed = 1) {
  SessionRequest request =
      test::session_request(protocols::force_training(), definition, file, seed);
  request.max_trials = trials;
  run_session(request);
  return record::SessionReader(file);
}

bool same_samples(const record::SessionReader& a, const record::SessionReader& b) {
  const auto x = a.samples(0, a.sample_count());
  const auto y = b.samples(0, b.sample_count());
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const Sample& p, const Sample& q) {
    return p.sequence == q.sequence && p.time_ns == q.time_ns && p.position == q.position &&
           p.velocity == q.velocity && p.force == q.force && p.applied_force == q.applied_force &&
           p.target_force == q.target_force && p.pass == q.pass && p.stage == q.stage &&
           p.saturated == q.saturated;
  });
}

class SessionTest : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  protocols::ForceDefinition definition_ =
      protocols::load_force_definition(test::shipped_definition());
};

TEST_F(SessionTest, RecordsEveryTickAndEveryPass) {
  const auto reader = record_session(definition_, folder_ / "S01.h5", 4);
  const record::Integrity integrity = record::check_session(reader);
  EXPECT_TRUE(integrity.ok);
  EXPECT_EQ(integrity.gaps, 0u);
  EXPECT_EQ(integrity.passes, 8u);
  EXPECT_EQ(reader.timing_summary()->ticks, reader.sample_count());
  EXPECT_TRUE(reader.info().simulated);
  EXPECT_EQ(reader.info().definition, definition_.text);
}

TEST_F(SessionTest, TrialsFollowThePlan) {
  const auto reader = record_session(definition_, folder_ / "S01.h5", 6);
  const auto passes = reader.passes();
  ASSERT_EQ(passes.size(), 12u);
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const record::PassRow& pass = passes[i];
    EXPECT_EQ(pass.trial, static_cast<int>(i / 2) + 1);
    EXPECT_EQ(pass.phase, i % 2 == 0 ? Phase::kTraining : Phase::kTest);
    EXPECT_EQ(pass.block, static_cast<int>(i / 6) + 1);
    EXPECT_EQ(pass.repetition, static_cast<int>(i / 2) % 3 + 1);
    EXPECT_EQ(pass.condition, passes[i / 6 * 6].condition) << "a block has one condition";
    EXPECT_EQ(pass.stimulus_seed, passes[i / 6 * 6].stimulus_seed);
  }
  EXPECT_NE(passes[0].stimulus_seed, passes[6].stimulus_seed);
  EXPECT_NE(passes[0].condition, passes[6].condition);
}

TEST_F(SessionTest, TargetsComeFromTheStoredStimulus) {
  const auto reader = record_session(definition_, folder_ / "S01.h5", 1);
  const auto stimuli = reader.stimuli();
  const auto pass = reader.passes().at(1);
  const auto samples = reader.samples(pass.first_sample, pass.last_sample - pass.first_sample + 1);
  const double half_row = 0.5 / definition_.stimulus_rate + 1.0 / definition_.rate;
  double steepest = 1.0;  // [N/s]
  for (std::size_t i = 1; i < stimuli.size(); ++i) {
    const double slope = (stimuli[i].force - stimuli[i - 1].force) * definition_.stimulus_rate;
    steepest = std::max(steepest, std::abs(slope));
  }
  std::size_t compared = 0;
  double run_start = -1.0;
  for (const Sample& sample : samples) {
    if (sample.stage != Stage::kRun) {
      continue;
    }
    const double t = 1e-9 * static_cast<double>(sample.time_ns);
    run_start = run_start < 0.0 ? t : run_start;
    const auto row = static_cast<std::size_t>((t - run_start) * definition_.stimulus_rate + 0.5);
    if (row < stimuli.size()) {
      EXPECT_NEAR(sample.target_force, stimuli[row].force, steepest * half_row);
      ++compared;
    }
  }
  EXPECT_GT(compared, 5000u);
}

TEST_F(SessionTest, TheStoredStimulusReachesTheEndOfTheRun) {
  const auto reader = record_session(definition_, folder_ / "S01.h5", 1);
  const auto stimulus = stimulus::make_stimulus(definition_.trajectory, definition_.force_pattern,
                                                reader.passes().at(0).stimulus_seed);
  const auto rows = reader.stimuli();
  EXPECT_NEAR(rows.back().time, stimulus.path.duration(), 1e-9);
  EXPECT_EQ(rows.back().force, stimulus.force.at(stimulus.path.duration()));
  const double step = 1.0 / definition_.stimulus_rate;
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    ASSERT_NEAR(rows[i].time, static_cast<double>(i) * step, 1e-9);
  }
  EXPECT_GT(rows.back().time, rows[rows.size() - 2].time);
}

TEST_F(SessionTest, BreaksComeAgainAndAgainButNotAfterTheLastTrial) {
  const auto breaks = [&](int trials) {
    definition_.design.break_after = 3;
    const auto reader =
        record_session(definition_, folder_ / (std::to_string(trials) + ".h5"), trials);
    int count = 0;
    for (const record::EventRow& event : reader.events()) {
      count += event.kind == "break" ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(breaks(10), 3);
  EXPECT_EQ(breaks(9), 2);
}

TEST_F(SessionTest, AVirtualParticipantIsReadyAtOnce) {
  definition_.design.break_after = 2;
  definition_.design.break_until_ready = true;
  const auto reader = record_session(definition_, folder_ / "ready.h5", 5);
  std::vector<std::string> breaks;
  for (const record::EventRow& event : reader.events()) {
    if (event.kind == "break") {
      breaks.push_back(event.text);
    }
  }
  const std::string said = fmt::format("{} s, then until ready", definition_.design.break_duration);
  EXPECT_EQ(breaks, (std::vector<std::string>{said, said}));
  EXPECT_EQ(reader.passes().back().trial, 5);
}

TEST_F(SessionTest, TheFileSaysHowManyTrialsArePlannedOfHowMany) {
  const auto reader = record_session(definition_, folder_ / "S01.h5", 3);
  EXPECT_EQ(reader.events().front().text, "3 of 72 trials planned");
}

TEST_F(SessionTest, IsAFunctionOfDefinitionSubjectAndSeed) {
  const auto first = record_session(definition_, folder_ / "a.h5", 3);
  const auto again = record_session(definition_, folder_ / "b.h5", 3);
  const auto other = record_session(definition_, folder_ / "c.h5", 3, 2);
  EXPECT_TRUE(same_samples(first, again));
  EXPECT_FALSE(same_samples(first, other));
}

TEST_F(SessionTest, HandStaysInTheWorkspaceAndForcesInTheEnvelope) {
  const auto reader = record_session(definition_, folder_ / "S01.h5", 9);
  for (const Sample& sample : reader.samples(0, reader.sample_count())) {
    ASSERT_LE(sample.force.norm(), definition_.envelope.max_force * (1.0 + 1e-3));
    ASSERT_LE(sample.position.norm(), definition_.envelope.workspace_radius);
  }
}

TEST_F(SessionTest, IntegratorsAgree) {
  // CVODE with smooth friction against the exact step: two friction laws, one session.
  const auto exact = record_session(definition_, folder_ / "exact.h5", 1);
  protocols::ForceDefinition other = protocols::parse_force_definition(
      test::shipped_with("integrator", "integrator = \"cvode\""), "cvode.toml");
  const auto cvode = record_session(other, folder_ / "cvode.h5", 1);
  const auto pass = exact.passes().at(1);
  const auto pass_cvode = cvode.passes().at(1);
  const auto count = std::min(pass.last_sample - pass.first_sample,
                              pass_cvode.last_sample - pass_cvode.first_sample);
  const auto a = exact.samples(pass.first_sample, count);
  const auto b = cvode.samples(pass_cvode.first_sample, count);
  double squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    squares += (a[i].position - b[i].position).squaredNorm() / static_cast<double>(count);
  }
  EXPECT_LT(std::sqrt(squares), 5e-4);
}

class WithoutNoiseTest : public SessionTest, public testing::WithParamInterface<bool> {};

// Both devices are tried: the shipped one, and one without quantum and friction, whose forces are
// smooth.
INSTANTIATE_TEST_SUITE_P(IdealDevice, WithoutNoiseTest, testing::Bool());

TEST_P(WithoutNoiseTest, RecallIsNearPerfectInEveryCondition) {
  protocols::ForceDefinition quiet =
      protocols::parse_force_definition(test::shipped_without_noise(), "quiet.toml");
  if (GetParam()) {
    quiet.device.position_quantum = 0.0;
    quiet.hand.coulomb_friction = 0.0;
  }
  const auto reader = record_session(quiet, folder_ / "S01.h5", 9);
  std::map<std::string, int> tested;
  for (const record::PassRow& pass : reader.passes()) {
    if (pass.phase != Phase::kTest) {
      continue;
    }
    ASSERT_EQ(pass.status, record::PassStatus::kCompleted);
    analysis::ForceCurve target{quiet.rate, {}};
    analysis::ForceCurve applied{quiet.rate, {}};
    for (const Sample& s :
         reader.samples(pass.first_sample, pass.last_sample - pass.first_sample + 1)) {
      if (s.stage == Stage::kRun) {
        target.force.push_back(s.target_force);
        applied.force.push_back(s.applied_force);
      }
    }
    const auto score = analysis::score_recall(target, applied, curve_analysis_of(quiet).scoring);
    // 3 % of the pattern's range; what is left is the lag of muscle and posture.
    EXPECT_LT(score.rms_unaligned, 0.3) << pass.condition << " trial " << pass.trial;
    ++tested[pass.condition];
  }
  EXPECT_EQ(tested.size(), 3u);
}

TEST_F(SessionTest, InterruptedDryRunLeavesNothing) {
  std::atomic<bool> cancel{true};
  SessionRequest request =
      test::session_request(protocols::force_training(), definition_, folder_ / "S01.h5", 0);
  request.cancel = &cancel;
  EXPECT_THROW(run_session(request), RunError);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(SessionTest, NeverOverwrites) {
  record_session(definition_, folder_ / "S01.h5", 1);
  const auto size = std::filesystem::file_size(folder_ / "S01.h5");
  EXPECT_THROW(record_session(definition_, folder_ / "S01.h5", 1), InputError);
  EXPECT_EQ(std::filesystem::file_size(folder_ / "S01.h5"), size);
}

TEST_F(SessionTest, RealClockKeepsTheSameRecordShape) {
  const protocols::ForceDefinition brief =
      protocols::parse_force_definition(test::shipped_with("speed", "speed = 0.05"), "brief.toml");
  SessionRequest request =
      test::session_request(protocols::force_training(), brief, folder_ / "S01.h5", 0);
  request.clock = realtime::ClockKind::kReal;
  request.max_trials = 1;
  const SessionSummary summary = run_session(request);
  const record::SessionReader reader(request.file);
  EXPECT_TRUE(record::check_session(reader).ok);
  EXPECT_EQ(reader.sample_count(), summary.ticks);
  EXPECT_EQ(summary.dropped, 0u);
  EXPECT_EQ(reader.info().clock, "real");
  std::uint64_t timed = 0;
  for (const record::TimingRow& row : reader.timing()) {
    timed += row.compute_count;
  }
  EXPECT_EQ(timed, summary.ticks) << "every tick is in the compute histogram";
}

TEST(DeviceChangeTest, AnotherDeviceThanThatOfTheEarlierRunsIsSaid) {
  SessionRequest request;
  request.device.name = "haply";
  record::SessionInfo before;
  EXPECT_EQ(device_change(request, before), "") << "there is no earlier run";
  before.device = "haply";
  EXPECT_EQ(device_change(request, before), "");
  before.device = "mouse";
  EXPECT_EQ(device_change(request, before),
            "goes on with the device haply, though it began with mouse, which its file names");
}

}  // namespace
}  // namespace haptrial::experiments
