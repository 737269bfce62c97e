// Virtual participants of a session that was killed go on with what they carried over: the answer
// before, and what they had adapted to.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <csignal>

#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/recovery/session_resume.h"
#include "core/record/rows/trial_rows.h"
#include "core/subject/perceiver/two_rate.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/replaced.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::resumed_participant_test {
namespace {

namespace fs = std::filesystem;

class ResumedParticipantTest : public testing::Test {
 protected:
  void SetUp() override {
    if (test::kThreadSanitizer) {
      GTEST_SKIP() << "a thread sanitizer does not follow a fork of threads";
    }
  }
  void use(const std::string& definition) {
    test::write_text(folder_ / "study.toml", definition);
    experiment_ = load_experiment(folder_ / "study.toml");
  }
  SessionRequest request(const std::string& name, realtime::ClockKind clock, int trials) const {
    SessionRequest request = test::session_request(experiment_, folder_ / name, 7);
    request.max_trials = trials;
    request.clock = clock;
    return request;
  }
  void resume(const std::string& name, int trials) const {
    SessionRequest own = request(name, realtime::ClockKind::kReal, trials);
    own.resume = true;
    run_session(own);
    EXPECT_TRUE(record::check_session(record::SessionReader(folder_ / name), known_tables()).ok);
  }

  test::TemporaryFolder folder_;
  Experiment experiment_;
};

/// Without an answer before, the first interval wins; with one, always the other interval.
const char* const kAlternates = R"([experiment]
protocol = "trials"
name = "alternates"
[design]
participants = 1
[fields.pull]
type = "constant"
force = [0.0, "-$level", 0.0]
[intervals]
low = { level = 0.5 }
high = { level = 0.6 }
[[blocks]]
name = "only"
trials = 10
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 0.25 }
[response]
question = "Which pulled more?"
choices = [{ value = "first" }, { value = "second" }]
[observer]
decides = "largest"
bias_first = 5.0
repetition = -10.0
reaction = 0.05
[observer.actions]
feel = { do = "hold" }
)";

std::vector<double> answers_of(const record::SessionReader& file) {
  std::vector<double> answers;
  const auto passes = file.passes();
  for (const record::ResponseRow& row : file.responses()) {
    const auto pass = static_cast<std::size_t>(row.pass);
    // A kill may come between an answer and the row of its pass.
    if (pass < passes.size() && passes[pass].status == record::PassStatus::kCompleted) {
      answers.push_back(row.value);
    }
  }
  return answers;
}

TEST_F(ResumedParticipantTest, TheAnswerBeforeCounts) {
  constexpr int kTrials = 10;
  use(kAlternates);
  run_session(request("whole.h5", realtime::ClockKind::kSimulated, kTrials));
  const std::vector<double> whole = answers_of(record::SessionReader(folder_ / "whole.h5"));
  ASSERT_EQ(whole, (std::vector<double>{1, 2, 1, 2, 1, 2, 1, 2, 1, 2}));
  bool telling = false;
  for (std::uint64_t at = 1500; at < 6000 && !telling; at += 700) {  // a loaded machine is late
    const std::string name = "killed" + std::to_string(at) + ".h5";
    test::run_and_kill(request(name, realtime::ClockKind::kReal, kTrials), at);
    const auto before = answers_of(record::SessionReader(folder_ / (name + ".partial")));
    // A participant who has forgotten the answer "first" would give it again.
    telling = !before.empty() && before.back() == 1.0;
    resume(name, kTrials);
    EXPECT_EQ(answers_of(record::SessionReader(folder_ / name)), whole) << at;
  }
  EXPECT_TRUE(telling);
}

