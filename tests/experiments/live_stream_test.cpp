// `haptrial run --lsl`: with a library of that name on the loader's path, and with none.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "core/record/integrity.h"
#include "core/record/session_reader.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::LiveCommand;
using testing::ElementsAre;
using testing::HasSubstr;

using Fields = std::vector<std::string>;

/// What the stand-in library wrote: for each stream its head, then a row a sample or text.
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
  std::string run() const {
    return "run '" + (folder_ / "study.toml").string() + "' --subject S01 --trials 1 --out '" +
           (folder_ / "out").string() + "' --lsl";
  }
  fs::path file() const { return folder_ / "out/S01.h5"; }
  test::TemporaryFolder folder_;
};

TEST_F(LiveStreamTest, SamplesAndMarkersArriveInALibraryThatTheLoaderFinds) {
  const fs::path library = fs::path(HAPTRIAL_BINARY_DIR) / "libstand_in_lsl.so";
  ASSERT_TRUE(fs::exists(library));
  fs::create_directory(folder_ / "lib");
  fs::create_symlink(library, folder_ / "lib/liblsl.so");
  const CommandResult ended =
      LiveCommand(run(), "export LD_LIBRARY_PATH='" + (folder_ / "lib").string() +
                             "' STAND_IN_LSL_FILE='" + (folder_ / "heard").string() + "'")
          .wait(40.0);
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
    ASSERT_EQ(heard.size(), 16u);
    EXPECT_EQ(heard[1], std::to_string(rows[i].sequence));
    EXPECT_NEAR(std::stod(heard[2]), rows[i].position.x(), 1e-6);
    EXPECT_NEAR(std::stod(heard[11]), rows[i].applied_force, 1e-3);
    EXPECT_NEAR(std::stod(heard[12]), rows[i].target_force, 1e-3);
    const double elapsed = std::stod(heard[0]) - std::stod(samples[1][0]);
    EXPECT_NEAR(elapsed, 1e-9 * static_cast<double>(rows[i].time_ns - rows[0].time_ns), 1e-6);
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
  EXPECT_EQ(heard, expected);
  EXPECT_GE(heard.size(), 2u) << "the start and the end";
}

TEST_F(LiveStreamTest, WithoutTheLibraryTheSessionGoesOnAndSaysSo) {
  const CommandResult ended = LiveCommand(run()).wait(40.0);
  ASSERT_EQ(ended.status, 0) << ended.errors;
  if (ended.output.find("liblsl.so") == std::string::npos) {
    GTEST_SKIP() << "the layer is installed here";
  }
  EXPECT_THAT(ended.output, HasSubstr("the session goes on without its streams"));
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
