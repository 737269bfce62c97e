// `haptrial run --lsl`: with a library of that name on the loader's path, and with none.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <sstream>
#include <thread>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/marker_row.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::LiveCommand;
using testing::ElementsAre;
using testing::HasSubstr;

using Fields = std::vector<std::string>;

/// Streams that the stand-in library wrote: for each its head, then a row a sample or text.
std::vector<std::vector<Fields>> streams_in(const fs::path& file) {
  std::istringstream text(test::read_text(file));
  std::vector<std::vector<Fields>> streams;
  for (std::string line; std::getline(text, line);) {
    Fields fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, '\t');) {
      fields.push_back(field);
    }
    if (fields.at(0) == "stream") {
      streams.emplace_back();
    }
    streams.back().push_back(fields);
  }
  return streams;
}

class LiveStreamTest : public testing::Test {
 protected:
  LiveStreamTest() { test::write_text(folder_ / "study.toml", test::brisk_text()); }
  std::string run(const std::string& options = "--lsl") const {
    return "run '" + (folder_ / "study.toml").string() + "' --subject S01 --trials 1 --out '" +
           (folder_ / "out").string() + "' " + options;
  }
  /// Environment with a library of that name on the loader's path.
  std::string with_the_layer() const {
    fs::create_directory(folder_ / "lib");
    fs::create_symlink(fs::path(HAPTRIAL_BINARY_DIR) / "libstand_in_lsl.so",
                       folder_ / "lib/liblsl.so");
    return "export LD_LIBRARY_PATH='" + (folder_ / "lib").string() + "' STAND_IN_LSL_FILE='" +
           (folder_ / "heard").string() + "'";
  }
  /// Environment without one: an empty file of that name hides a library that the machine has.
  std::string without_the_layer() const {
    fs::create_directory(folder_ / "lib");
    test::write_text(folder_ / "lib/liblsl.so", "");
    return "export LD_LIBRARY_PATH='" + (folder_ / "lib").string() + "'";
  }
  fs::path file() const { return folder_ / "out/S01.h5"; }
  /// The least time from a sample to its arrival. A sample cannot arrive before it was taken, and
  /// of hundreds of pushes some come at once, however busy the machine is. [s]
  static double least_delay(const std::vector<Fields>& samples) {
    double least = 1e9;
    for (std::size_t i = 1; i < samples.size(); ++i) {
      least = std::min(least, std::stod(samples[i].back()) - std::stod(samples[i].front()));
    }
    return least;
  }
  test::TemporaryFolder folder_;
};

TEST_F(LiveStreamTest, SamplesAndMarkersArriveInALibraryThatTheLoaderFinds) {
  const CommandResult ended = LiveCommand(run(), with_the_layer()).wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const auto streams = streams_in(folder_ / "heard");
  ASSERT_EQ(streams.size(), 2u);
  const auto& samples = streams[0];
  const auto& markers = streams[1];
  EXPECT_THAT(samples[0], ElementsAre("stream", "haptrial S01", "Haptics", "15", "1000"));
  EXPECT_THAT(markers[0], ElementsAre("stream", "haptrial S01 markers", "Markers", "1", "0"));

  // Every row of the file came through, in its order.
  const record::SessionReader reader(file());
  ASSERT_EQ(samples.size() - 1, reader.sample_count());
  const auto rows = reader.samples(0, reader.sample_count());
  for (std::size_t i = 0; i < rows.size(); i += 97) {
    const Fields& heard = samples[i + 1];
    ASSERT_EQ(heard.size(), 17u);
    EXPECT_EQ(heard[1], std::to_string(rows[i].sequence));
    EXPECT_NEAR(std::stod(heard[2]), rows[i].position.x(), 1e-6);
    EXPECT_NEAR(std::stod(heard[11]), rows[i].applied_force, 1e-3);
    EXPECT_NEAR(std::stod(heard[12]), rows[i].target_force, 1e-3);
    const double elapsed = std::stod(heard[0]) - std::stod(samples[1][0]);
    EXPECT_NEAR(elapsed, 1e-9 * static_cast<double>(rows[i].time_ns - rows[0].time_ns), 1e-3);
  }
  // Every event is a marker.
  std::vector<std::string> expected;
  for (const record::EventRow& event : reader.events()) {
    expected.push_back(event.kind + (event.text.empty() ? "" : ": " + event.text));
  }
  std::vector<std::string> heard;
  for (std::size_t i = 1; i < markers.size(); ++i) {
    heard.push_back(markers[i].at(1));
  }
  for (const std::string& event : expected) {
    EXPECT_THAT(heard, testing::Contains(event));
  }
  EXPECT_GE(expected.size(), 2u) << "the start and the end";
}

/// Onsets arrive for every protocol: the study of force curves has the stages of its passes.
TEST_F(LiveStreamTest, OnsetsArriveWithTheirCodes) {
  test::write_text(folder_ / "study.toml", test::brisk_text() + "\n[markers]\nstage = 41\n");
  const CommandResult ended = LiveCommand(run(), with_the_layer()).wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  std::vector<std::string> heard;
  const auto streams = streams_in(folder_ / "heard");
  for (const Fields& row : streams.at(1)) {
    if (row.size() > 1 && row[1].starts_with("onset: ")) {
      heard.push_back(row[1]);
    }
  }
  const record::SessionReader reader(file());
  const auto rows = reader.rows<record::MarkerRow>();
  ASSERT_FALSE(rows.empty());
  ASSERT_EQ(heard.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const record::MarkerRow& row = rows[i];
    EXPECT_EQ(row.way, record::MarkerOutput::kStream);
    EXPECT_GE(row.latency, 0.0);
    EXPECT_EQ(heard[i], "onset: what=" + std::string(record::name_of(row.what)) +
                            " name=" + row.name + " code=" + std::to_string(row.code) +
                            " trial=1 interval=0 pass=" + std::to_string(row.pass));
    const record::Sample sample = reader.samples(row.sequence, 1).front();
    EXPECT_EQ(sample.time_ns, row.time_ns);
    if (row.what == record::MarkerOf::kStage) {
      EXPECT_EQ(row.code, 40 + static_cast<int>(sample.stage));
      EXPECT_NE(reader.samples(row.sequence - 1, 1).front().stage, sample.stage);
    }
  }
  EXPECT_THAT(ended.output, HasSubstr("markers, stream: " + std::to_string(rows.size())));
}

