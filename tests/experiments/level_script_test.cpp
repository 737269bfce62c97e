// Sessions whose levels a script chooses: what it asks for is presented, and a script that dies,
// hangs or fails leaves the session to the definition.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/trial_rows.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "protocols/interface/recorded_definition.h"
#include "protocols/psychophysics/sequence/scripted_levels.h"
#include "tests/experiments/command.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::level_script_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::SizeIs;

/// 10 N/m more in every trial of a track. Keeps what it was asked; does `mischief` first.
std::string ladder(const std::string& mischief = "") {
  return "import json, os, signal, sys, time\n"
         "for line in sys.stdin:\n"
         "    q = json.loads(line)\n"
         "    with open('asked', 'a') as kept:\n"
         "        kept.write(line)\n"
         "    n = sum(1 for _ in open('asked'))\n" +
         mischief + "    print(json.dumps({'level': q['low'] + 10 * (1 + len(q['history']))}))\n";
}

class LevelScriptSessionTest : public testing::Test {
 protected:
  LevelScriptSessionTest() {
    std::string text =
        test::read_text(fs::path(HAPTRIAL_SOURCE_DIR "/experiments/stiffness_discrimination.toml"));
    put(text, "until = { time = 2.5 }", "until = { time = 0.6 }");
    put(text, "until = { inside = \"start\", for = 0.3 }",
        "until = { inside = \"start\", for = 0.02 }");
    put(text, "until = { time = 0.5 }", "until = { time = 0.02 }");
    put(text, "trials = 4\nlevel", "trials = 1\nlevel");
    put(text, "rise = 0.5", "rise = 0.1");
    put(text, "decides = \"largest\"", "decides = \"largest\"\nreaction = 0.05");
    test::write_text(folder_ / "study.toml",
                     text + "\n[level_script]\nfile = \"levels.py\"\ndeadline = 3.0\n");
  }
  static void put(std::string& text, const std::string& what, const std::string& instead) {
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), instead);
  }
  void run(const std::string& script, const std::string& name, int trials,
           realtime::ClockKind clock = realtime::ClockKind::kSimulated, bool resume = false) {
    test::write_text(folder_ / "levels.py", script);
    const Experiment experiment = load_experiment(folder_ / "study.toml");
    SessionRequest request = test::session_request(experiment, folder_ / name, 7);
    request.max_trials = trials;
    request.clock = clock;
    request.resume = resume;
    run_session(request);
  }
  /// The levels that each track asked for, in order.
  std::map<std::string, std::vector<double>> asked_in(const std::string& name) const {
    std::map<std::string, std::vector<double>> asked;
    const record::SessionReader file(folder_ / name);
    for (const record::LevelRow& row : file.rows<record::LevelRow>()) {
      asked[row.track].push_back(row.asked);
    }
    return asked;
  }
  std::vector<std::string> events_of(const std::string& name, const char* kind) const {
    std::vector<std::string> texts;
    for (const record::EventRow& event : record::SessionReader(folder_ / name).events()) {
      if (event.kind == kind) {
        texts.push_back(event.text);
      }
    }
    return texts;
  }
  std::vector<nlohmann::json> questions() const {
    std::vector<nlohmann::json> all;
    std::istringstream lines(test::read_text(folder_ / "asked"));
    for (std::string line; std::getline(lines, line);) {
      all.push_back(nlohmann::json::parse(line));
    }
    return all;
  }
  test::TemporaryFolder folder_;
};

TEST_F(LevelScriptSessionTest, ItsLevelsArePresentedAndItsTextIsKept) {
  run(ladder(), "S01.h5", 8);
  std::size_t levels = 0;
  for (const auto& [track, asked] : asked_in("S01.h5")) {
    for (std::size_t i = 0; i < asked.size(); ++i, ++levels) {
      EXPECT_DOUBLE_EQ(asked[i], 305.0 + 10.0 * static_cast<double>(i + 1)) << track;
    }
  }
  EXPECT_EQ(levels, 8u);
  EXPECT_THAT(events_of("S01.h5", protocols::kLevelScriptEvent), testing::ElementsAre(ladder()));
  EXPECT_THAT(events_of("S01.h5", protocols::kScriptTrouble), SizeIs(0));
}

TEST_F(LevelScriptSessionTest, AnotherOneThanThePlansIsADeviation) {
  const auto command = [this](const std::string& arguments) {
    const auto done =
        test::run_command("cd '" + folder_.path().string() + "' && haptrial " + arguments);
    EXPECT_EQ(done.status, 0) << done.errors;
  };
  const auto deviations = [&](const std::string& out) {
    command("dry-run study.toml --subjects 1 --trials 2 --out " + out);
    command("analyze " + out);
    return test::read_text(folder_ / out / "report.md");
  };
  const auto changed = HasSubstr("the script of levels was another one (SHA-256 ");
  test::write_text(folder_ / "levels.py", ladder());
  command("plan study.toml");
  EXPECT_THAT(deviations("same"), testing::Not(changed));
  test::write_text(folder_ / "levels.py", ladder("    n += 1\n"));
  EXPECT_THAT(deviations("other"), changed);
}

