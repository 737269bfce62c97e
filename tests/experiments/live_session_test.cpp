// Sessions on the real clock with an experimenter who asks for things, and sessions that are
// killed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

#include "core/record/read/integrity.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"
#include "experiments/runner/session.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_protocol.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial::experiments {
namespace {

using record::PassRow;
using record::PassStatus;
using record::Phase;

class LiveSessionTest : public testing::Test {
 protected:
  LiveSessionTest() {
    request_.protocol = &protocols::force_training();
    request_.definition = &definition_;
    request_.subject = "P01";
    request_.clock = realtime::ClockKind::kReal;
    request_.file = folder_ / "P01.h5";
  }
  /// Does `then` once the session shows `what`.
  void when(const std::function<bool(const SessionStatus&)>& what, Request then) {
    test::wait_until([&] { return what(control_.status()); });
    control_.ask(then);
  }
  /// Sets the speed of a session in whose passes something is done.
  void run_at(double speed) {
    definition_ = protocols::parse_force_definition(
        test::shipped_with("speed", "speed = " + std::to_string(speed)), "slow.toml");
  }
  static std::function<bool(const SessionStatus&)> state(const std::string& name) {
    return [name](const SessionStatus& s) { return s.state == name; };
  }
  static bool runs(const SessionStatus& s) { return s.state == "running" && s.stage == "run"; }

