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
  image.rgb.reserve(3 * static_cast<std::size_t>(image.width) *
                    static_cast<std::size_t>(image.height));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int channel = 0; channel < 3; ++channel) {
        int sum = 0;
        for (int part = 0; part < times * times; ++part) {
          const int row = times * y + part / times;
          const int column = times * x + part % times;
          sum +=
              fine.rgb[3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(fine.width) +
                            static_cast<std::size_t>(column)) +
                       static_cast<std::size_t>(channel)];
        }
        image.rgb.push_back(static_cast<std::uint8_t>(sum / (times * times)));
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
