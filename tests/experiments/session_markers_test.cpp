// Markers and sounds of whole sessions: what the serial line received, what the screen showed, what
// the file says of it.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <map>
#include <set>
#include <thread>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/marker_row.h"
#include "core/record/rows/trial_rows.h"
#include "core/sound/cue.h"
#include "experiments/runner/session.h"
#include "protocols/psychophysics/trials_protocol.h"
#include "tests/experiments/session_runs.h"
#include "tests/support/pseudo_terminal.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"
#include "tests/support/wait.h"

namespace haptrial::experiments::session_markers_test {
namespace {

namespace fs = std::filesystem;
using record::MarkerOf;
using record::MarkerOutput;
using record::MarkerRow;
using testing::HasSubstr;

/// Eight trials of half a second.
std::string study(const std::string& more) {
  return R"([experiment]
protocol = "trials"
name = "marked"
[design]
participants = 2
[fields.pull]
type = "constant"
force = [0.0, "-$level * $part", 0.0]
fade_in = 0.05
fade_out = 0.05
[intervals]
order = "random"
whole = { part = 1.0 }
half = { part = 0.5 }
[[stages]]
name = "ready"
until = { time = 0.08 }
sound = "go"
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 0.1 }
marker = 17
[response]
question = "Which was stronger?"
choices = [{ value = "first" }, { value = "second" }]
correct = "$interval.whole"
[procedure]
kind = "constant"
variable = "level"
unit = "N"
levels = [0.3, 0.6]
repetitions = 4
[observer]
decides = "largest"
reaction = 0.06
[observer.actions]
feel = { do = "hold" }
[sounds]
device = "null"
[sounds.go]
type = "tone"
frequency = 1000.0
duration = 0.05
level = -20.0
[sounds.masking]
level = -40.0
stages = ["feel"]
fade = 0.01
)" + more;
}

/// Codes that were sent.
const std::map<std::string, int> kCodes{{"trial", 1}, {"whole", 11},  {"half", 12},   {"ready", 21},
                                        {"feel", 17}, {"first", 101}, {"second", 102}};

