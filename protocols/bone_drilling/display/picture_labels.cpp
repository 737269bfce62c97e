#include "protocols/bone_drilling/display/picture_labels.h"

#include <fmt/format.h>

#include <algorithm>

namespace haptrial::protocols {
namespace {

const render::Colour kPale{0.96, 0.96, 0.96};
const render::Colour kDark{0.05, 0.06, 0.08, 0.55};
const render::Colour kBlack{0.08, 0.06, 0.02};
const render::Colour kRed{0.80, 0.05, 0.08};
const render::Colour kAmber{1.0, 0.76, 0.15,
                            0.92};  // whoever drills looks elsewhere: to be noticed

}  // namespace

std::string words_of(const bone::ToolSpec& tool) {
  const auto* burr = tool.as<bone::BurrTool>();
  const auto* suction = tool.as<bone::SuctionTool>();
  const double diameter =
      burr != nullptr ? burr->burr.diameter : (suction != nullptr ? 2.0 * suction->radius : 0.0);
  if (burr != nullptr && burr->burr.form == bone::BurrForm::kBlade) {
    return fmt::format("{}, {:.3g} mm wide, kerf {:.3g} mm", tool.name, 1e3 * diameter,
                       1e3 * burr->burr.narrow_diameter);
  }
  if (burr != nullptr && burr->burr.form != bone::BurrForm::kBall) {
    return fmt::format("{}, {:.3g} × {:.3g} mm", tool.name, 1e3 * diameter,
                       1e3 * burr->burr.length);
  }
  return diameter > 0.0 ? fmt::format("{}, {:.3g} mm", tool.name, 1e3 * diameter) : tool.name;
}

std::string words_of(const bone::ToolSpec& tool, const bone::DrillingView& seen) {
  std::string words = words_of(tool);
  if (const auto* burr = tool.as<bone::BurrTool>()) {
    words +=
        burr->burr.wear_volume > 0.0 ? fmt::format(", {:.0f} % sharp", 100.0 * seen.sharpness) : "";
    words += seen.reversed ? ", reversed" : "";
  }
  return words;
}

PictureLabels::PictureLabels(const render::Gl& gl, int width, int height)
    : height_(height), painter_(gl, width, height), text_(gl, width, height) {}

void PictureLabels::line(const std::string& words, const Eigen::Vector2d& low, const Look& look) {
  const double em = look.text.size;
  const Eigen::Vector2d high =
      low + Eigen::Vector2d(text_.width_of(words, look.text) + em, 1.8 * em);
  painter_.begin_over();
  painter_.fill({low, high}, 0.4 * em, look.plate);
  painter_.end();
  text_.begin();
  text_.line(words, {low.x() + 0.5 * em, high.y() - 0.55 * em}, look.text);
  text_.end();
}

render::TextStyle PictureLabels::small() const {
  constexpr double kLines = 40.0;  // of text in a picture's height
  return {std::max(10, static_cast<int>(height_ / kLines)), false, kPale};
}

void PictureLabels::clock(const std::string& words, const EyePicture& eye) {
  const render::TextStyle style = small();
  const double em = style.size;
  if (!words.empty()) {
    const double left = eye.left + eye.width - text_.width_of(words, style) - 1.6 * em;
    line(words, {left, height_ - 2.4 * em}, {style, kDark});
  }
}

void PictureLabels::tool(const std::string& words, const EyePicture& eye) {
  const render::TextStyle style = small();
  const double em = style.size;
  line(words, {eye.left + 0.6 * em, height_ - 2.4 * em}, {style, kDark});
}

void PictureLabels::legend(const std::string& words, double low, const EyePicture& eye) {
  constexpr double kLines = 48.0;
  const render::TextStyle style{std::max(10, static_cast<int>(height_ / kLines)), false, kPale};
  const double em = style.size;
  const double left = eye.left + eye.width - text_.width_of(words, style) - 1.6 * em;
  line(words, {left, low + 0.4 * em}, {style, kDark});
}

void PictureLabels::hints(std::span<const std::string> lines, const EyePicture& eye) {
  constexpr double kLines = 26.0;
  const render::TextStyle style{std::max(12, static_cast<int>(height_ / kLines)), true, kBlack};
  const double em = style.size;
  Eigen::Vector2d low(0.0, 1.2 * em);
  for (const std::string& words : lines) {
    low.x() = eye.left + 0.5 * (eye.width - text_.width_of(words, style) - em);
    line(words, low, {style, kAmber});
    low.y() += 2.1 * em;
  }
}

void PictureLabels::injury(const std::string& words, double frame, const EyePicture& eye) {
  constexpr double kLines = 18.0;
  constexpr double kFrames = 12.0;  // in a picture's height
  if (frame > 0.0) {
    const double wide = height_ / kFrames;
    const Eigen::Vector2d low(eye.left, 0.0);
    painter_.begin_over();
    painter_.outline({low, low + Eigen::Vector2d(eye.width, height_)}, 0.0, wide,
                     {kRed.red, kRed.green, kRed.blue, std::min(1.0, frame)});
    painter_.end();
  }
  const render::TextStyle style{std::max(14, static_cast<int>(height_ / kLines)), true, kPale};
  const double em = style.size;
  const double left = eye.left + 0.5 * (eye.width - text_.width_of(words, style) - em);
  line(words, {left, height_ - 4.5 * em}, {style, kRed});
}

}  // namespace haptrial::protocols
