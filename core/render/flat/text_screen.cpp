#include "core/render/flat/text_screen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace haptrial::render {
namespace {

// Parts of the shorter side of the screen.
constexpr double kMargin = 0.08;
constexpr double kTitle = 0.060;
constexpr double kBody = 0.036;
constexpr double kCountdown = 0.14;
constexpr double kHint = 0.028;
constexpr double kGap = 0.05;
constexpr double kColumn = 1.45;  // longest line: longer ones are tiring to read
constexpr double kShrink = 0.9;   // from one try to the next
constexpr double kSmallest = 0.3;

}  // namespace

std::string as_clock(double seconds) {
  const auto whole = static_cast<long>(std::ceil(std::clamp(seconds, 0.0, 359999.0)));
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

TextScreen::TextScreen(const Gl& gl, int width, int height, const Colour& background,
                       const Colour& ink, const Colour& accent)
    : width_(width),
      height_(height),
      background_(background),
      ink_(ink),
      accent_(accent),
      painter_(gl, width, height),
      text_(gl, width, height) {}

double TextScreen::margin() const { return kMargin * std::min(width_, height_); }

TextScreen::Sizes TextScreen::sizes(double scale) const {
  const double side = scale * std::min(width_, height_);
  const auto pixels = [side](double part) {
    return std::max(6, static_cast<int>(std::lround(part * side)));
  };
  return {{pixels(kTitle), true, ink_},
          {pixels(kBody), false, ink_},
          {pixels(kCountdown), false, accent_},
          {pixels(kHint), false, with_alpha(ink_, 0.62)}};
}

double TextScreen::height_of(const TextPage& page, const Sizes& sizes) {
  const double gap = kGap * std::min(width_, height_);
  const double column = std::min(width_ - 2.0 * margin(), kColumn * std::min(width_, height_));
  double height = -gap;
  for (const auto& [text, style] :
       {std::pair(&page.title, sizes.title), {&page.body, sizes.body}}) {
    height += text->empty() ? 0.0 : gap + text_.height_of(*text, column, style);
  }
  height += page.countdown ? gap + text_.line_height(sizes.countdown) : 0.0;
  return std::max(height, 0.0);
}

void TextScreen::draw(const TextPage& page) {
  const double gap = kGap * std::min(width_, height_);
  const double column = std::min(width_ - 2.0 * margin(), kColumn * std::min(width_, height_));
  double scale = 1.0;
  double foot = 0.0;
  Sizes s = sizes(scale);
  const auto room = [&] {
    foot = page.hint.empty() ? 0.0 : gap + text_.height_of(page.hint, column, s.hint);
    return height_ - 2.0 * margin() - foot;
  };
  while (height_of(page, s) > room() && scale > kSmallest) {
    scale *= kShrink;
    s = sizes(scale);
  }
  painter_.begin(background_);
  painter_.end();
  text_.begin();
  const double centre = 0.5 * width_;
  double y = margin() + std::max(0.0, 0.5 * (room() - height_of(page, s)));
  if (!page.title.empty()) {
    y += gap + text_.paragraphs(page.title, {centre, y}, column, s.title);
  }
  if (!page.body.empty()) {
    y += gap + text_.paragraphs(page.body, {centre, y}, column, s.body);
  }
  if (page.countdown) {
    text_.paragraphs(as_clock(*page.countdown), {centre, y}, column, s.countdown);
  }
  if (!page.hint.empty()) {
    text_.paragraphs(page.hint, {centre, height_ - margin() - foot + gap}, column, s.hint);
  }
  text_.end();
}

}  // namespace haptrial::render
