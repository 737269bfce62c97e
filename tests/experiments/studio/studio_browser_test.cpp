// The studio in a real browser, and as a command.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "core/base/file_text.h"
#include "experiments/studio/studio.h"
#include "tests/experiments/browser.h"
#include "tests/experiments/command.h"
#include "tests/experiments/live_command.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace haptrial::studio_browser_test {
namespace {

namespace fs = std::filesystem;
using experiments::Studio;
using experiments::StudioOptions;
using testing::ElementsAre;
using testing::HasSubstr;

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
  EXPECT_THAT(test::run_command("TMPDIR=/nowhere/at/all haptrial studio . --no-browser").errors,
              HasSubstr("the folder for temporary files, which TMPDIR names, is not there"));
}

constexpr std::array kPictures{"studio-home.png",    "studio-mistake.png", "studio-preview.png",
                               "studio-jobs.png",    "studio-report.png",  "studio-checklist.png",
                               "studio-session.png", "studio-results.png"};

/// Folder for the pictures of docs/guide-studio.md.
const char* kept_pictures() { return std::getenv("HAPTRIAL_KEEP_PICTURES"); }

/// Sits at the participant's window and answers, between what the script prints.
class Participant {
 public:
  explicit Participant(const test::VirtualDisplay& display) : display_(display) {}
  void hear(const std::string& line) {
    if (line == "sits down\n") {
      sits_ = true;
      hand_ = std::jthread([this] { answer(); });
    } else if (line == "gets up\n") {
      sits_ = false;
    }
  }
  ~Participant() { sits_ = false; }
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

 private:
  void answer() const {
    constexpr std::chrono::milliseconds kPause(300);
    for (int presses = 0; sits_; ++presses) {
      display_.try_key("haptrial", presses % 3 == 0 ? '2' : '1');
      std::this_thread::sleep_for(kPause);
    }
  }

  const test::VirtualDisplay& display_;
  std::atomic<bool> sits_{false};
  std::jthread hand_;
};

/// A study with scripts in all that the page shows of it.
void make_hostile_study(const fs::path& studies) {
  const std::string script = "</script><script>parent.hit = top.hit = 1</script>";
  const test::CommandResult made =
      test::run_command("cd '" + studies.string() + "' && haptrial new evil.toml");
  EXPECT_EQ(made.status, 0) << made.errors;
  std::string text = file_text(studies / "evil.toml");
  text += "# " + script + "\n";
  text.replace(text.find("Did it pull?"), 12, script);
  write_text(studies / "evil.toml", text);
  fs::create_directories(studies / "out/evil");
  write_text(studies / "out/evil/report.html", "<!doctype html><title>evil</title>" + script);
  write_text(studies / "out/evil/<img src=x onerror=hit=1>.h5", script);
}

TEST(StudioBrowserTest, AStudyFromTheGalleryToItsReport) {
  const test::VirtualDisplay display(1024, 768);
  const test::TemporaryFolder home;
  const fs::path studies = home / "my_studies";
  fs::create_directory(studies);
  const test::TemporaryFolder pictures;
  const test::TemporaryFolder empty;
  const test::CommandResult made = test::run_command(
      "cd '" + studies.string() +
      "' && haptrial new other.toml && mv other.toml '<img src=x onerror=alert(1)>.toml'");
  ASSERT_EQ(made.status, 0) << made.errors;
  make_hostile_study(studies);
  StudioOptions options;
  options.folder = studies;
  options.program = HAPTRIAL_BINARY_DIR "/haptrial";
  const Studio studio(options);
  options.libraries = empty.path();
  const Studio plain(options);
  Participant participant(display);
  EXPECT_EQ(
      test::run_browser("studio_browser.py",
                        {studio.url(), plain.url(), pictures.path().string(), studies.string()},
                        [&](const std::string& line) { participant.hear(line); }),
      0);
  EXPECT_TRUE(fs::exists(studies / "out/pulls/P01.h5"));
  EXPECT_TRUE(fs::exists(studies / "out/pulls/report.html"));
  EXPECT_THAT(file_text(studies / "pulls.toml"), HasSubstr("participants = 4\n"));
  EXPECT_TRUE(fs::exists(studies / "out/pulls-rehearsal-001/report.html"));
  EXPECT_THAT(studio.refusals(), ElementsAre(HasSubstr("was changed by another program"),
                                             HasSubstr("a session is running already")));
  for (const char* picture : kPictures) {
    ASSERT_TRUE(fs::exists(pictures / picture)) << picture;
    EXPECT_GT(fs::file_size(pictures / picture), 10'000u) << picture;
    if (kept_pictures() != nullptr) {
      fs::copy(pictures / picture, kept_pictures(), fs::copy_options::overwrite_existing);
    }
  }
}

TEST(StudioBrowserTest, NoViewBreaksARuleOfAccessibility) {
  const test::TemporaryFolder folder;
  const test::TemporaryFolder pictures;
  const test::CommandResult made = test::run_command(
      "cd '" + folder.path().string() +
      "' && haptrial new pulls.toml && haptrial dry-run pulls.toml --subjects 2 --out out/pulls && "
      "haptrial analyze out/pulls && haptrial show pulls.toml --out preview.html && "
      "haptrial start pulls.toml --device mouse --card card.html");
  ASSERT_EQ(made.status, 0) << made.errors;
  StudioOptions options;
  options.folder = folder.path();
  options.program = HAPTRIAL_BINARY_DIR "/haptrial";
  const Studio studio(options);
  const int found = test::run_browser(
      "accessibility_browser.py",
      {studio.url(), folder.path().string(), pictures.path().string(), HAPTRIAL_BINARY_DIR});
  if (found == 3) {
    GTEST_SKIP() << "no network, so no axe-core";
  }
  EXPECT_EQ(found, 0);
}

}  // namespace
}  // namespace haptrial::studio_browser_test
