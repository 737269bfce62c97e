// The experimenter's console in a real browser, with a real session behind it: live_console.py
// clicks, `haptrial run --console` follows, and the session file holds what was done.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "tests/experiments/browser.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using record::PassRow;
using record::PassStatus;
using record::Phase;
using test::CommandResult;
using testing::HasSubstr;

/// Folder for the docs' pictures: passes at the shipped speed, pictures kept there, and a plot that
/// is full.
const char* kept_pictures() { return std::getenv("HAPTRIAL_KEEP_PICTURES"); }

class LiveConsoleTest : public testing::Test {
 protected:
  void SetUp() override {
    // Slow enough for a browser on a busy machine to do something within a pass; one pass comes to
    // its end.
    test::write_text(folder_ / "study.toml", kept_pictures() != nullptr
                                                 ? test::shipped_text()
                                                 : test::brisk_text({{"speed", "speed = 0.0015"}}));
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  static std::string outline(const PassRow& pass) {
    return "trial " + std::to_string(pass.trial) + " attempt " + std::to_string(pass.attempt) +
           (pass.phase == Phase::kTraining ? " training " : " test ") +
           (pass.status == PassStatus::kCompleted ? "completed" : "aborted");
  }
  static std::vector<std::string> texts_of(const record::SessionReader& reader,
                                           const std::string& kind) {
    std::vector<std::string> texts;
    for (const record::EventRow& event : reader.events()) {
      if (event.kind == kind) {
        texts.push_back(event.text);
      }
    }
    return texts;
  }

  test::TemporaryFolder folder_;
};

TEST_F(LiveConsoleTest, WhatIsClickedIsDoneAndIsInTheFile) {
  test::LiveCommand session("run '" + path("study.toml") + "' --subject S01 --out '" + path("out") +
                            "' --console");
  const std::string url = session.line_after("console: ");
  ASSERT_THAT(url, HasSubstr("http://127.0.0.1:")) << session.errors();
  EXPECT_EQ(test::run_browser("live_console.py", {url, folder_.path().string()}), 0);
  const CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("4 passes aborted"));

  const record::SessionReader reader(folder_ / "out/S01.h5");
  const record::Integrity integrity = record::check_session(reader);
  EXPECT_TRUE(integrity.ok) << testing::PrintToString(integrity.problems);
  const std::vector<PassRow> passes = reader.passes();
  std::vector<std::string> outlines;
  std::transform(passes.begin(), passes.end(), std::back_inserter(outlines), outline);
  ASSERT_THAT(outlines, testing::ElementsAre("trial 1 attempt 1 training completed",
                                             "trial 1 attempt 1 test aborted",
                                             "trial 1 attempt 2 training aborted",
                                             "trial 2 attempt 1 training aborted",
                                             "trial 2 attempt 2 training aborted"));
  EXPECT_THAT(texts_of(reader, "note"),
              testing::ElementsAre("trial 1: hand rested, \u00e9 <b>&amp;"));
  EXPECT_THAT(texts_of(reader, "emergency_stop"), testing::SizeIs(1));
  EXPECT_THAT(
      texts_of(reader, "aborted"),
      testing::ElementsAre(HasSubstr("trial 1: to be repeated"), HasSubstr("trial 1: skipped"),
                           HasSubstr("trial 2: emergency stop"),
                           HasSubstr("trial 2: the session was ended")));

  // Between the emergency stop and the next pass there is no force, from the very tick on.
  const std::uint64_t stopped = passes[3].last_sample;
  const auto after = reader.samples(stopped, passes[4].first_sample - stopped);
  EXPECT_GT(after.size(), 400u);
  for (const record::Sample& sample : after) {
    ASSERT_EQ(sample.force.norm(), 0.0) << sample.sequence;
  }
  EXPECT_GT(reader.samples(stopped - 1, 1).front().force.norm(), 0.0);

  const CommandResult info = test::run_command("haptrial info '" + path("out/S01.h5") + "'");
  EXPECT_EQ(info.status, 0) << info.output;
  EXPECT_THAT(info.output, HasSubstr("passes      5, 4 aborted"));
  EXPECT_THAT(info.output, HasSubstr("hand rested, \u00e9 <b>&amp;"));
  EXPECT_THAT(info.output, HasSubstr("emergency_stop"));

  for (const char* picture : {"console-running.png", "console-stopped.png"}) {
    ASSERT_TRUE(fs::exists(folder_ / picture)) << picture;
    EXPECT_GT(fs::file_size(folder_ / picture), 10'000u) << picture;
    if (kept_pictures() != nullptr) {
      fs::copy(folder_ / picture, kept_pictures(), fs::copy_options::overwrite_existing);
    }
  }
}

}  // namespace
}  // namespace haptrial