TEST_F(LiveStreamTest, TimesAreThoseOfTheSamplesFromTheFirstOneOn) {
  const CommandResult ended = LiveCommand(run(), with_the_layer()).wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const double delay = least_delay(streams_in(folder_ / "heard").at(0));
  EXPECT_GE(delay, 0.0) << "it would have arrived before it was taken";
  EXPECT_LT(delay, 1.0) << "the stream's times are that early";
}

TEST_F(LiveStreamTest, TimesHoldAfterASuspension) {
  LiveCommand session(run(), with_the_layer());
  test::wait_until([&] {
    std::error_code ignored;
    const fs::path partial = file().string() + ".partial";
    return fs::exists(partial, ignored) && record::SessionReader(partial).sample_count() > 1000;
  });
  session.signal(SIGSTOP);
  std::this_thread::sleep_for(std::chrono::seconds(2));
  session.signal(SIGCONT);
  const CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const auto streams = streams_in(folder_ / "heard");
  auto after = streams.at(0);
  after.erase(after.begin() + 1, after.end() - 500);
  const double delay = least_delay(after);
  EXPECT_GE(delay, 0.0);
  EXPECT_LT(delay, 1.0) << "the times lack the suspension of two seconds";
  // Events of the file are on the clock of its samples.
  const record::SessionReader reader(file());
  const auto last = reader.samples(reader.sample_count() - 1, 1).front();
  EXPECT_EQ(reader.events().back().kind, "session_end");
  EXPECT_GE(reader.events().back().time_ns, last.time_ns);
}

TEST_F(LiveStreamTest, TrialsPassesAndStagesAreMarkedAtTheTicksWithWhichTheyBegin) {
  const CommandResult ended = LiveCommand(run(), with_the_layer()).wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const auto streams = streams_in(folder_ / "heard");
  std::vector<std::string> kinds;
  std::string run_began;
  for (std::size_t i = 1; i < streams.at(1).size(); ++i) {
    const std::string& text = streams[1][i].at(1);
    const std::string kind = text.substr(0, text.find(':'));
    if (kind.starts_with("trial") || kind.starts_with("pass")) {
      kinds.push_back(text.substr(0, text.find(" condition=")));
    }
    if (text.starts_with("stage: pass=1 phase=test stage=run")) {
      run_began = streams[1][i].at(0);
    }
  }
  const std::string fields = "trial=1 practice=0 attempt=1 block=1 repetition=1";
  EXPECT_THAT(kinds,
              ElementsAre("trial_begin: " + fields, "pass_begin: pass=0 phase=training " + fields,
                          "pass_end: pass=0 phase=training status=completed " + fields,
                          "pass_begin: pass=1 phase=test " + fields,
                          "pass_end: pass=1 phase=test status=completed " + fields,
                          "trial_end: status=completed " + fields));
  const record::SessionReader reader(file());
  const auto pass = reader.passes().at(1);
  const auto rows = reader.samples(pass.first_sample, pass.last_sample - pass.first_sample + 1);
  const auto first = std::find_if(rows.begin(), rows.end(),
                                  [](const auto& row) { return row.stage == record::Stage::kRun; });
  ASSERT_NE(first, rows.end());
  ASSERT_FALSE(run_began.empty());
  EXPECT_NEAR(std::stod(run_began), std::stod(streams[0].at(first->sequence + 1).at(0)), 1e-3);
}

TEST_F(LiveStreamTest, WithoutTheLibraryTheSessionIsRefusedBeforeItBegins) {
  const CommandResult ended = LiveCommand(run(), without_the_layer()).wait();
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.errors, HasSubstr("liblsl.so"));
  EXPECT_THAT(ended.errors, HasSubstr("--lsl-optional runs the session without streams"));
  EXPECT_FALSE(fs::exists(file()));
  EXPECT_FALSE(fs::exists(file().string() + ".partial"));
}

TEST_F(LiveStreamTest, WhereTheStreamsAreOptionalTheSessionGoesOnAndSaysSoBeforeItBegins) {
  const CommandResult ended = LiveCommand(run("--lsl-optional"), without_the_layer()).wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const auto said = ended.output.find("the session continues without its streams");
  ASSERT_NE(said, std::string::npos);
  EXPECT_LT(said, ended.output.find("trial 1 of 1")) << "before the first trial";
  const record::SessionReader reader(file());
  EXPECT_TRUE(record::check_session(reader).ok);
  EXPECT_EQ(reader.passes().size(), 2u);
  int notices = 0;
  for (const record::EventRow& event : reader.events()) {
    notices += event.kind == "notice" && event.text.find("liblsl.so") != std::string::npos;
  }
  EXPECT_EQ(notices, 1);
}

}  // namespace
}  // namespace haptrial