/// Each misfortune comes once; the trial has the level that the script was told the procedure
/// proposes.
TEST_F(LevelScriptSessionTest, KilledHangingAndThrowingItLeavesALiveSessionToTheDefinition) {
  run(ladder("    if n == 3:\n        os.kill(os.getpid(), signal.SIGKILL)\n"
             "    if n == 5:\n        time.sleep(1000)\n"
             "    if n == 7:\n        raise ValueError('no such level')\n"),
      "S01.h5", 9, realtime::ClockKind::kReal);
  const auto asked = questions();
  ASSERT_THAT(asked, SizeIs(10)) << "nine trials, and what would come then";
  std::map<std::string, std::vector<double>> wanted;
  for (std::size_t i = 0; i < 9; ++i) {
    const bool own = i == 2 || i == 4 || i == 6;
    wanted[asked[i]["track"]].push_back(
        own ? asked[i]["proposed"].get<double>()
            : 305.0 + 10.0 * static_cast<double>(1 + asked[i]["history"].size()));
  }
  EXPECT_EQ(asked_in("S01.h5"), wanted);
  const auto troubles = events_of("S01.h5", protocols::kScriptTrouble);
  ASSERT_THAT(troubles, SizeIs(3));
  EXPECT_THAT(troubles[0], HasSubstr("trial 3: levels.py: it ended with no level"));
  EXPECT_THAT(troubles[1], HasSubstr("trial 5: levels.py: it gave no level within 3 s"));
  EXPECT_THAT(troubles[2], HasSubstr("ValueError: no such level"));
  const record::SessionReader file(folder_ / "S01.h5");
  for (const record::PassRow& pass : file.passes()) {
    EXPECT_EQ(pass.status, record::PassStatus::kCompleted);
  }
}

TEST_F(LevelScriptSessionTest, ThatItGivesNoLevelIsSaidAtTheFirstTrial) {
  run("import sys\nfor line in sys.stdin:\n    sys.exit('no level today')\n", "S01.h5", 3);
  std::vector<std::string> kinds;
  for (const record::EventRow& event : record::SessionReader(folder_ / "S01.h5").events()) {
    if (event.kind == protocols::kScriptTrouble || event.kind == "notice") {
      kinds.push_back(event.kind + ": " + event.text.substr(0, event.text.find(':')));
    }
  }
  EXPECT_THAT(kinds, testing::ElementsAre("level_script_failed: trial 1", "notice: trial 1",
                                          "level_script_failed: trial 2",
                                          "level_script_failed: trial 3", "notice: levels.py"));
}

TEST_F(LevelScriptSessionTest, AResumedSessionAsksNothingAgainAndTakesNoOtherScript) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "a thread sanitizer does not follow a fork of threads";
  }
  const std::string script = ladder(
      "    if n == 6 and os.path.exists('kill'):\n        os.kill(os.getppid(), signal.SIGKILL)\n");
  run(script, "whole.h5", 8);
  fs::remove(folder_ / "asked");
  test::write_text(folder_ / "kill", "");
  const pid_t session = fork();
  ASSERT_GE(session, 0);
  if (session == 0) {
    run(script, "parts.h5", 8, realtime::ClockKind::kReal);  // the file is some trials behind
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(session, &status, 0), session);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the script kills its session at the sixth trial";
  fs::remove(folder_ / "kill");
  EXPECT_THROW(run(script + "\n", "parts.h5", 8, realtime::ClockKind::kSimulated, true),
               InputError);
  EXPECT_THAT(questions(), SizeIs(6));
  run(script, "parts.h5", 8, realtime::ClockKind::kSimulated, true);
  const auto asked = questions();
  std::set<int> trials;
  for (const nlohmann::json& each : asked) {
    trials.insert(each["trial"].get<int>());
  }
  EXPECT_GE(trials.size(), 8u);
  EXPECT_LE(asked.size(), 11u) << "what was presented before the kill and is in the file is known";
  EXPECT_EQ(asked_in("parts.h5"), asked_in("whole.h5"));
  EXPECT_THAT(events_of("parts.h5", protocols::kLevelScriptEvent), SizeIs(1));
}

TEST_F(LevelScriptSessionTest, TheWorkedScriptComesToTheThreshold) {
  run(test::read_text(HAPTRIAL_SOURCE_DIR "/docs/worked/python/levels.py"), "S01.h5", 60);
  EXPECT_THAT(events_of("S01.h5", protocols::kScriptTrouble), SizeIs(0));
  for (const auto& [track, asked] : asked_in("S01.h5")) {
    ASSERT_GT(asked.size(), 20u);
    EXPECT_GT(asked.back(), 306.0) << track;
    EXPECT_LT(asked.back(), 420.0) << "its virtual participant tells 7 % of a force apart";
  }
  const test::CommandResult report =
      test::run_command("cd '" + folder_.path().string() +
                        "' && mkdir study && mv S01.h5 study && haptrial analyze study");
  EXPECT_EQ(report.status, 0) << report.errors;
}

TEST_F(LevelScriptSessionTest, MistakesGetASentence) {
  const auto refusal = [&](const std::string& script, const std::string& rest) {
    std::string text = test::read_text(folder_ / "study.toml");
    put(text, "file = \"levels.py\"\ndeadline = 3.0", rest);
    test::write_text(folder_ / "wrong.toml", text);
    test::write_text(folder_ / "levels.py", script);
    const test::CommandResult result =
        test::run_command("haptrial validate '" + (folder_ / "wrong.toml").string() + "'");
    EXPECT_EQ(result.status, 2);
    return result.errors;
  };
  EXPECT_THAT(refusal("", "file = \"levels.py\""), HasSubstr("holds 0 bytes"));
  EXPECT_THAT(refusal("x", "file = \"none.py\""), HasSubstr("none.py"));
  EXPECT_THAT(refusal("x", "file = \"levels.py\"\ndeadline = 60"), HasSubstr("at most 10"));
  EXPECT_THAT(refusal("x", "deadline = 1"), HasSubstr("file is missing"));
}

}  // namespace
}  // namespace haptrial::experiments::level_script_test
