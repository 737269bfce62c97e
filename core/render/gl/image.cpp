#include "core/render/gl/image.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"

namespace haptrial::render {
namespace {

constexpr int kChannels = 3;

std::vector<std::uint8_t> encoded(const Image& image) {
  png_image description{};
  description.version = PNG_IMAGE_VERSION;
  description.width = static_cast<png_uint_32>(image.width);
  description.height = static_cast<png_uint_32>(image.height);
  description.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> bytes(PNG_IMAGE_PNG_SIZE_MAX(description));
  png_alloc_size_t size = bytes.size();
  const bool done = png_image_write_to_memory(&description, bytes.data(), &size, 0,
                                              image.rgb.data(), 0, nullptr) != 0;
  png_image_free(&description);
  if (!done) {
    throw RunError(fmt::format("a picture of {} x {} pixels cannot be encoded as PNG: {}",
                               image.width, image.height, description.message));
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace

Image coarser(const Image& fine, int times) {
  Image image{fine.width / times, fine.height / times, {}};
  const std::size_t wide = 3 * static_cast<std::size_t>(image.width);
  image.rgb.reserve(wide * static_cast<std::size_t>(image.height));
  const std::size_t fine_wide = 3 * static_cast<std::size_t>(fine.width);
  const auto block = static_cast<std::size_t>(times);
  std::vector<int> sums(wide);
  for (std::size_t row = 0; row < block * static_cast<std::size_t>(image.height); ++row) {
    const std::uint8_t* from = fine.rgb.data() + row * fine_wide;
    for (std::size_t x = 0; x < wide; x += 3) {
      for (std::size_t column = 0; column < block; ++column, from += 3) {
        sums[x] += from[0];
        sums[x + 1] += from[1];
        sums[x + 2] += from[2];
      }
    }
    if (row % block == block - 1) {
      for (int& sum : sums) {
        image.rgb.push_back(static_cast<std::uint8_t>(sum / (times * times)));
        sum = 0;
      }
    }
  }
  return image;
}

Image read_png(const std::filesystem::path& path) {
  refuse_special_file(path);
  constexpr png_uint_32 kLargest = 4096;
  png_image description{};
  description.version = PNG_IMAGE_VERSION;
  const auto refuse = [&](const std::string& why) {
    png_image_free(&description);
    throw InputError(fmt::format("{}: {}; give a picture in PNG format, at most {} x {} pixels",
                                 path.string(), why, kLargest, kLargest));
  };
  if (png_image_begin_read_from_file(&description, path.c_str()) == 0) {
    refuse(description.message);
  }
  if (description.width > kLargest || description.height > kLargest) {
    refuse(fmt::format("has {} x {} pixels", description.width, description.height));
  }
  description.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(description.width), static_cast<int>(description.height), {}};
  image.rgb.resize(PNG_IMAGE_SIZE(description));
  const png_color white{255, 255, 255};
  if (png_image_finish_read(&description, &white, image.rgb.data(), 0, nullptr) == 0) {
    refuse(description.message);
  }
  return image;
}

std::string png_bytes(const Image& image) {
  const auto expected = static_cast<std::size_t>(std::max(image.width, 0)) *
                        static_cast<std::size_t>(std::max(image.height, 0)) * kChannels;
  if (expected == 0 || image.rgb.size() != expected) {
    throw std::invalid_argument(
        fmt::format("an image of {} x {} pixels holds {} bytes; allowed: {}", image.width,
                    image.height, image.rgb.size(), expected));
  }
  const std::vector<std::uint8_t> bytes = encoded(image);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void write_png(const std::filesystem::path& path, const Image& image) {
  write_whole(path, png_bytes(image));
}

}  // namespace haptrial::render