std::vector<MarkerRow> markers_by(const record::SessionReader& file, MarkerOutput way) {
  std::vector<MarkerRow> rows = file.rows<MarkerRow>();
  std::erase_if(rows, [way](const MarkerRow& row) { return row.way != way; });
  return rows;
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

class SessionMarkersTest : public testing::Test {
 protected:
  SessionRequest request(const std::string& more, realtime::ClockKind clock) {
    Table root = Table::parse(study(more), "marked.toml");
    definition_ = protocols::trials_protocol().read(root, "marked.toml", nullptr);
    protocols::check_markers(root, *definition_);
    root.finish();
    SessionRequest request =
        test::session_request(protocols::trials_protocol(), *definition_, folder_ / "S01.h5", 7);
    request.clock = clock;
    return request;
  }
  SessionRequest live(const std::string& more) { return request(more, realtime::ClockKind::kReal); }

  /// Every marker that /trials, /stages and /responses ask for is there once, on their ticks.
  static void expect_as_presented(const record::SessionReader& file, MarkerOutput way) {
    std::multiset<std::tuple<MarkerOf, std::uint64_t, int>> expected, found;
    for (const record::PassRow& pass : file.passes()) {
      expected.emplace(MarkerOf::kTrial, pass.first_sample, 1);
    }
    for (const record::StageRow& stage : file.rows<record::StageRow>()) {
      expected.emplace(MarkerOf::kStage, stage.first_sample, kCodes.at(stage.stage));
    }
    std::map<std::pair<int, int>, double> part;
    for (const record::VariableRow& row : file.rows<record::VariableRow>()) {
      if (row.name == "part") {
        part[{row.pass, row.interval}] = row.value;
      }
    }
    for (const record::StageRow& stage : file.rows<record::StageRow>()) {
      if (stage.stage == "ready") {                                // an interval begins with it
        const auto own = part.find({stage.pass, stage.interval});  // else as in the whole trial
        const bool whole = (own != part.end() ? own->second : part.at({stage.pass, 0})) == 1.0;
        expected.emplace(MarkerOf::kInterval, stage.first_sample, whole ? 11 : 12);
      }
    }
    for (const record::ResponseRow& row : file.responses()) {
      expected.emplace(MarkerOf::kResponse, row.sequence, kCodes.at(row.text));
    }
    for (const MarkerRow& row : markers_by(file, way)) {
      found.emplace(row.what, row.sequence, row.code);
      EXPECT_EQ(row.code, kCodes.at(row.name));
      EXPECT_EQ(row.trial, file.passes().at(static_cast<std::size_t>(row.pass)).trial);
      EXPECT_EQ(row.time_ns, file.samples(row.sequence, 1).front().time_ns);
    }
    EXPECT_EQ(found, expected);
    EXPECT_FALSE(found.empty());
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<protocols::Definition> definition_;
};

TEST_F(SessionMarkersTest, ADryRunShowsTheCodes) {
  run_session(request("", realtime::ClockKind::kSimulated));
  const record::SessionReader file(folder_ / "S01.h5");
  ASSERT_EQ(file.passes().size(), 8u);
  EXPECT_EQ(file.rows<MarkerRow>().size(), 8u * 8u);
  expect_as_presented(file, MarkerOutput::kNone);
  for (const MarkerRow& row : file.rows<MarkerRow>()) {
    EXPECT_TRUE(std::isnan(row.latency) && std::isnan(row.written));
    EXPECT_EQ(row.frame, -1);
  }
  std::vector<std::string> told;
  for (const record::EventRow& event : file.events()) {
    if (event.kind == "sound") {
      told.push_back(event.text);
    }
  }
  EXPECT_THAT(told, testing::ElementsAre("not played: the session is simulated"));
}

TEST_F(SessionMarkersTest, TheSerialLineReceivesWhatTheFileSays) {
  test::PseudoTerminal line;
  const SessionSummary summary =
      run_session(live("[markers]\nserial = \"" + line.name() + "\"\npulse = 0.002\n"));
  const record::SessionReader file(folder_ / "S01.h5");
  ASSERT_EQ(file.passes().size(), 8u);
  expect_as_presented(file, MarkerOutput::kSerial);

  std::vector<MarkerRow> rows = markers_by(file, MarkerOutput::kSerial);
  std::ranges::stable_sort(rows, {}, &MarkerRow::written);
  test::wait_until([&] { return line.heard().size() >= 2 * rows.size(); });
  std::vector<test::PseudoTerminal::Heard> codes;
  const auto heard = line.heard();
  for (std::size_t i = 0; i < heard.size(); ++i) {
    EXPECT_EQ(heard[i].byte == 0, i % 2 == 1) << "every pulse ends before the next";
    if (heard[i].byte != 0) {
      codes.push_back(heard[i]);
    }
  }
  ASSERT_EQ(codes.size(), rows.size());
  std::vector<double> latencies, first;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(codes[i].byte, rows[i].code) << i;
    EXPECT_NEAR(rows[i].latency, rows[i].written - 1e-9 * static_cast<double>(rows[i].time_ns),
                1e-9);
    EXPECT_GT(rows[i].latency, 0.0);
    latencies.push_back(1e3 * rows[i].latency);
    if (rows[i].what == MarkerOf::kStage || rows[i].what == MarkerOf::kResponse) {
      first.push_back(1e3 * rows[i].latency);
    }
  }
  std::printf(
      "tick to write, first code of a tick: median %.3f, 99 %% %.3f, largest %.3f ms; all: "
      "median %.3f, largest %.3f ms\n",
      quantile(first, 0.5), quantile(first, 0.99), quantile(first, 1.0), quantile(latencies, 0.5),
      quantile(latencies, 1.0));
  EXPECT_THAT(summary.markers, testing::Contains(HasSubstr("serial: 64 markers, median")));
}

TEST_F(SessionMarkersTest, SoundsSayWhenTheCardTookThem) {
  const SessionSummary summary = run_session(live(""));
  const record::SessionReader file(folder_ / "S01.h5");
  const auto rows = markers_by(file, MarkerOutput::kSound);
  ASSERT_EQ(rows.size(), 16u) << "two intervals of eight trials";
  std::vector<double> latencies;
  for (const MarkerRow& row : rows) {
    EXPECT_EQ(row.name, "ready");
    EXPECT_GT(row.latency, 0.0);
    latencies.push_back(1e3 * row.latency);
  }
  std::printf("tick to the card's buffer: median %.2f ms, largest %.2f ms\n",
              quantile(latencies, 0.5), quantile(latencies, 1.0));
  EXPECT_THAT(summary.markers, testing::Contains(HasSubstr("sound: 16 markers")));
  EXPECT_FALSE(markers_by(file, MarkerOutput::kNone).empty()) << "those without a sound";
  bool played = false;
  for (const record::EventRow& event : file.events()) {
    played = played || (event.kind == "sound" && event.text == "played on 'null'");
  }
  EXPECT_TRUE(played);
}

TEST_F(SessionMarkersTest, WithoutACardThereIsOneSentence) {
  std::string text = study("");
  SessionRequest asked = live("");
  const_cast<sound::CueSet*>(definition_->sounds())->device = "hw:no-such-card";
  const SessionSummary summary = run_session(asked);
  int sentences = 0;
  for (const std::string& notice : summary.notices) {
    sentences += notice.find("sound card 'hw:no-such-card'") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(sentences, 1);
  const record::SessionReader file(folder_ / "S01.h5");
  const auto rows = markers_by(file, MarkerOutput::kSound);
  ASSERT_EQ(rows.size(), 16u);
  EXPECT_TRUE(std::ranges::all_of(rows, [](const auto& row) { return std::isnan(row.written); }))
      << "nothing was played";
}

TEST_F(SessionMarkersTest, ALineThatDisappearsDoesNotEndTheSession) {
  test::PseudoTerminal line;
  const SessionRequest asked = live("[markers]\nserial = \"" + line.name() + "\"\npulse = 0.001\n");
  std::thread hand([&] {
    while (line.bytes().size() < 40) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    line.unplug();
  });
  const SessionSummary summary = run_session(asked);
  hand.join();
  EXPECT_EQ(summary.aborted_passes, 0);
  const record::SessionReader file(folder_ / "S01.h5");
  ASSERT_EQ(file.passes().size(), 8u);
  expect_as_presented(file, MarkerOutput::kSerial);  // what was lost has its row, too
  std::size_t lost = 0;
  for (const MarkerRow& row : markers_by(file, MarkerOutput::kSerial)) {
    lost += std::isnan(row.written) ? 1 : 0;
  }
  EXPECT_GT(lost, 0u);
  EXPECT_LT(lost, 64u);
  EXPECT_THAT(summary.notices, testing::Contains(HasSubstr("the session goes on, and counts")));
  EXPECT_THAT(summary.markers,
              testing::Contains(HasSubstr("; " + std::to_string(lost) + " did not go")));
}

TEST_F(SessionMarkersTest, ASessionDoesNotBeginWithoutItsLine) {
  const SessionRequest asked = live("[markers]\nserial = \"/dev/no-such-line\"\n");
  try {
    run_session(asked);
    FAIL() << "it began";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("serial line /dev/no-such-line"));
  }
  EXPECT_FALSE(fs::exists(folder_ / "S01.h5.partial"));
}

class MarkerKillTest : public SessionMarkersTest, public testing::WithParamInterface<double> {};

/// A line that is slower than the trials, too.
TEST_P(MarkerKillTest, LeavesTheMarkersOfFinishedTrials) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "a thread sanitizer does not follow a fork of threads";
  }
  test::PseudoTerminal line;
  const SessionRequest asked =
      live(fmt::format("[markers]\nserial = \"{}\"\npulse = {}\n", line.name(), GetParam()));
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    run_session(asked);
    ::_exit(0);
  }
  while (std::ranges::count(line.bytes(), 1) < 4) {  // the fourth trial has begun
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ::kill(child, SIGKILL);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "it came to its end before it was killed";
  const record::SessionReader file(folder_ / "S01.h5.partial");
  const std::size_t finished = file.passes().size();
  EXPECT_GE(finished, 2u) << "the third may not have been written yet";
  std::map<int, int> of_pass;
  for (const MarkerRow& row : markers_by(file, MarkerOutput::kSerial)) {
    ++of_pass[row.pass];
  }
  for (std::size_t pass = 0; pass < finished; ++pass) {
    EXPECT_EQ(of_pass[static_cast<int>(pass)], 8) << pass;
  }
}

