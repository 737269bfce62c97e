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
constexpr double kHint = 0.032;
constexpr double kGap = 0.05;
constexpr double kColumn = 1.45;  // longest line: longer ones are tiring to read
constexpr double kShrink = 0.9;   // from one try to the next
constexpr double kSmallest = 0.3;
constexpr double kFigure = 0.3;  // of the screen's height
constexpr double kTick = 0.03;   // of a scale
constexpr double kLine = 1.35;   // from choice to choice, of their height
const Colour kUrgent{0.80, 0.08, 0.08};

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
      text_(gl, width, height),
      picture_(gl, width, height) {}

double TextScreen::margin() const { return kMargin * std::min(width_, height_); }

TextScreen::Sizes TextScreen::sizes(double scale) const {
  const double side = scale * std::min(width_, height_);
  const auto pixels = [side](double part) {
    return std::max(6, static_cast<int>(std::lround(part * side)));
  };
  return {{pixels(kTitle), true, ink_},
          {pixels(kBody), false, ink_},
          {pixels(kCountdown), false, accent_},
          {pixels(kHint), false, with_alpha(ink_, 0.8)},
          {pixels(kHint), true, kUrgent}};
}

double TextScreen::gap() const { return kGap * std::min(width_, height_); }

double TextScreen::column() const {
  return std::min(width_ - 2.0 * margin(), kColumn * std::min(width_, height_));
}

double TextScreen::picture_height(const TextPage& page) const {
  if (!page.picture) {
    return 0.0;
  }
  const double shape = static_cast<double>(page.picture->height) / page.picture->width;
  return std::min({static_cast<double>(page.picture->height), page.picture_share * height_,
                   shape * (width_ - 2.0 * margin())});
}

double TextScreen::figure_height() const { return kFigure * height_; }

/// Whether the numbers of a scale are drawn: many would run into each other, and ends may be the
/// numbers themselves.
static bool draws_numbers(const questions::ScaleView& scale) {
  constexpr std::size_t kMost = 11;
  return !scale.numbers.empty() && scale.numbers.size() <= kMost &&
         scale.numbers.front() != scale.low_end;
}

/// Whether each step of a scale has a tick: those of a line that looks continuous are its ends.
static bool draws_ticks(const questions::ScaleView& scale) {
  constexpr int kMost = 50;
  return scale.steps <= kMost;
}

double TextScreen::scale_height(const questions::ScaleView& scale, const Sizes& sizes) {
  const double lines = draws_numbers(scale) ? 3.0 : 2.0;
  return lines * text_.line_height(sizes.body) + 2.0 * kTick * std::min(width_, height_);
}

double TextScreen::answer_height(const TextPage& page, const Sizes& sizes) {
  double height = 0.0;
  for (const std::string& choice : page.answer.choices) {
    height += kLine * text_.height_of(choice, column(), sizes.body);
  }
  height += page.answer.scale ? scale_height(*page.answer.scale, sizes) : 0.0;
  height += page.answer.figure.empty() ? 0.0 : figure_height() + gap();
  if (page.answer.typed) {
    height += text_.height_of(*page.answer.typed + "_", column(), sizes.body);
  }
  return height;
}

double TextScreen::height_of(const TextPage& page, const Sizes& sizes) {
  double height = -gap();
  for (const auto& [text, style] :
       {std::pair(&page.title, sizes.title), {&page.body, sizes.body}}) {
    height += text->empty() ? 0.0 : gap() + text_.height_of(*text, column(), style);
  }
  const double answer = answer_height(page, sizes);
  height += answer > 0.0 ? gap() + answer : 0.0;
  height += page.picture ? gap() + picture_height(page) : 0.0;
  height += page.countdown ? gap() + text_.line_height(sizes.countdown) : 0.0;
  return std::max(height, 0.0);
}

void TextScreen::draw(const TextPage& page) {
  double scale = 1.0;
  double foot = 0.0;
  Sizes s = sizes(scale);
  const auto room = [&] {
    foot = page.hint.empty() ? 0.0 : gap() + text_.height_of(page.hint, column(), s.hint);
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
    y += gap() + text_.paragraphs(page.title, {centre, y}, column(), s.title);
  }
  y += draw_picture(page, y);
  if (!page.body.empty()) {
    y += gap() + text_.paragraphs(page.body, {centre, y}, column(), s.body);
  }
  if (page.countdown) {
    text_.paragraphs(as_clock(*page.countdown), {centre, y}, column(), s.countdown);
  }
  draw_answer(page, s, y);
  if (!page.hint.empty()) {
    text_.paragraphs(page.hint, {centre, height_ - margin() - foot + gap()}, column(),
                     page.hint_is_urgent ? s.urgent : s.hint);
  }
  draw_corner(page.progress, s.hint);
  text_.end();
}

