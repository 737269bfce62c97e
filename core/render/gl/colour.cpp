#include "core/render/gl/colour.h"

#include <charconv>

namespace haptrial::render {

std::optional<Colour> parse_colour(std::string_view text) {
  constexpr std::size_t kDigits = 6;
  if (text.size() != kDigits + 1 || text.front() != '#' ||
      text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string_view::npos) {
    return std::nullopt;
  }
  unsigned value = 0;
  std::from_chars(text.data() + 1, text.data() + text.size(), value, 16);
  const auto channel = [value](unsigned shift) { return ((value >> shift) & 0xffu) / 255.0; };
  return Colour{channel(16), channel(8), channel(0)};
}

}  // namespace haptrial::render
