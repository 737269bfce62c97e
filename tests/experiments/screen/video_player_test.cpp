// A page's video: what it shows, in which order, and that it waits for its page.

#include "experiments/screen/video_player.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <thread>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "experiments/screen/video.h"
#include "tests/experiments/command.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::video_player_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int kPictures = 30;  // at 25 a second

/// The first half is red, the second blue.
fs::path make_video(const test::TemporaryFolder& folder) {
  const fs::path file = folder / "a video.mp4";
  VideoWriter video(file, 25);
  for (int i = 0; i < kPictures; ++i) {
    render::Image image{64, 48, std::vector<std::uint8_t>(64 * 48 * 3, 0)};
    for (std::size_t p = i < kPictures / 2 ? 0 : 2; p < image.rgb.size(); p += 3) {
      image.rgb[p] = 255;
    }
    video.add(image);
  }
  video.finish();
  return file;
}

bool is_red(const render::Image& image) { return image.rgb[0] > image.rgb[2]; }

/// Asks until there is another picture than before. Null: it is over.
std::shared_ptr<const render::Image> next_picture(VideoPlayer& player,
                                                  const std::shared_ptr<const render::Image>& had) {
  for (;;) {
    auto picture = player.picture();
    if (picture != had) {
      return picture;
    }
    if (player.is_over()) {
      return nullptr;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

TEST(VideoPlayerTest, ShowsEveryPictureInOrderAndEnds) {
  const test::TemporaryFolder folder;
  VideoPlayer player(make_video(folder), 1280, 720, "default");
  EXPECT_NEAR(player.facts().duration, kPictures / 25.0, 0.01);
  EXPECT_FALSE(player.facts().sound);
  EXPECT_EQ(player.silence(), "");
  int red = 0;
  int blue = 0;
  std::shared_ptr<const render::Image> picture;
  while (auto next = next_picture(player, picture)) {
    EXPECT_EQ(next->width, 64);
    EXPECT_EQ(next->height, 48);
    const bool first = is_red(*next);
    EXPECT_FALSE(first && blue > 0);
    (first ? red : blue) += 1;
    picture = next;
  }
  EXPECT_GT(red, 0);
  EXPECT_GT(blue, 0);
  EXPECT_LE(red + blue, kPictures);
  EXPECT_NEAR(player.played(), kPictures / 25.0, 0.041);
  EXPECT_EQ(player.picture(), picture) << "the last one stays";
}

TEST(VideoPlayerTest, WaitsWhileNobodyAsks) {
  const test::TemporaryFolder folder;
  VideoPlayer player(make_video(folder), 1280, 720, "default");
  ASSERT_NE(next_picture(player, nullptr), nullptr);
  const double before = player.played();
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  static_cast<void>(player.picture());
  EXPECT_LE(player.played() - before, 0.1 + 1e-9);
}

TEST(VideoPlayerTest, PicturesThatAreTooLargeAreMadeSmaller) {
  const test::TemporaryFolder folder;
  VideoPlayer player(make_video(folder), 32, 720, "default");
  const auto picture = next_picture(player, nullptr);
  ASSERT_NE(picture, nullptr);
  EXPECT_EQ(picture->width, 32);
  EXPECT_EQ(picture->height, 24);
}

TEST(VideoPlayerTest, SoundWithoutACardIsSaid) {
  const test::TemporaryFolder folder;
  const auto made = test::run_command(
      "ffmpeg -loglevel error -f lavfi -i color=red:s=64x48:d=1 -f lavfi -i sine=d=1 -shortest '" +
      (folder / "a.mp4").string() + "'");
  ASSERT_EQ(made.status, 0) << made.errors;
  VideoPlayer player(folder / "a.mp4", 1280, 720, "no such card");
  EXPECT_TRUE(player.facts().sound);
  EXPECT_THAT(player.silence(), HasSubstr("no such card"));
  EXPECT_NE(next_picture(player, nullptr), nullptr);
}

TEST(VideoPlayerTest, WhatIsNoVideoGetsASentence) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "a.mp4", "no video");
  EXPECT_THAT(test::message_of<InputError>([&] { video_facts(folder / "a.mp4"); }),
              HasSubstr("a.mp4: is no video; allowed: a file that ffmpeg can play"));
  EXPECT_THAT(test::message_of<InputError>([&] { video_facts(folder / "b.mp4"); }),
              HasSubstr("b.mp4: there is no such video"));
  EXPECT_THAT(test::message_of<InputError>(
                  [&] { video_facts(HAPTRIAL_SOURCE_DIR "/docs/algorithms/drilled-floor.png"); }),
              HasSubstr("is no video"));
}

}  // namespace
}  // namespace haptrial::experiments::video_player_test
