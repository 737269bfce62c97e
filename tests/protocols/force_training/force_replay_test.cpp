#include "protocols/force_training/force_replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <regex>

#include "core/base/error.h"
#include "core/record/hdf5/session_writer.h"
#include "experiments/runner/session.h"
#include "protocols/force_training/force_protocol.h"
#include "tests/experiments/command.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using record::Phase;
using testing::HasSubstr;

/// Largest difference of a colour channel between two pictures on file; 255 where sizes differ.
int largest_difference(const fs::path& a, const fs::path& b) {
  const auto bytes = [](const fs::path& file) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    png_image_begin_read_from_file(&image, file.c_str());
    image.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(image));
    png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr);
    return rgb;
  };
  const auto x = bytes(a);
  const auto y = bytes(b);
  int largest = x.size() == y.size() && !x.empty() ? 0 : 255;
  for (std::size_t i = 0; largest < 255 && i < x.size(); ++i) {
    largest = std::max(largest, std::abs(int{x[i]} - int{y[i]}));
  }
  return largest;
}

constexpr int kFramesPerPass = 3;
constexpr int kTrials = 2;

/// A session of two short trials, with the pictures that were drawn while it ran.
class ReplayTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    const protocols::ForceDefinition definition = protocols::parse_force_definition(
        test::shipped_with("speed", "speed = 0.05"), "brief.toml");
    SessionRequest request =
        test::session_request(protocols::force_training(), definition, session(), 4);
    request.participant = 1;
    request.frames_per_pass = kFramesPerPass;
    request.frames_folder = *folder_ / "live";
    fs::create_directory(request.frames_folder);
    request.max_trials = kTrials;
    run_session(request);
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static fs::path session() { return *folder_ / "S01.h5"; }
  static std::string quoted(const fs::path& path) { return " '" + path.string() + "'"; }

  static test::TemporaryFolder* folder_;
};
test::TemporaryFolder* ReplayTest::folder_ = nullptr;

TEST_F(ReplayTest, EveryPictureIsTheOneThatWasDrawnLive) {
  for (int trial = 1; trial <= kTrials; ++trial) {
    protocols::ForceReplay replay(session(), trial, std::nullopt);
    ASSERT_EQ(replay.passes(), 2u);
    const std::string condition = record::SessionReader(session()).passes()[0].condition;
    for (std::size_t pass = 0; pass < 2; ++pass) {
      const auto& seen = replay.seen(pass);
      for (int number = 1; number <= kFramesPerPass; ++number) {
        // The first tick past the middle of its third of the run was kept.
        const double progress = (number - 0.5) / kFramesPerPass;
        const auto tick = std::ranges::find_if(
            seen, [progress](const auto& p) { return p.progress >= progress; });
        ASSERT_NE(tick, seen.end());
        const fs::path again = *folder_ / "again.png";
        render::write_png(
            again, replay.trial_picture(pass, static_cast<std::size_t>(tick - seen.begin())));
        const std::string kind = pass == 0 ? condition : "test";
        const fs::path live = *folder_ / "live" /
                              ("S01-trial0" + std::to_string(trial) + "-" + kind + "-0" +
                               std::to_string(number) + ".png");
        ASSERT_TRUE(fs::exists(live)) << live;
        // The file rounds positions and forces; at a shape's edge that may turn a rounding of one.
        EXPECT_LE(largest_difference(again, live), 2) << live;
      }
    }
    EXPECT_EQ(replay.notice(), "");
  }
}

TEST_F(ReplayTest, AWholePictureIsTheTrialsWithThePanelBelow) {
  protocols::ForceReplay replay(session(), 1, Phase::kTraining);
  const auto& seen = replay.seen(0);
  const double time = 0.5 * replay.duration();
  const render::Image whole = replay.draw(time);
  EXPECT_EQ(whole.width, 1280);
  EXPECT_EQ(whole.height, 720 + protocols::ForceReplay::kPanelHeight);
  const auto tick = static_cast<std::size_t>(std::floor(time * 1000.0 + 1e-6));
  ASSERT_LT(tick, seen.size());
  const render::Image trial = replay.trial_picture(0, tick);
  EXPECT_TRUE(std::equal(trial.rgb.begin(), trial.rgb.end(), whole.rgb.begin()));
  const std::vector<std::uint8_t> panel(
      whole.rgb.begin() + static_cast<std::ptrdiff_t>(trial.rgb.size()), whole.rgb.end());
  const render::Image later = replay.draw(0.7 * replay.duration());
  EXPECT_FALSE(std::equal(panel.begin(), panel.end(),
                          later.rgb.begin() + static_cast<std::ptrdiff_t>(trial.rgb.size())))
      << "the curves have grown";
}

TEST_F(ReplayTest, PhasesFollowOneAnother) {
  const double training = protocols::ForceReplay(session(), 1, Phase::kTraining).duration();
  const double test = protocols::ForceReplay(session(), 1, Phase::kTest).duration();
  EXPECT_NEAR(protocols::ForceReplay(session(), 1, std::nullopt).duration(), training + test, 1e-9);
  const auto passes = record::SessionReader(session()).passes();
  EXPECT_NEAR(training, 1e-3 * static_cast<double>(passes[0].last_sample - passes[0].first_sample),
              1e-6);
}

