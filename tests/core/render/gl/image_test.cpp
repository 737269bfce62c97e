#include "core/render/gl/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial::render {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class WritePngTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("write_png_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_;
};

Image noise(int width, int height) {
  RandomStream random(7, "noise");
  Image image{width, height,
              std::vector<std::uint8_t>(static_cast<std::size_t>(width * height * 3))};
  for (std::uint8_t& byte : image.rgb) {
    byte = static_cast<std::uint8_t>(random.below(256));
  }
  return image;
}

Image read_png(const fs::path& path) {
  png_image description{};
  description.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&description, path.c_str()), 0) << description.message;
  EXPECT_EQ(description.format & PNG_FORMAT_FLAG_ALPHA, 0u);
  description.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(description.width), static_cast<int>(description.height),
              std::vector<std::uint8_t>(PNG_IMAGE_SIZE(description))};
  EXPECT_NE(png_image_finish_read(&description, nullptr, image.rgb.data(), 0, nullptr), 0);
  return image;
}

template <class Error>
std::string message_of(const fs::path& path, const Image& image) {
  try {
    write_png(path, image);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST_F(WritePngTest, ComesBackByteForByte) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{7, 3}, std::pair{64, 129}}) {
    const Image image = noise(width, height);
    write_png(folder_ / "picture.png", image);
    const Image back = read_png(folder_ / "picture.png");
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.height, height);
    EXPECT_EQ(back.rgb, image.rgb);
  }
  EXPECT_EQ(files(), 1) << "the temporary file is still there";
}

TEST_F(WritePngTest, SaysWhereItCannotWrite) {
  const Image image = noise(4, 4);
  const fs::path absent = folder_ / "absent" / "picture.png";
  EXPECT_THAT(message_of<InputError>(absent, image),
              testing::AllOf(HasSubstr(absent.string()), HasSubstr("No such file or directory"),
                             HasSubstr("choose a folder")));

  fs::create_directories(folder_ / "folder.png" / "inside");
  EXPECT_THAT(message_of<InputError>(folder_ / "folder.png", image), HasSubstr("folder.png"));
  EXPECT_EQ(files(), 1) << "a temporary file is left beside the folder";
}

/// A limit on the size of files fails a write half-way, as a full disk does.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST_F(WritePngTest, LeavesNothingHalfWrittenWhenTheDiskIsFull) {
  const Image old = noise(8, 8);
  write_png(folder_ / "old.png", old);
  std::string message_new;
  std::string message_old;
  {
    const FileSizeLimit limit(1000);
    message_new = message_of<RunError>(folder_ / "new.png", noise(64, 64));
    message_old = message_of<RunError>(folder_ / "old.png", noise(64, 64));
  }
  EXPECT_THAT(message_new, testing::AllOf(HasSubstr("new.png"), HasSubstr("not be written whole")));
  EXPECT_THAT(message_old, HasSubstr("old.png"));
  EXPECT_EQ(files(), 1);
  EXPECT_EQ(read_png(folder_ / "old.png").rgb, old.rgb) << "the older picture is lost";
}

TEST_F(WritePngTest, RejectsAnImageWhoseBytesDoNotFitItsSize) {
  Image image = noise(4, 4);
  image.rgb.pop_back();
  EXPECT_THROW(write_png(folder_ / "picture.png", image), std::invalid_argument);
  EXPECT_THROW(write_png(folder_ / "picture.png", Image{}), std::invalid_argument);
  EXPECT_THROW(write_png(folder_ / "picture.png", Image{-2, -2, {}}), std::invalid_argument);
  EXPECT_EQ(files(), 0);
}

}  // namespace
}  // namespace haptrial::render
