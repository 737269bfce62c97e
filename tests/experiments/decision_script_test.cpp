// Virtual participants whose answers a script gives: one that restates the program's own rule gives
// the same session, others what they say; what fails stops the dry run with a sentence.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/trial_rows.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "protocols/psychophysics/sequence/scripted_decisions.h"
#include "tests/experiments/command.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::decision_script_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

/// Answers by `expression` of the question q; keeps what it was asked; does `mischief` first.
std::string answering(const std::string& expression, const std::string& mischief = "") {
  return "import json, os, random, signal, sys, time\n"
         "for line in sys.stdin:\n"
         "    q = json.loads(line)\n"
         "    with open('asked', 'a') as kept:\n"
         "        kept.write(line)\n"
         "    n = sum(1 for _ in open('asked'))\n" +
         mischief + "    print(json.dumps(" + expression + "))\n";
}

/// The program's own rule for two intervals: the greater logarithm of what was felt.
const std::string kLargest =
    "{'answer': q['choices'][max(range(2), key=lambda i: q['percepts'][i])]}";

class DecisionScriptTest : public testing::Test {
 protected:
  DecisionScriptTest() {
    text_ =
        test::read_text(fs::path(HAPTRIAL_SOURCE_DIR "/experiments/stiffness_discrimination.toml"));
    put("until = { time = 2.5 }", "until = { time = 0.6 }");
    put("until = { inside = \"start\", for = 0.3 }", "until = { inside = \"start\", for = 0.02 }");
    put("until = { time = 0.5 }", "until = { time = 0.02 }");
    put("trials = 4\nlevel", "trials = 1\nlevel");
    put("rise = 0.5", "rise = 0.1");
    put("decides = \"largest\"", "decides = \"largest\"\nreaction = 0.05");
    put("lapse = { median = 0.02, spread = 0.3 }", "lapse = 0.0");
  }
  void put(const std::string& what, const std::string& instead) {
    const std::size_t at = text_.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text_.replace(at, what.size(), instead);
  }
  void write(const std::string& script, const std::string& keys = "") const {
    test::write_text(folder_ / "decide.py", script);
    test::write_text(
        folder_ / "study.toml",
        text_ + (script.empty() ? "" : "\n[observer.script]\nfile = \"decide.py\"\n" + keys));
  }
  /// @param script  empty: they decide themselves
  void run(const std::string& script, const std::string& name, int trials,
           realtime::ClockKind clock = realtime::ClockKind::kSimulated, bool resume = false) const {
    write(script);
    const Experiment experiment = load_experiment(folder_ / "study.toml");
    SessionRequest request = test::session_request(experiment, folder_ / name, 7);
    request.max_trials = trials;
    request.clock = clock;
    request.resume = resume;
    run_session(request);
  }
  std::vector<std::string> answers_in(const std::string& name) const {
    std::vector<std::string> answers;
    for (const record::ResponseRow& row : record::SessionReader(folder_ / name).responses()) {
      answers.push_back(row.text);
    }
    return answers;
  }
  std::vector<json> questions() const {
    std::vector<json> all;
    std::istringstream lines(test::read_text(folder_ / "asked"));
    for (std::string line; std::getline(lines, line);) {
      all.push_back(json::parse(line));
    }
    return all;
  }
  /// All that was felt, answered and presented.
  void expect_same(const std::string& a, const std::string& b) const {
    const record::SessionReader one(folder_ / a), other(folder_ / b);
    ASSERT_EQ(one.sample_count(), other.sample_count());
    const auto ticks = one.samples(0, one.sample_count());
    const auto others = other.samples(0, other.sample_count());
    const auto same = [](const record::Sample& x, const record::Sample& y) {
      return x.position == y.position && x.force == y.force && x.pass == y.pass;
    };
    EXPECT_TRUE(std::ranges::equal(ticks, others, same));
    ASSERT_EQ(one.responses().size(), other.responses().size());
    for (std::size_t i = 0; i < one.responses().size(); ++i) {
      EXPECT_EQ(one.responses()[i].text, other.responses()[i].text);
      EXPECT_EQ(one.responses()[i].reaction_time, other.responses()[i].reaction_time);
    }
    const auto levels = one.rows<record::LevelRow>(), again = other.rows<record::LevelRow>();
    ASSERT_EQ(levels.size(), again.size());
    for (std::size_t i = 0; i < levels.size(); ++i) {
      EXPECT_EQ(levels[i].asked, again[i].asked);
    }
  }
  test::CommandResult dry_run(const std::string& script, const std::string& keys = "") const {
    write(script, keys);
    return test::run_command("cd '" + folder_.path().string() +
                             "' && haptrial dry-run study.toml --subjects 1 --trials 6 --out dry");
  }
  test::TemporaryFolder folder_;
  std::string text_;
};

TEST_F(DecisionScriptTest, TheOwnRuleRestatedGivesTheSameSessionToTheBit) {
  run("", "own.h5", 60);
  run(answering(kLargest), "script.h5", 60);
  expect_same("own.h5", "script.h5");
  EXPECT_THAT(questions(), SizeIs(61)) << "sixty trials and one of practice";
}