  test::TemporaryFolder folder_;
  // Brisk passes, so that a test takes seconds.
  protocols::ForceDefinition definition_ =
      protocols::parse_force_definition(test::shipped_with("speed", "speed = 0.05"), "brisk.toml");
  SessionControl control_;
  SessionRequest request_;
};

TEST_F(LiveSessionTest, TrialsAreRepeatedSkippedAndEnded) {
  run_at(0.0005);
  request_.control = &control_;
  std::thread experimenter([this] {
    when(state("instructions"), Request::kStart);
    when(runs, Request::kRepeatTrial);
    when([](const SessionStatus& s) { return s.aborted_passes == 1 && runs(s); },
         Request::kSkipTrial);
    when([](const SessionStatus& s) { return s.trial == 2 && runs(s); }, Request::kEnd);
    control_.note("a note");
  });
  run_session(request_);
  experimenter.join();
  const record::SessionReader reader(request_.file);
  EXPECT_TRUE(record::check_session(reader).ok);
  const auto passes = reader.passes();
  ASSERT_EQ(passes.size(), 3u);
  for (const PassRow& pass : passes) {
    EXPECT_EQ(pass.status, PassStatus::kAborted);
    EXPECT_EQ(pass.phase, Phase::kTraining);
  }
  EXPECT_EQ(passes[0].attempt, 1);
  EXPECT_EQ(passes[1].trial, 1);
  EXPECT_EQ(passes[1].attempt, 2);
  EXPECT_EQ(passes[2].trial, 2);
}

/// The studio and people read its lines: a text must not pass for further ones.
TEST_F(LiveSessionTest, ATextOfSeveralLinesIsOneLineOfInfo) {
  request_.clock = realtime::ClockKind::kSimulated;
  request_.max_trials = 1;
  request_.person.identifier = "P01";
  request_.person.notes = "first\nnotice      at 1 s: faked\r\x1b[2Kend";
  run_session(request_);
  const test::CommandResult info =
      test::run_command("haptrial info '" + request_.file.string() + "'");
  EXPECT_THAT(info.output,
              testing::HasSubstr("notes       first notice      at 1 s: faked  [2Kend\n"));
}

TEST_F(LiveSessionTest, AnAbortedSessionGoesOnAndCanBeEndedForGood) {
  run_at(0.02);
  request_.control = &control_;
  request_.max_trials = 3;
  const auto ask_when = [](SessionControl& control, const auto& condition, Request request) {
    test::wait_until([&] { return condition(control.status()); });
    control.ask(request);
  };
  std::thread first([&] {
    ask_when(control_, state("instructions"), Request::kStart);
    ask_when(
        control_, [](const SessionStatus& s) { return s.trial == 2 && runs(s); }, Request::kAbort);
  });
  EXPECT_TRUE(run_session(request_).stopped);
  first.join();
  const std::filesystem::path partial = request_.file.string() + ".partial";
  ASSERT_TRUE(std::filesystem::exists(partial));
  EXPECT_FALSE(std::filesystem::exists(request_.file));
  std::uint64_t overruns = 0;
  {
    const record::SessionReader reader(partial);
    const record::Integrity integrity = record::check_session(reader);
    EXPECT_TRUE(integrity.ok) << testing::PrintToString(integrity.problems);
    EXPECT_EQ(integrity.state, record::RunState::kStopped);
    overruns = integrity.overruns;
    const record::TrialProgress progress = record::trial_progress(reader);
    EXPECT_EQ(progress.planned, 3);
    EXPECT_EQ(progress.done, 1);
    EXPECT_EQ(progress.aborted, 1);
  }

  SessionControl second_control;
  request_.control = &second_control;
  request_.resume = true;
  std::thread second([&] {
    ask_when(second_control, state("instructions"), Request::kStart);
    ask_when(
        second_control, [](const SessionStatus& s) { return s.trial == 3 && runs(s); },
        Request::kEnd);
  });
  EXPECT_FALSE(run_session(request_).stopped);
  second.join();
  EXPECT_FALSE(std::filesystem::exists(partial));
  const record::SessionReader reader(request_.file);
  const record::Integrity integrity = record::check_session(reader);
  EXPECT_TRUE(integrity.ok) << testing::PrintToString(integrity.problems);
  EXPECT_EQ(integrity.state, record::RunState::kEnded);
  EXPECT_GE(integrity.overruns, overruns);
  const record::TrialProgress progress = record::trial_progress(reader);
  EXPECT_EQ(progress.done, 2);
  EXPECT_EQ(progress.aborted, 1);
  const auto events = reader.events();
  const auto has = [&](const char* kind) {
    return std::any_of(events.begin(), events.end(),
                       [&](const auto& event) { return event.kind == kind; });
  };
  EXPECT_TRUE(has("session_stopped"));
  EXPECT_TRUE(has("session_resumed"));
  EXPECT_TRUE(has("ended_for_good"));
  // The trial that was aborted came again, as a second attempt.
  for (const PassRow& pass : reader.passes()) {
    if (pass.trial == 2 && pass.status == PassStatus::kCompleted) {
      EXPECT_EQ(pass.attempt, 2);
    }
  }
}

TEST_F(LiveSessionTest, WhoeverWatchesTheTerminalIsToldFromTheStartOn) {
  request_.max_trials = 1;
  std::vector<std::string> lines;
  request_.tell = [&](const std::string& line) {
    if (lines.empty() || line.starts_with("recording ")) {
      EXPECT_TRUE(std::filesystem::exists(folder_ / "P01.h5.partial")) << "before it is over";
    }
    lines.push_back(line);
  };
  const SessionSummary summary = run_session(request_);
  const auto plan = std::find_if(lines.begin(), lines.end(), [](const std::string& line) {
    return line.starts_with("recording ");
  });
  ASSERT_NE(plan, lines.end());
  EXPECT_EQ(*plan, "recording " + request_.file.string() + ": 1 of 72 trials planned");
  EXPECT_TRUE(std::any_of(plan, lines.end(), [](const std::string& line) {
    return line.starts_with("trial 1 of 1, ") && line.find(": completed, ") != std::string::npos;
  }));
  // Notices of the loop come before the first trial.
  for (const std::string& notice : summary.notices) {
    if (notice.find("CAP_") != std::string::npos) {
      EXPECT_LT(std::find(lines.begin(), lines.end(), "notice: " + notice), plan);
    }
  }
}

/// Killed between its end and the name of its file, it needs only the name.
TEST_F(LiveSessionTest, ASessionThatHadEndedIsOnlyClosed) {
  run_at(0.0005);
  request_.control = &control_;
  std::thread experimenter([this] {
    when(state("instructions"), Request::kStart);
    when(runs, Request::kEnd);
  });
  run_session(request_);
  experimenter.join();
  const std::filesystem::path partial = request_.file.string() + ".partial";
  std::filesystem::rename(request_.file, partial);
  request_.resume = true;
  request_.control = nullptr;
  const SessionSummary closed = run_session(request_);
  EXPECT_EQ(closed.ticks, 0u);
  ASSERT_EQ(closed.notices.size(), 1u);
  EXPECT_FALSE(std::filesystem::exists(partial));
  EXPECT_TRUE(record::check_session(record::SessionReader(request_.file)).ok);
}

TEST_F(LiveSessionTest, AnEmergencyStopStaysUntilItIsClearedAndTheTrialComesAgain) {
  run_at(0.0005);
  request_.control = &control_;
  std::thread experimenter([this] {
    when(state("instructions"), Request::kStart);
    when(runs, Request::kEmergencyStop);
    when(state("stopped"), Request::kStart);  // not enough: nobody has cleared the cause
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_EQ(control_.status().state, "stopped");
    control_.ask(Request::kClear);
    when(state("stopped"), Request::kStart);
    when([](const SessionStatus& s) { return s.aborted_passes == 1 && runs(s); }, Request::kEnd);
  });
  run_session(request_);
  experimenter.join();
  const record::SessionReader reader(request_.file);
  const auto passes = reader.passes();
  ASSERT_EQ(passes.size(), 2u);
  EXPECT_EQ(passes[1].trial, 1);
  EXPECT_EQ(passes[1].attempt, 2);
  // The samples from the last of the stopped pass to the first of the next have no force at all.
  const auto between =
      reader.samples(passes[0].last_sample, passes[1].first_sample - passes[0].last_sample);
  EXPECT_GT(between.size(), 20u) << "of 300 ms, in which a busy machine may hold up the loop";
  for (const record::Sample& sample : between) {
    ASSERT_EQ(sample.force.norm(), 0.0) << sample.sequence;
  }
}

TEST_F(LiveSessionTest, AKilledSessionGoesOnAtItsFirstUnfinishedTrial) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "a thread sanitizer does not follow a fork of threads";
  }
  run_at(0.02);
  request_.max_trials = 2;
  const pid_t child = fork();
  if (child == 0) {
    run_session(request_);
    _exit(0);
  }
  // Killed in the test pass of the second trial.
  const auto tests_done = [this] {
    try {
      const record::SessionReader reader(folder_ / "P01.h5.partial");
      const auto samples = reader.samples(0, reader.sample_count());
      return !samples.empty() && samples.back().pass == 3;
    } catch (const std::exception&) {
      return false;
    }
  };
  test::wait_until(tests_done);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  ASSERT_FALSE(std::filesystem::exists(request_.file));

  request_.resume = true;
  run_session(request_);
  const record::SessionReader reader(request_.file);
  const record::Integrity integrity = record::check_session(reader);
  EXPECT_TRUE(integrity.ok) << (integrity.problems.empty() ? "" : integrity.problems.front());
  EXPECT_EQ(integrity.gaps, 0u);
  std::vector<int> tested;
  std::uint64_t seed = 0;
  for (const PassRow& pass : reader.passes()) {
    if (pass.status == PassStatus::kCompleted) {
      seed = seed == 0 ? pass.stimulus_seed : seed;
      EXPECT_EQ(pass.stimulus_seed, seed) << "the stimulus of the block is the same as before";
      if (pass.phase == Phase::kTest) {
        tested.push_back(pass.trial);
      }
    }
  }
  EXPECT_EQ(tested, (std::vector<int>{1, 2}));
  // The pass that was killed says what it was, and the trial came again as a second attempt.
  const auto passes = reader.passes();
  ASSERT_EQ(passes.size(), 6u);
  EXPECT_EQ(passes[3].status, PassStatus::kAborted);
  EXPECT_EQ(passes[3].phase, Phase::kTest);
  EXPECT_EQ(passes[3].trial, 2);
  EXPECT_EQ(passes[3].attempt, 1);
  EXPECT_EQ(passes[3].condition, passes[2].condition);
  EXPECT_EQ(passes[4].attempt, 2);
  EXPECT_EQ(passes[5].attempt, 2);
}

}  // namespace
}  // namespace haptrial::experiments
