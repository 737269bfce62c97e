#include "experiments/screen/video.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/base/error.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using testing::HasSubstr;

render::Image grey(int width, int height, std::uint8_t shade) {
  const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3;
  return {width, height, std::vector<std::uint8_t>(size, shade)};
}

class VideoWriterTest : public testing::Test {
 protected:
  long files() const {
    return std::distance(std::filesystem::directory_iterator(folder_.path()), {});
  }
  test::TemporaryFolder folder_;
};

TEST_F(VideoWriterTest, PicturesComeBackAsTheyWent) {
  const auto file = folder_ / "shades.mp4";
  VideoWriter writer(file, 10);
  for (const int shade : {0, 128, 255}) {
    writer.add(grey(64, 48, static_cast<std::uint8_t>(shade)));
  }
  EXPECT_FALSE(std::filesystem::exists(file)) << "not before it is whole";
  writer.finish();
  // Decoded again to one grey pixel a picture.
  const test::CommandResult decoded =
      test::run_command("ffmpeg -v error -i '" + file.string() +
                        "' -vf scale=1:1 -f rawvideo -pix_fmt gray - | od -An -v -tu1 | xargs");
  EXPECT_EQ(decoded.status, 0) << decoded.errors;
  int shades[3] = {-1, -1, -1};
  ASSERT_EQ(std::sscanf(decoded.output.c_str(), "%d %d %d", shades, shades + 1, shades + 2), 3);
  EXPECT_NEAR(shades[0], 0, 3);
  EXPECT_NEAR(shades[1], 128, 3);
  EXPECT_NEAR(shades[2], 255, 3);
  EXPECT_EQ(files(), 1);
}

TEST_F(VideoWriterTest, LeavesNothingWithoutFinish) {
  {
    VideoWriter writer(folder_ / "x.mp4", 10);
    writer.add(grey(64, 48, 7));
  }
  EXPECT_EQ(files(), 0);
}

TEST_F(VideoWriterTest, NeverOverwritesAlsoWhenTheNameIsTakenMeanwhile) {
  const auto file = folder_ / "x.mp4";
  VideoWriter writer(file, 10);
  writer.add(grey(64, 48, 7));
  test::write_text(file, "precious");
  EXPECT_THROW(writer.finish(), InputError);
  EXPECT_EQ(test::read_text(file), "precious");
  try {
    const VideoWriter another(file, 10);
    FAIL() << "it was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("exists already; choose another name"));
  }
}

TEST_F(VideoWriterTest, FfmpegsOwnWordsReachTheUser) {
  const auto folder = folder_ / "gone";
  std::filesystem::create_directory(folder);
  VideoWriter writer(folder / "x.mp4", 10);
  std::filesystem::remove_all(folder);
  try {
    for (int i = 0; i < 1000; ++i) {  // more than the socket holds
      writer.add(grey(640, 480, 7));
    }
    writer.finish();
    FAIL() << "it was written";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("ffmpeg"));
    EXPECT_THAT(error.what(), HasSubstr("No such file or directory"));
  }
}

TEST_F(VideoWriterTest, OneSizeWithEvenSides) {
  VideoWriter odd(folder_ / "odd.mp4", 10);
  EXPECT_THROW(odd.add(grey(63, 48, 0)), std::invalid_argument);
  VideoWriter writer(folder_ / "x.mp4", 10);
  writer.add(grey(64, 48, 0));
  EXPECT_THROW(writer.add(grey(64, 50, 0)), std::invalid_argument);
  VideoWriter empty(folder_ / "empty.mp4", 10);
  EXPECT_THROW(empty.finish(), RunError);
}

}  // namespace
}  // namespace haptrial::experiments
