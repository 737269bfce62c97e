// The studio in a real browser, and as a command.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "core/base/file_text.h"
#include "experiments/studio/studio.h"
#include "tests/experiments/browser.h"
#include "tests/experiments/command.h"
#include "tests/experiments/live_command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::studio_browser_test {
namespace {

namespace fs = std::filesystem;
using experiments::Studio;
using experiments::StudioOptions;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(StudioCommandTest, ServesUntilItIsInterrupted) {
  const test::TemporaryFolder folder;
  test::LiveCommand studio("studio '" + folder.path().string() + "' --no-browser");
  const std::string url = studio.line_after("studio: ");
  EXPECT_THAT(url, testing::MatchesRegex("http://127.0.0.1:[0-9]+/.token=[0-9a-f]+"));
  studio.signal(SIGINT);
  EXPECT_EQ(studio.wait().status, 0);
  const test::CommandResult none = test::run_command("haptrial studio /nowhere/at/all");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.errors, HasSubstr("/nowhere/at/all: not a folder"));
}

/// Folder for the pictures of docs/guide-studio.md.
const char* kept_pictures() { return std::getenv("HAPTRIAL_KEEP_PICTURES"); }

TEST(StudioBrowserTest, AStudyFromTheGalleryToItsReport) {
  const test::TemporaryFolder home;
  const fs::path studies = home / "my_studies";
  fs::create_directory(studies);
  const test::TemporaryFolder pictures;
  const test::TemporaryFolder empty;
  const test::CommandResult made = test::run_command(
      "cd '" + studies.string() +
      "' && haptrial new other.toml && mv other.toml '<img src=x onerror=alert(1)>.toml'");
  ASSERT_EQ(made.status, 0) << made.errors;
  StudioOptions options;
  options.folder = studies;
  options.program = HAPTRIAL_BINARY_DIR "/haptrial";
  const Studio studio(options);
  options.libraries = empty.path();
  const Studio plain(options);
  EXPECT_EQ(
      test::run_browser("studio_browser.py", {studio.url(), plain.url(), pictures.path().string()}),
      0);
  EXPECT_THAT(file_text(studies / "pulls.toml"), HasSubstr("participants = 4\n"));
  EXPECT_TRUE(fs::exists(studies / "out/pulls-rehearsal-001/report.html"));
  EXPECT_THAT(studio.refusals(), IsEmpty());
  for (const char* picture : {"studio-mistake.png", "studio-report.png"}) {
    ASSERT_TRUE(fs::exists(pictures / picture)) << picture;
    EXPECT_GT(fs::file_size(pictures / picture), 10'000u) << picture;
    if (kept_pictures() != nullptr) {
      fs::copy(pictures / picture, kept_pictures(), fs::copy_options::overwrite_existing);
    }
  }
}

}  // namespace
}  // namespace haptrial::studio_browser_test
