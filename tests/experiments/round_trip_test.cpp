// A session on the real clock, driven again by its own recording.

#include <gtest/gtest.h>

#include "analysis/force_training/study/study.h"
#include "core/base/error.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/table/schema.h"
#include "experiments/runner/session.h"
#include "experiments/studies/curve_analysis.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_protocol.h"
#include "tests/experiments/command.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

/// Which samples have no gap of the loop so short a time before them that the force still ramps in
/// anew. A busy machine makes such gaps, and not the same ones twice.
std::vector<bool> without_gaps(const std::vector<record::Sample>& rows) {
  constexpr double kGap = 0.04;   // the session's own is 0.05 [s]
  constexpr double kRamp = 0.25;  // the shipped device's is 0.2 [s]
  std::vector<bool> good(rows.size(), true);
  std::int64_t since = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    if (1e-9 * static_cast<double>(rows[k].time_ns - rows[k - 1].time_ns) > kGap) {
      since = rows[k].time_ns;
    }
    good[k] = since == 0 || 1e-9 * static_cast<double>(rows[k].time_ns - since) > kRamp;
  }
  return good;
}

class RoundTripTest : public testing::Test {
 protected:
  fs::path run(const std::string& folder, const DeviceChoice& device,
               realtime::ClockKind clock = realtime::ClockKind::kReal) {
    fs::create_directories(folder_ / folder);
    SessionRequest request = test::session_request(protocols::force_training(), definition_,
                                                   folder_ / folder / "P01.h5", 0, "P01");
    request.clock = clock;
    request.max_trials = 1;
    request.device = device;
    run_session(request);
    return request.file;
  }

  test::TemporaryFolder folder_;
  protocols::ForceDefinition definition_ =
      protocols::parse_force_definition(test::shipped_with("speed", "speed = 0.05"), "brisk.toml");
};

TEST_F(RoundTripTest, ARecordedSessionDrivenAgainGivesTheSameForcesAndScores) {
  const fs::path live = run("live", {"virtual"});
  const fs::path again = run("again", {"replay:" + live.string()});
  const record::SessionReader a(live);
  const record::SessionReader b(again);
  EXPECT_TRUE(record::check_session(b).ok);
  EXPECT_TRUE(b.info().simulated);

  // The file rounds velocities, which the damping of the guidance turns into forces.
  const double damping =
      definition_.guidance.plane.damping + definition_.guidance.trajectory.damping;
  const double rounding = damping * record::kVelocityResolution + 2.0 * record::kForceResolution;
  std::size_t compared = 0;
  std::size_t all = 0;
  const auto passes = a.passes();
  const auto passes_again = b.passes();
  ASSERT_EQ(passes.size(), 2u);
  ASSERT_EQ(passes_again.size(), 2u);
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const auto rows =
        a.samples(passes[i].first_sample, passes[i].last_sample - passes[i].first_sample + 1);
    const auto rows_again =
        b.samples(passes_again[i].first_sample,
                  passes_again[i].last_sample - passes_again[i].first_sample + 1);
    EXPECT_EQ(passes_again[i].status, record::PassStatus::kCompleted);
    ASSERT_EQ(rows.size(), rows_again.size()) << "pass " << i;
    const std::vector<bool> good = without_gaps(rows);
    const std::vector<bool> good_again = without_gaps(rows_again);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      ASSERT_EQ(rows[k].position, rows_again[k].position) << "pass " << i << ", sample " << k;
      if (good[k] && good_again[k]) {
        ++compared;
        ASSERT_LT((rows[k].force - rows_again[k].force).norm(), rounding) << i << ", " << k;
      }
    }
    all += rows.size();
  }
  EXPECT_GT(compared, all / 4);
  if (compared < all) {
    return;  // nor are the scores the same
  }

  const auto score = [this](const fs::path& file) {
    return analysis::analyze_study({file}, curve_analysis_of(definition_).scoring, 1).scores;
  };
  const auto scores = score(live);
  const auto scores_again = score(again);
  ASSERT_EQ(scores.size(), 1u);
  ASSERT_EQ(scores_again.size(), 1u);
  for (std::size_t i = 0; i < scores.size(); ++i) {
    EXPECT_GT(scores[i].score, 0.1);
    EXPECT_NEAR(scores_again[i].score, scores[i].score, rounding);
    EXPECT_NEAR(scores_again[i].rms_force, scores[i].rms_force, rounding);
  }
}

TEST_F(RoundTripTest, ARecordingOfAnotherRateIsRefused) {
  const fs::path live = run("live", {"virtual"}, realtime::ClockKind::kSimulated);
  definition_ =
      protocols::parse_force_definition(test::shipped_with("rate", "rate = 2000.0"), "fast.toml");
  try {
    run("again", {"replay:" + live.string()});
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("recorded at 1000 Hz"), std::string::npos)
        << error.what();
  }
}

const char* const kQuestion = R"([experiment]
protocol = "trials"
name = "felt"
[design]
participants = 2
[[stages]]
name = "feel"
until = { time = 0.1 }
[response]
question = "Felt?"
choices = [{ value = "yes" }, { value = "no" }]
[[blocks]]
name = "one"
trials = 1
[observer]
decides = "yes"
)";

/// Nobody would answer, and the session would wait for ever.
TEST_F(RoundTripTest, ARecordingWhoseAnswersTheHandDidNotGiveIsRefused) {
  const std::string study = (folder_ / "felt.toml").string();
  const std::string out = (folder_ / "out").string();
  test::write_text(study, kQuestion);
  ASSERT_EQ(test::run_command("haptrial dry-run " + study + " --subjects 1 --out " + out).status,
            0);
  const auto again =
      test::run_command("haptrial run " + study + " --subject S01 --device replay:" + out +
                        "/S01.h5 --out " + out + "/again");
  EXPECT_EQ(again.status, 2);
  EXPECT_NE(again.errors.find("S01.h5: the answer 'answer' of trial 1 was not given by the hand"),
            std::string::npos)
      << again.errors;
}

}  // namespace
}  // namespace haptrial::experiments