TEST_F(ReplayTest, TheRecordedStimulusWinsOverOneThatIsMadeAnew) {
  // The same session, but with a path on file that no seed gives.
  const record::SessionReader reader(session());
  const fs::path other = *folder_ / "other.h5";
  {
    record::SessionWriter writer(other, reader.info());
    std::vector<record::StimulusRow> rows = reader.stimuli();
    for (record::StimulusRow& row : rows) {
      row.position.z() = 0.0;
      row.force = 2.0;
    }
    writer.add_stimulus(rows);
    writer.append(reader.samples(0, reader.sample_count()));
    for (const record::PassRow& row : reader.passes()) {
      writer.add_pass(row);
    }
    writer.set_timing(reader.timing(), *reader.timing_summary());
    writer.close();
  }
  protocols::ForceReplay replay(other, 1, Phase::kTraining);
  EXPECT_THAT(replay.notice(), HasSubstr("block 1: drawn as recorded"));
  const std::size_t middle = replay.seen(0).size() / 2;
  EXPECT_NE(replay.trial_picture(0, middle).rgb,
            protocols::ForceReplay(session(), 1, Phase::kTraining).trial_picture(0, middle).rgb);
}

TEST_F(ReplayTest, BadTrialsAreRefusedWithThoseThatThereAre) {
  for (const int trial : {0, -1, 3, 99}) {
    try {
      const protocols::ForceReplay replay(session(), trial, std::nullopt);
      FAIL() << trial;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("--trial is " + std::to_string(trial)));
      EXPECT_THAT(error.what(), HasSubstr("allowed: 1 to 2"));
    }
  }
}

TEST_F(ReplayTest, TheCommandWritesPicturesAndOverwritesNothing) {
  const fs::path pictures = *folder_ / "pictures";
  const std::string line = "haptrial replay" + quoted(session()) +
                           " --trial 1 --phase test --fps 1 --frames" + quoted(pictures);
  const test::CommandResult first = test::run_command(line);
  EXPECT_EQ(first.status, 0) << first.errors;
  const double duration = protocols::ForceReplay(session(), 1, Phase::kTest).duration();
  const auto count = std::distance(fs::directory_iterator(pictures), {});
  EXPECT_EQ(count, static_cast<long>(std::floor(duration)) + 1);
  const fs::path picture = *folder_ / "one.png";
  render::write_png(picture, protocols::ForceReplay(session(), 1, Phase::kTest).draw(2.0));
  EXPECT_TRUE(test::read_text(picture) == test::read_text(pictures / "frame-00003.png"));
  const test::CommandResult second = test::run_command(line);
  EXPECT_EQ(second.status, 2);
  EXPECT_THAT(second.errors, HasSubstr("choose a new folder"));
}

TEST_F(ReplayTest, TheCommandsBadInputGetsASentence) {
  const std::string file = quoted(session());
  const auto errors = [&](const std::string& rest, int status = 2) {
    const test::CommandResult result = test::run_command("haptrial replay" + file + " " + rest);
    EXPECT_EQ(result.status, status) << rest;
    return result.errors;
  };
  const std::string video = " --video" + quoted(*folder_ / "x.mp4");
  EXPECT_THAT(errors("--trial 1"), HasSubstr("neither --video nor --frames is given; add one"));
  EXPECT_THAT(errors("--trial 7" + video), HasSubstr("--trial is 7; allowed: 1 to 2"));
  EXPECT_THAT(errors("--trial 1 --phase rest" + video), HasSubstr("allowed: training, test"));
  EXPECT_THAT(errors("--trial 1 --fps 0" + video), HasSubstr("--fps is 0; allowed:"));
  EXPECT_THAT(errors("--trial 1 --video x.avi"),
              HasSubstr("is not a video by its name; allowed: .mp4"));
  EXPECT_THAT(errors("--trial 1 --video /nowhere/x.mp4"), HasSubstr("/nowhere/x.mp4"));
  EXPECT_FALSE(fs::exists(*folder_ / "x.mp4"));
}

TEST_F(ReplayTest, WithoutFfmpegThereIsASentenceAndNoFile) {
  const test::CommandResult result =
      test::run_command("PATH=/nowhere \"$HAPTRIAL\" replay" + quoted(session()) +
                        " --trial 1 --video" + quoted(*folder_ / "none.mp4"));
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, HasSubstr("ffmpeg is not installed"));
  EXPECT_FALSE(fs::exists(*folder_ / "none.mp4"));
}

TEST_F(ReplayTest, AVideoLastsAsLongAsItsTrial) {
  const fs::path video = *folder_ / "trial.mp4";
  const test::CommandResult made = test::run_command(
      "haptrial replay" + quoted(session()) + " --trial 2 --fps 5 --video" + quoted(video) +
      " && ffprobe -v error -count_frames -show_entries " +
      "format=duration:stream=width,height,nb_read_frames -of csv=p=0" + quoted(video));
  ASSERT_EQ(made.status, 0) << made.errors;
  std::smatch found;
  const std::regex probed("1280,960,([0-9]+)\n([0-9.]+)\n");
  ASSERT_TRUE(std::regex_search(made.output, found, probed)) << made.output;
  const double duration = protocols::ForceReplay(session(), 2, std::nullopt).duration();
  EXPECT_NEAR(std::stod(found[2]), duration, 1.0 / 5.0);
  EXPECT_EQ(std::stoi(found[1]), static_cast<int>(std::floor(duration * 5.0)) + 1);
  for (const auto& entry : fs::directory_iterator(folder_->path())) {
    EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
  }
}

}  // namespace
}  // namespace haptrial::experiments
