// kill -9 in the middle of pages and of questionnaires: answers that were given are kept and not
// asked for again, and the rest is asked.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "core/base/file_text.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/answer_rows.h"
#include "experiments/control/session_control.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "tests/experiments/session_runs.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::killed_pages_test {
namespace {

using record::AnswerRow;

constexpr const char* kPages = R"(
[pages]
before = ["welcome", "agree", "hand"]
after = ["load", "you"]
[pages.welcome]
text = "A study of touch."
[pages.agree]
kind = "consent"
text = "Do you take part?"
[pages.hand]
kind = "edinburgh"
[pages.load]
kind = "nasa_tlx"
weighted = true
[pages.you]
kind = "questions"
[[pages.you.items]]
name = "age"
question = "How old are you?"
number = [18, 99]
[[pages.you.items]]
name = "else"
question = "Anything else?"
words = true
)";

/// A person who answers at the console, in each run in a way of its own, and ends the program with
/// kill -9 as soon as a question of this number is asked.
class Respondent {
 public:
  Respondent(SessionControl& control, int run, int last)
      : control_(control), run_(run), last_(last), thread_([this] { work(); }) {}
  ~Respondent() {
    over_ = true;
    thread_.join();
  }

 private:
  void work() {
    int answered = 0;
    while (!over_) {
      const SessionStatus status = control_.status();
      if (status.asked.number >= last_) {
        ::kill(::getpid(), SIGKILL);
      }
      if (status.asked.number > answered) {
        answered = status.asked.number;
        control_.answer(answered, answer_to(status.asked));
      } else if (status.asked.number == 0 && status.state == "instructions") {
        control_.ask(Request::kStart);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  std::string answer_to(const AskedItem& asked) const {
    return asked.kind == "consent"  ? "1: paper form signed"
           : asked.kind == "choice" ? (run_ == 2 ? "2" : "1")
           : asked.kind == "words"  ? "nothing"
                                    : std::to_string(20 + 5 * run_);
  }

  SessionControl& control_;
  int run_, last_;
  std::atomic<bool> over_{false};
  std::thread thread_;
};

class LiveKilledPagesTest : public testing::Test {
 protected:
  void SetUp() override {
    if (test::kThreadSanitizer) {
      GTEST_SKIP() << "a thread sanitizer does not follow a fork of threads";
    }
    write_text(folder_ / "study.toml",
               file_text(HAPTRIAL_SOURCE_DIR "/experiments/first_experiment.toml") + kPages);
    experiment_ = load_experiment(folder_ / "study.toml");
  }
  std::filesystem::path file() const { return folder_ / "S01.h5"; }
  void run(int number, int last) {
    SessionControl control;
    SessionRequest request = test::session_request(experiment_, file(), 7);
    request.definition_folder = folder_.path();
    request.max_trials = 1;
    request.clock = realtime::ClockKind::kReal;
    request.device = {"virtual", "", 0};
    request.control = &control;
    request.resume = number > 1;
    const Respondent person(control, number, last);
    run_session(request);
  }
  void run_and_kill(int number, int last) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      run(number, last);
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  }
  std::vector<AnswerRow> kept() const {
    return record::SessionReader(file().string() + ".partial").rows<AnswerRow>();
  }
  static void expect_begins_with(const std::vector<AnswerRow>& rows,
                                 const std::vector<AnswerRow>& first) {
    ASSERT_GE(rows.size(), first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(rows[i].questionnaire, first[i].questionnaire);
      EXPECT_EQ(rows[i].item, first[i].item);
      EXPECT_EQ(rows[i].text, first[i].text);
      EXPECT_EQ(rows[i].value, first[i].value) << rows[i].item;
      EXPECT_EQ(rows[i].time_ns, first[i].time_ns) << "as it was answered the first time";
    }
  }
  test::TemporaryFolder folder_;
  Experiment experiment_;
};

TEST_F(LiveKilledPagesTest, AnswersAreKeptAndOnlyTheRestIsAsked) {
  run_and_kill(1, 5);  // after the text, consent and two of the ten activities
  const auto first = kept();
  ASSERT_EQ(first.size(), 3u) << "every answer that was given";
  run_and_kill(2, 16);  // text, eight activities, last look, trial, five of the NASA-TLX
  const auto second = kept();
  ASSERT_EQ(second.size(), 16u);
  expect_begins_with(second, first);
  run(3, 1000);
  const record::SessionReader reader(file());
  EXPECT_TRUE(record::check_session(reader, known_tables()).ok);
  const auto rows = reader.rows<AnswerRow>();
  ASSERT_EQ(rows.size(), 1u + 10u + 21u + 2u) << "each item once";
  expect_begins_with(rows, second);
  std::vector<std::string> names;
  for (const AnswerRow& row : rows) {
    names.push_back(row.questionnaire + "." + row.item);
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
  EXPECT_EQ(rows[rows.size() - 2].value, 35.0) << "the age that the third run gave";
  EXPECT_EQ(rows[12].value, 30.0) << "a rating that the second run gave";
  int completed = 0;
  for (const record::PassRow& pass : reader.passes()) {
    completed += pass.status == record::PassStatus::kCompleted ? 1 : 0;
  }
  EXPECT_EQ(completed, 1) << "the trial is not presented again";
}

}  // namespace
}  // namespace haptrial::experiments::killed_pages_test
