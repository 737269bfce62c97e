#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace haptrial::render {

/// A picture; the first byte is the red of the top left pixel.
struct Image {
  int width{0};                   // [px]
  int height{0};                  // [px]
  std::vector<std::uint8_t> rgb;  // (height x width x 3), rows from the top
};

/// Each pixel the mean of `times` x `times` of them; what is left over at right and below is lost.
/// @param times  > 0
Image coarser(const Image& fine, int times);

/// The bytes of a PNG file.
/// @throws RunError if the picture cannot be encoded; std::invalid_argument as write_png()
std::string png_bytes(const Image& image);

/// Writes a PNG file whole or not at all: the bytes go to a temporary file beside `path`, which
/// then takes its name; an older picture there is replaced.
/// @throws InputError when `path` cannot be written to; RunError when writing fails half-way, as on
/// a full disk; std::invalid_argument when the image's size and bytes do not agree.
void write_png(const std::filesystem::path& path, const Image& image);

/// Reads a PNG file; what is transparent shows white.
/// @throws InputError when the file is absent, no PNG, or larger than 4096 x 4096 pixels
Image read_png(const std::filesystem::path& path);

}  // namespace haptrial::render
