#include "analysis/document/embedded_png.h"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "analysis/document/base64.h"
#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {
namespace {

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  }
  return value;
}

}  // namespace

std::string svg_of_png(const std::filesystem::path& png) {
  const std::string bytes = file_text(png);
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  constexpr std::size_t kWidthAt = 16, kHeightAt = 20, kHeader = 24;
  if (bytes.size() < kHeader || bytes.compare(0, kSignature.size(), kSignature) != 0) {
    throw InputError(fmt::format("{}: is not a PNG file", png.string()));
  }
  const std::uint32_t width = big_endian(bytes, kWidthAt), height = big_endian(bytes, kHeightAt);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\"><image width=\"{0}\" height=\"{1}\" "
      "href=\"data:image/png;base64,{2}\"/></svg>\n",
      width, height, base64(bytes));
}

}  // namespace haptrial::analysis