void TextScreen::draw_corner(const std::string& words, const TextStyle& style) {
  if (!words.empty()) {
    text_.paragraphs(words, {width_ - margin(), margin()}, column(), style, Align::kRight);
  }
}

/// @returns the height that it takes
double TextScreen::draw_picture(const TextPage& page, double y) {
  if (!page.picture) {
    return 0.0;
  }
  const double height = picture_height(page);
  const double width = height * page.picture->width / page.picture->height;
  const double left = 0.5 * (width_ - width);
  picture_.draw(page.picture, {{left, y}, {left + width, y + height}});
  return gap() + height;
}

void TextScreen::draw_answer(const TextPage& page, const Sizes& sizes, double y) {
  y = draw_choices(page, sizes, y);
  if (page.answer.scale) {
    draw_scale(page, sizes, y);
    y += scale_height(*page.answer.scale, sizes);
  }
  if (!page.answer.figure.empty()) {
    draw_figure(page, y);
    y += figure_height() + gap();
  }
  if (page.answer.typed) {
    TextStyle style = sizes.body;
    style.colour = accent_;
    text_.paragraphs(*page.answer.typed + "_", {0.5 * width_, y}, column(), style);
  }
}

/// A block of lines in the middle that begin below each other. @returns where it ends
double TextScreen::draw_choices(const TextPage& page, const Sizes& sizes, double y) {
  double widest = 0.0;
  for (const std::string& choice : page.answer.choices) {
    widest = std::max<double>(widest, text_.width_of(choice, sizes.body));
  }
  const double width = std::min(widest + 1.0, column());
  const double left = 0.5 * (width_ - width);
  for (std::size_t i = 0; i < page.answer.choices.size(); ++i) {
    TextStyle style = sizes.body;
    const double height = text_.height_of(page.answer.choices[i], column(), style);
    if (static_cast<int>(i) == page.answer.chosen) {
      style.colour = accent_;
      const double room = 0.5 * gap();
      painter_.begin_over();
      painter_.outline({{left - room, y - 0.1 * height}, {left + width + room, y + 1.1 * height}},
                       0.3 * height, 2.0, accent_);
      painter_.end();
    }
    text_.paragraphs(page.answer.choices[i], {left, y}, width, style, Align::kLeft);
    y += kLine * height;
  }
  return y;
}

/// A line with ticks, words below its ends, and the mark.
void TextScreen::draw_scale(const TextPage& page, const Sizes& sizes, double y) {
  const double tick = kTick * std::min(width_, height_);
  const questions::ScaleView& scale = *page.answer.scale;
  const double half = scale.length > 0.0 ? 0.5 * scale.length * width_ : 0.4 * column();
  const double left = 0.5 * width_ - half;
  const double middle = y + tick;
  painter_.begin_over();
  painter_.line({left, middle}, {left + 2.0 * half, middle}, 2.0, ink_);
  for (int i = 0; i <= scale.steps; i += draws_ticks(scale) ? 1 : scale.steps) {
    const double x = left + 2.0 * half * i / scale.steps;
    painter_.line({x, middle - 0.5 * tick}, {x, middle + 0.5 * tick}, 2.0, ink_);
  }
  if (page.answer.chosen >= 0) {
    painter_.disc({left + 2.0 * half * page.answer.chosen / scale.steps, middle}, 0.6 * tick,
                  accent_);
  }
  painter_.end();
  double below = middle + 1.2 * tick;
  const bool numbered = draws_numbers(scale);
  for (std::size_t i = 0; numbered && i < scale.numbers.size(); ++i) {
    const double x = left + 2.0 * half * static_cast<double>(i) / scale.steps;
    text_.paragraphs(scale.numbers[i], {x, below}, column(), sizes.body);
  }
  below += numbered ? text_.line_height(sizes.body) : 0.0;
  text_.paragraphs(scale.low_end, {left, below}, half, sizes.body, Align::kCentre);
  text_.paragraphs(scale.high_end, {left + 2.0 * half, below}, half, sizes.body, Align::kCentre);
}

/// A square in the middle; its y points up.
void TextScreen::draw_figure(const TextPage& page, double y) {
  constexpr double kThin = 2.0, kThick = 4.0;  // [px]
  const double half = 0.5 * figure_height();
  const auto pixel = [&](const std::array<double, 2>& point) {
    return Eigen::Vector2d(0.5 * width_ + half * point[0], y + half * (1.0 - point[1]));
  };
  painter_.begin_over();
  for (const questions::FigureLine& line : page.answer.figure) {
    painter_.line(pixel(line.from), pixel(line.to), line.marked ? kThick : kThin,
                  line.marked ? accent_ : ink_);
  }
  painter_.end();
}

}  // namespace haptrial::render