TEST_F(DecisionScriptTest, SoDoesOneThatLeavesEveryDecisionToTheParticipant) {
  put("lapse = 0.0\n", "lapse = 0.2\ndecision_noise = 0.1\nbias_first = 0.3\nrepetition = 0.2\n");
  run("", "own.h5", 40);
  run(answering("{'answer': None}"), "script.h5", 40);
  expect_same("own.h5", "script.h5");
  fs::remove(folder_ / "asked");
  run(answering("{'answer': q['proposed']}"), "proposed.h5", 40);
  expect_same("own.h5", "proposed.h5");
}

TEST_F(DecisionScriptTest, AnswersAndTimesAreTheScripts) {
  run(answering("{'answer': 'first', 'reaction_time': 0.4}"), "S01.h5", 12);
  EXPECT_THAT(answers_in("S01.h5"), AllOf(SizeIs(13), Each(std::string("first"))));
  const record::SessionReader file(folder_ / "S01.h5");
  for (const record::ResponseRow& row : file.responses()) {
    EXPECT_NEAR(row.reaction_time, 0.4, 0.0021);
    EXPECT_EQ(row.correct, row.text == "first" ? row.correct : 0);
  }
  std::vector<std::string> texts;
  for (const record::EventRow& event : file.events()) {
    if (event.kind == protocols::kDecisionScriptEvent) {
      texts.push_back(event.text);
    }
  }
  EXPECT_THAT(texts, ElementsAre(answering("{'answer': 'first', 'reaction_time': 0.4}")));
}

/// A participant without senses is right in half of the trials: from 120, within 4.5 standard
/// deviations of a binomial share.
TEST_F(DecisionScriptTest, OneThatGuessesFromItsSeedIsAtChanceAndTheSameEveryTime) {
  const std::string guesses =
      answering("{'answer': random.Random(q['seed']).choice(q['choices'])}");
  run(guesses, "a.h5", 120);
  std::set<std::uint64_t> seeds;
  for (const json& each : questions()) {
    seeds.insert(each["seed"].get<std::uint64_t>());
    EXPECT_LT(each["seed"].get<std::uint64_t>(), std::uint64_t{1} << 53U);
  }
  EXPECT_EQ(seeds.size(), questions().size()) << "one for each decision";
  int right = 0, all = 0;
  for (const record::ResponseRow& row : record::SessionReader(folder_ / "a.h5").responses()) {
    right += row.correct;
    ++all;
  }
  EXPECT_NEAR(right, 0.5 * all, 4.5 * std::sqrt(0.25 * all));
  run(guesses, "b.h5", 120);
  expect_same("a.h5", "b.h5");
}

TEST_F(DecisionScriptTest, ItIsToldWhatWasPresentedFeltAndAnswered) {
  run(answering(kLargest), "S01.h5", 5);
  const std::vector<json> asked = questions();
  ASSERT_THAT(asked, SizeIs(6));
  EXPECT_TRUE(asked[0]["practice"]);
  EXPECT_THAT(asked[0]["history"], SizeIs(0));
  const std::vector<std::string> answers = answers_in("S01.h5");
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const json& q = asked[i];
    EXPECT_EQ(q["subject"], "S01");
    EXPECT_EQ(q["question"], "stiffer");
    EXPECT_EQ(q["choices"], json({"first", "second"}));
    ASSERT_THAT(q["stimulus"], SizeIs(2));
    std::multiset<double> stiffness;
    for (std::size_t k = 0; k < 2; ++k) {
      stiffness.insert(q["stimulus"][k]["stiffness"].get<double>());
      const double share =
          q["percepts"][k].get<double>() / q["stimulus"][k]["stiffness"].get<double>();
      EXPECT_GT(share, 0.4) << "felt by a hand with 7 % of noise, deflections too small by half";
      EXPECT_LT(share, 2.5);
    }
    EXPECT_EQ(stiffness.count(300.0), 1u) << "the reference";
    ASSERT_THAT(q["history"], SizeIs(i));
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_EQ(q["history"][k]["answers"]["stiffer"], answers[k]);
    }
  }
}

TEST_F(DecisionScriptTest, AResumedSessionGoesOnAsIfItHadNotBeenInterrupted) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "a thread sanitizer does not follow a fork of threads";
  }
  // The history decides, too: every other trial is answered against what was felt.
  const std::string script = answering(
      "{'answer': q['choices'][(q['percepts'][0] < q['percepts'][1]) ^ "
      "(len(q['history']) % 2)]}",
      "    if n == 6 and os.path.exists('kill'):\n"
      "        os.kill(os.getppid(), signal.SIGKILL)\n");
  run(script, "whole.h5", 8);
  fs::remove(folder_ / "asked");
  test::write_text(folder_ / "kill", "");
  const pid_t session = fork();
  ASSERT_GE(session, 0);
  if (session == 0) {
    run(script, "parts.h5", 8, realtime::ClockKind::kReal);
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(session, &status, 0), session);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the script kills its session at the sixth trial";
  fs::remove(folder_ / "kill");
  EXPECT_THROW(run(script + "\n", "parts.h5", 8, realtime::ClockKind::kSimulated, true),
               InputError);
  run(script, "parts.h5", 8, realtime::ClockKind::kSimulated, true);
  EXPECT_EQ(answers_in("parts.h5"), answers_in("whole.h5"));
}

