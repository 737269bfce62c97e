#pragma once

#include <optional>
#include <string_view>

namespace haptrial::render {

/// sRGB values from 0 to 1; alpha 1 is opaque.
struct Colour {
  double red{0.0};
  double green{0.0};
  double blue{0.0};
  double alpha{1.0};

  bool operator==(const Colour&) const = default;
};

/// An opaque colour from "#rrggbb" with hexadecimal digits; nothing when the text is anything else.
std::optional<Colour> parse_colour(std::string_view text);

/// The same colour with another alpha.
constexpr Colour with_alpha(Colour colour, double alpha) {
  colour.alpha = alpha;
  return colour;
}

}  // namespace haptrial::render
