// A session on the real clock in which a person answers with an analog pedal: a pipe delivers the
// pedal's records, and its writer goes away and comes back.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "core/record/read/session_reader.h"
#include "core/record/rows/trial_rows.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/event_records.h"
#include "tests/support/felt_or_not.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::pedal_session_test {
namespace {

using record::ResponseSource;
using testing::Contains;
using testing::HasSubstr;

/// A foot that presses and lets go all the time. It leaves the pipe once, for a while.
class RestlessFoot {
 public:
  explicit RestlessFoot(std::string pipe) : pipe_(std::move(pipe)), thread_([this] { step(); }) {}
  ~RestlessFoot() {
    over_ = true;
    thread_.join();
  }

 private:
  void step() {
    constexpr int kStepsBeforeItLeaves = 20;
    int file = -1;
    for (int i = 0; !over_; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(60));
      if (i == kStepsBeforeItLeaves && file >= 0) {
        close(file);
        file = -1;
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
      }
      file = file >= 0 ? file : open(pipe_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
      const auto bytes = test::report_of(ABS_GAS, i % 2 == 0 ? 200 : 0);
      if (file >= 0 && write(file, bytes.data(), bytes.size()) < 0) {
        close(file);
        file = -1;
      }
    }
    if (file >= 0) {
      close(file);
    }
  }

  std::string pipe_;
  std::atomic<bool> over_{false};
  std::thread thread_;
};

class LivePedalTest : public testing::Test {
 protected:
  void SetUp() override {
    signal(SIGPIPE, SIG_IGN);
    ASSERT_EQ(mkfifo((folder_ / "pedal").c_str(), 0600), 0);
  }
  std::string table() const {
    return "[pedal]\ninput = \"" + (folder_ / "pedal").string() +
           "\"\naxis = \"ABS_GAS\"\nreleased = 0\npressed = 200\n";
  }
  SessionSummary run(const std::string& choices, const std::string& more) {
    std::string text = test::felt_or_not(choices) + more;
    const auto replace = [&text](const std::string& what, const std::string& with) {
      text.replace(text.find(what), what.size(), with);
    };
    replace("repetitions = 6", "repetitions = 2");
    replace("until = { time = 0.6 }", "until = { time = 0.3 }");
    test::write_text(folder_ / "study.toml", text);
    experiment_ = load_experiment(folder_ / "study.toml");
    SessionRequest request = test::session_request(experiment_, folder_ / "S01.h5", 7);
    request.clock = realtime::ClockKind::kReal;
    request.device = {"mouse", "", 0};
    return run_session(request);
  }
  test::TemporaryFolder folder_;
  Experiment experiment_;
};

TEST_F(LivePedalTest, AnswersAreGivenByFootAndALossIsRecorded) {
  const RestlessFoot foot(folder_ / "pedal");
  const SessionSummary summary =
      run("choices = [{ value = \"felt\", pedal = 0.5 }, { value = \"not\", keys = [\"N\"] }]\n",
          table());
  const record::SessionReader reader(folder_ / "S01.h5");
  const auto responses = reader.responses();
  ASSERT_EQ(responses.size(), 4u);
  for (const record::ResponseRow& row : responses) {
    EXPECT_EQ(row.source, ResponseSource::kPedal);
    EXPECT_EQ(row.text, "felt");
  }
  std::vector<std::string> events;
  for (const record::EventRow& event : reader.events()) {
    events.push_back(event.kind);
  }
  EXPECT_THAT(events, Contains("pedal_lost"));
  EXPECT_THAT(events, Contains("pedal_back"));
  EXPECT_THAT(
      summary.notices,
      Contains(HasSubstr("is lost (the writer of the pipe has closed it): it counts as up")));
}

TEST_F(LivePedalTest, AnAnswerThatOnlyAMissingPedalGivesIsRefused) {
  EXPECT_THAT(test::message_of([&] {
                run("choices = [{ value = \"felt\", pedal = 0.5 }, { value = \"not\" }]\n", "");
              }),
              HasSubstr("an answer is given by the pedal alone, but no table [pedal]"));
}

}  // namespace
}  // namespace haptrial::experiments::pedal_session_test
