// A kind of question that no file of the product knows, an angle that arrow keys turn: on a page
// and in a trial it is read, asked, drawn, answered by people, virtual participants and scripts,
// recorded, resumed and analysed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <functional>
#include <thread>

#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/answer_rows.h"
#include "docs/worked/own/angle.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "experiments/studies/study.h"
#include "experiments/study/study_files.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/felt_or_not.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::added_question_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct Ended {
  int status{-1};
  std::string errors;
};

/// Runs something in a program that has the kind.
Ended run_own(const std::function<void(int& status)>& work, const fs::path& folder) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const bool open = std::freopen((folder / "output").c_str(), "w", stdout) != nullptr &&
                      std::freopen((folder / "errors").c_str(), "w", stderr) != nullptr;
    int status = open ? 0 : 9;
    try {
      own::add_angle();
      fs::current_path(folder);
      work(status);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      status = is_bad_input(error) ? 2 : 1;
    }
    std::fflush(nullptr);
    ::_exit(status);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, test::read_text(folder / "errors")};
}

std::string definition() {
  std::string text = test::felt_or_not("name = \"turn\"\nangle = [0, 355]\nstep = 5\n");
  const auto put = [&text](const std::string& what, const std::string& instead) {
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), instead);
  };
  put("counts = \"$answer == 1\"", "counts = \"$turn >= 180\"");
  put("decides = \"yes\"", "decides = \"magnitude\"\nexponent = 1.0\nmodulus = 200.0");
  put("criterion = 0.4\n", "");
  return text + R"([pages]
after = ["end"]
[pages.end]
kind = "questions"
[[pages.end.items]]
name = "where"
question = "Where did it pull to?"
angle = [0, 355]
step = 5
)";
}

class AddedQuestionTest : public testing::Test {
 protected:
  void SetUp() override { test::write_text(folder_ / "study.toml", definition()); }
  /// A session of the definition by a virtual participant.
  /// @param kill_at  tick at which its program is killed; 0: never
  Ended session(const std::string& name,
                realtime::ClockKind clock = realtime::ClockKind::kSimulated, bool resume = false,
                std::uint64_t kill_at = 0) const {
    return run_own(
        [&](int&) {
          std::atomic<std::uint64_t> ticks{0};
          if (kill_at > 0) {
            std::thread([&] {
              while (ticks.load() < kill_at) {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
              }
              ::kill(::getpid(), SIGKILL);
            }).detach();
          }
          const Experiment experiment = load_experiment("study.toml");
          SessionRequest request = test::session_request(experiment, folder_ / name, 7);
          request.clock = clock;
          request.resume = resume;
          request.ticks = &ticks;
          run_session(request);
        },
        folder_.path());
  }
  static std::vector<double> values_in(const fs::path& file) {
    std::vector<double> values;
    for (const record::ResponseRow& row : record::SessionReader(file).responses()) {
      EXPECT_EQ(row.question, "turn");
      values.push_back(row.value);
    }
    return values;
  }
  test::TemporaryFolder folder_;
};

TEST_F(AddedQuestionTest, ASessionIsRecordedAndAnalysed) {
  fs::create_directory(folder_ / "dry");
  ASSERT_EQ(session("dry/S01.h5").errors, "");
  const record::SessionReader file(folder_ / "dry/S01.h5");
  EXPECT_TRUE(record::check_session(file, known_tables()).ok);
  const std::vector<double> values = values_in(folder_ / "dry/S01.h5");
  ASSERT_EQ(values.size(), 12u);
  for (const double value : values) {
    EXPECT_TRUE(value >= 0.0 && value <= 355.0 && std::fmod(value, 5.0) == 0.0) << value;
  }
  const auto answers = file.rows<record::AnswerRow>();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].item, "where");
  EXPECT_EQ(std::fmod(answers[0].value, 5.0), 0.0);
  const Ended analysed = run_own(
      [&](int&) {
        const Study& study = *find_study("trials");
        const ProtocolOf protocol = [&](const record::SessionInfo&) -> const protocols::Protocol& {
          return study.protocol();
        };
        AnalysisRequest request;
        request.folder = folder_ / "dry";
        request.files = study_files(request.folder, Pilots::kLeftOut, protocol);
        request.out = folder_ / "report";
        fs::create_directory(request.out);
        study.analyze(request);
      },
      folder_.path());
  EXPECT_EQ(analysed.status, 0) << analysed.errors;
  bool told = false;  // the score of the page's item is in the report
  for (const auto& each : fs::directory_iterator(folder_ / "report")) {
    told = told || (each.is_regular_file() &&
                    test::read_text(each.path()).find("where") != std::string::npos);
  }
  EXPECT_TRUE(told);
}

TEST_F(AddedQuestionTest, AScriptAnswersInDegrees) {
  test::write_text(folder_ / "decide.py",
                   "import json, sys\n"
                   "for line in sys.stdin:\n"
                   "    q = json.loads(line)\n"
                   "    assert q['kind'] == 'angle' and q['high'] == 355\n"
                   "    print(json.dumps({'answer': 90}), flush=True)\n");
  test::write_text(folder_ / "study.toml",
                   definition() + "[observer.script]\nfile = \"decide.py\"\n");
  EXPECT_EQ(session("S01.h5").errors, "");
  EXPECT_THAT(values_in(folder_ / "S01.h5"),
              testing::AllOf(testing::SizeIs(12), testing::Each(90.0)));
}

TEST_F(AddedQuestionTest, ASessionThatWasKilledGoesOnWhereItWas) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "a thread sanitizer does not follow a fork of threads";
  }
  test::write_text(folder_ / "decide.py",
                   "import json, sys\n"
                   "for line in sys.stdin:\n"
                   "    q = json.loads(line)\n"
                   "    print(json.dumps({'answer': 5 * (q['seed'] % 72)}), flush=True)\n");
  test::write_text(folder_ / "study.toml",
                   definition() + "[observer.script]\nfile = \"decide.py\"\n");
  EXPECT_EQ(session("whole.h5").status, 0);
  EXPECT_EQ(session("parts.h5", realtime::ClockKind::kReal, false, 6000).status, 128);
  const std::size_t before = values_in(folder_ / "parts.h5.partial").size();
  EXPECT_GT(before, 0u);
  EXPECT_LT(before, 12u);
  EXPECT_EQ(session("parts.h5", realtime::ClockKind::kReal, true).status, 0);
  EXPECT_TRUE(
      record::check_session(record::SessionReader(folder_ / "parts.h5"), known_tables()).ok);
  EXPECT_EQ(values_in(folder_ / "parts.h5"), values_in(folder_ / "whole.h5"));
}

TEST_F(AddedQuestionTest, AnotherProgramSaysThatItDoesNotKnowTheKind) {
  try {
    load_experiment(folder_ / "study.toml");
    FAIL() << "it knows no angle";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("response.angle is not a known key"));
  }
}

}  // namespace
}  // namespace haptrial::experiments::added_question_test