TEST_F(DecisionScriptTest, WhatFailsStopsTheDryRunWithOneSentence) {
  const auto sentence = [&](const std::string& script, const std::string& keys = "") {
    fs::remove(folder_ / "asked");
    const test::CommandResult result = dry_run(script, keys);
    EXPECT_EQ(result.status, 2) << result.output;
    EXPECT_FALSE(fs::exists(folder_ / "dry")) << "nothing half-written";
    EXPECT_EQ(std::ranges::count(result.errors, '\n'), 1) << result.errors;
    return result.errors;
  };
  EXPECT_THAT(
      sentence(answering(kLargest, "    if n == 3:\n        raise ValueError('no idea')\n")),
      AllOf(HasSubstr("observer.script: trial 2 of S01: decide.py: it ended with no answer"),
            HasSubstr("ValueError: no idea")));
  EXPECT_THAT(sentence(answering(kLargest,
                                 "    if n == 2:\n        os.kill(os.getpid(), signal.SIGKILL)\n")),
              HasSubstr("trial 1 of S01: decide.py: it ended with no answer"));
  EXPECT_THAT(sentence(answering(kLargest, "    time.sleep(1000)\n"), "deadline = 1.0\n"),
              HasSubstr("practice trial 1 of S01: decide.py: it gave no answer within 1 s"));
  EXPECT_THAT(sentence(answering("{'answer': 'third'}")),
              HasSubstr("its answer was \"third\"; allowed: \"first\", \"second\", or null"));
  EXPECT_THAT(sentence(answering("{'answer': 'first', 'reaction_time': -1}")),
              HasSubstr("its reaction_time was -1; allowed: 0 to 600 s"));
}

TEST_F(DecisionScriptTest, ValidateKnowsIt) {
  const auto validated = [&](const std::string& keys) {
    test::write_text(folder_ / "study.toml", text_ + "\n[observer.script]\n" + keys);
    return test::run_command("haptrial validate '" + (folder_ / "study.toml").string() + "'");
  };
  test::write_text(folder_ / "decide.py", answering(kLargest));
  EXPECT_THAT(validated("file = \"decide.py\"").output,
              HasSubstr("virtual participants answer by decide.py (observer.script)"));
  EXPECT_THAT(validated("file = \"none.py\"").errors, HasSubstr("none.py"));
  EXPECT_THAT(validated("deadline = 1").errors, HasSubstr("file is missing"));
  EXPECT_THAT(validated("file = \"decide.py\"\ndeadline = 0").errors, HasSubstr("at least 0.05"));
  test::write_text(folder_ / "decide.py", "");
  EXPECT_THAT(validated("file = \"decide.py\"").errors, HasSubstr("holds 0 bytes"));
}

/// The numbers that a participant types.
TEST_F(DecisionScriptTest, MagnitudesAreTheScriptsToo) {
  text_ = test::read_text(fs::path(HAPTRIAL_SOURCE_DIR "/experiments/viscosity_magnitude.toml"));
  run(answering("{'answer': 3.5}"), "S01.h5", 3);
  for (const record::ResponseRow& row : record::SessionReader(folder_ / "S01.h5").responses()) {
    EXPECT_EQ(row.value, 3.5);
  }
  EXPECT_THROW(run(answering("{'answer': -4}"), "S02.h5", 3), InputError);
  EXPECT_THROW(run(answering("{'answer': 'much'}"), "S03.h5", 3), InputError);
}

TEST_F(DecisionScriptTest, TheCommandTakesItFromOutsideTheDefinition) {
  write(answering("{'answer': 'second'}"));
  test::write_text(folder_ / "plain.toml", text_);
  const std::string folder = "cd '" + folder_.path().string() + "' && haptrial dry-run plain.toml ";
  const test::CommandResult result =
      test::run_command(folder +
                        "--set observer.script.file='\"decide.py\"' --set "
                        "observer.reaction=0.2 --subjects 1 --trials 3 --out set");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(answers_in("set/S01.h5"), Each(std::string("second")));
  EXPECT_THAT(record::SessionReader(folder_ / "set/S01.h5").info().definition,
              AllOf(HasSubstr("file = \"decide.py\""), HasSubstr("reaction = 0.2")));
  const test::CommandResult wrong = test::run_command(folder + "--set observer.reaction");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.errors, HasSubstr("allowed: KEY=VALUE"));
}

}  // namespace
}  // namespace haptrial::experiments::decision_script_test