TEST_F(ResumedParticipantTest, AnAnswerWhosePassIsLostIsGivenAgain) {
  constexpr int kTrials = 4;
  use(kAlternates);
  test::run_and_kill(request("killed.h5", realtime::ClockKind::kReal, kTrials), 1500);
  {  // what a kill leaves between an answer and the samples of its pass
    record::Resumed found;
    auto writer = record::SessionWriter::resume(folder_ / "killed.h5", found, known_tables());
    record::ResponseRow lost;
    lost.pass = static_cast<std::int32_t>(found.passes.size() + found.open_passes.size());
    lost.question = "answer";
    lost.value = 2.0;
    writer.add_response(lost);
  }
  resume("killed.h5", kTrials);
  EXPECT_EQ(answers_of(record::SessionReader(folder_ / "killed.h5")),
            (std::vector<double>{1, 2, 1, 2}));
  EXPECT_TRUE(fs::exists(folder_ / "killed.h5.partial.damaged"));
}

TEST_F(ResumedParticipantTest, TheOrderOfAnotherParticipantIsRefused) {
  use(kAlternates);
  test::run_and_kill(request("killed.h5", realtime::ClockKind::kReal, 4), 1500);
  SessionRequest other = request("killed.h5", realtime::ClockKind::kReal, 4);
  other.resume = true;
  other.participant = 2;
  try {
    run_session(other);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("was recorded in the order of participant 1; "
                                                 "resume it with --participant 1, not 3"));
  }
  resume("killed.h5", 4);
}

std::string short_curl_field() {
  std::string text = test::read_text(HAPTRIAL_SOURCE_DIR "/experiments/curl_field.toml");
  text = test::replaced(text, "for = [0.3, 0.6]", "for = [0.02, 0.04]");
  text = test::replaced(text, "duration = 0.8", "duration = 0.25");
  text = test::replaced(text, "inside = \"start\", for = 0.2", "inside = \"start\", for = 0.02");
  text = test::replaced(text, "duration = 0.5 }", "duration = 0.3 }");
  text =
      test::replaced(text, "name = \"baseline\"\ntrials = 64", "name = \"baseline\"\ntrials = 2");
  return text;
}

/// For one process, x' = A x + B e: the error e that a step of it says.
double error_of(double before, double after, double retention, double learning) {
  return (after - retention * before) / learning;
}

TEST_F(ResumedParticipantTest, WhatWasLearntOfTheCurlFieldIsKept) {
  constexpr int kTrials = 9;
  use(short_curl_field());
  run_session(request("whole.h5", realtime::ClockKind::kSimulated, kTrials));
  test::run_and_kill(request("killed.h5", realtime::ClockKind::kReal, kTrials), 6000);
  const auto before =
      record::SessionReader(folder_ / "killed.h5.partial").rows<record::AdaptationRow>();
  ASSERT_GE(before.size(), 3u);
  ASSERT_LT(before.size(), static_cast<std::size_t>(kTrials));
  ASSERT_GT(before.back().fast + before.back().slow, 0.05) << "something had been learnt";
  resume("killed.h5", kTrials);
  const auto whole = record::SessionReader(folder_ / "whole.h5").rows<record::AdaptationRow>();
  const auto resumed = record::SessionReader(folder_ / "killed.h5").rows<record::AdaptationRow>();
  ASSERT_EQ(whole.size(), static_cast<std::size_t>(kTrials));
  ASSERT_EQ(resumed.size(), whole.size());
  // Both processes learn from the same error, so each step of them says the same one, also the
  // step from the last trial before the kill to the first one after it.
  const subject::TwoRateParameters p;
  for (std::size_t i = 1; i < resumed.size(); ++i) {
    const double fast =
        error_of(resumed[i - 1].fast, resumed[i].fast, p.fast.retention, p.fast.learning);
    const double slow =
        error_of(resumed[i - 1].slow, resumed[i].slow, p.slow.retention, p.slow.learning);
    EXPECT_NEAR(fast, slow, 1e-9) << "row " << i << " of " << before.size() << " before the kill";
  }
  // The hand begins at rest after a resume, so errors differ by little; forgetting all would show
  // as more than what was learnt.
  for (std::size_t i = before.size(); i < whole.size(); ++i) {
    EXPECT_NEAR(resumed[i].fast + resumed[i].slow, whole[i].fast + whole[i].slow,
                0.2 * (before.back().fast + before.back().slow))
        << i;
  }
}

}  // namespace
}  // namespace haptrial::experiments::resumed_participant_test