INSTANTIATE_TEST_SUITE_P(Pulses, MarkerKillTest, testing::Values(0.001, 0.05));

TEST_F(SessionMarkersTest, TheScreenSaysWhichFrameWasWhite) {
  test::VirtualDisplay display(640, 480);
  SessionRequest asked = live(
      "[screen]\nfull_screen = false\nphotodiode = \"onset\"\nphotodiode_time = 0.03\n"
      "[display]\nwidth = 600\nheight = 440\n");
  asked.window = true;
  std::atomic<bool> over{false};
  std::thread person([&] {
    while (!over) {  // space begins
      try {
        display.press_key("haptrial", ' ');
      } catch (const std::runtime_error&) {  // not open yet, or closed
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  });
  run_session(asked);
  over = true;
  person.join();
  const record::SessionReader file(folder_ / "S01.h5");
  expect_as_presented(file, MarkerOutput::kScreen);
  const auto frames = file.frames();
  std::vector<double> latencies;
  for (const MarkerRow& row : markers_by(file, MarkerOutput::kScreen)) {
    ASSERT_GE(row.frame, 0);
    ASSERT_LT(row.frame, static_cast<std::int64_t>(frames.size()));
    const record::FrameRow& frame = frames[static_cast<std::size_t>(row.frame)];
    EXPECT_NEAR(row.written, 1e-9 * static_cast<double>(frame.time_ns), 1e-9);
    EXPECT_GT(frame.time_ns, row.time_ns) << "a frame that follows the onset";
    latencies.push_back(1e3 * row.latency);
  }
  std::printf("tick to the swap: median %.1f ms, largest %.1f ms\n", quantile(latencies, 0.5),
              quantile(latencies, 1.0));
}

}  // namespace
}  // namespace haptrial::experiments::session_markers_test
