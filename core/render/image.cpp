#include "core/render/image.h"

#include <fmt/format.h>
#include <png.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/error.h"

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

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string reason(int error) { return std::system_category().message(error); }

/// Removes the temporary file unless it took its final name.
class Temporary {
 public:
  explicit Temporary(std::filesystem::path path) : path_(std::move(path)) {}
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    if (!renamed_) {
      std::error_code ignored;
      std::filesystem::remove(path_, ignored);
    }
  }
  const std::filesystem::path& path() const { return path_; }
  void rename(const std::filesystem::path& to) {
    std::error_code error;
    std::filesystem::rename(path_, to, error);
    if (error) {
      throw InputError(fmt::format(
          "picture '{}' cannot be put in place ({}); choose a folder with write permission",
          to.string(), error.message()));
    }
    renamed_ = true;
  }

 private:
  std::filesystem::path path_;
  bool renamed_{false};
};

/// Unlike a stream, stdio keeps the error of a failed write until it is asked.
void write_bytes(std::unique_ptr<std::FILE, CloseFile> file, const std::vector<std::uint8_t>& bytes,
                 const std::filesystem::path& path) {
  errno = 0;
  bool good = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  int error = errno;
  if (std::fclose(file.release()) != 0 && good) {
    good = false;
    error = errno;
  }
  if (!good) {
    throw RunError(
        fmt::format("picture '{}' could not be written whole: {}", path.string(), reason(error)));
  }
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

void write_png(const std::filesystem::path& path, const Image& image) {
  const auto expected = static_cast<std::size_t>(std::max(image.width, 0)) *
                        static_cast<std::size_t>(std::max(image.height, 0)) * kChannels;
  if (expected == 0 || image.rgb.size() != expected) {
    throw std::invalid_argument(
        fmt::format("an image of {} x {} pixels holds {} bytes; allowed: {}", image.width,
                    image.height, image.rgb.size(), expected));
  }
  const std::vector<std::uint8_t> bytes = encoded(image);
  std::filesystem::path part = path;
  part += fmt::format(".{}.part", getpid());
  std::unique_ptr<std::FILE, CloseFile> file(std::fopen(part.c_str(), "wb"));
  if (!file) {
    throw InputError(
        fmt::format("picture '{}' cannot be written ({}); choose a folder with write permission",
                    path.string(), reason(errno)));
  }
  Temporary temporary(part);
  write_bytes(std::move(file), bytes, path);
  temporary.rename(path);
}

}  // namespace haptrial::render
