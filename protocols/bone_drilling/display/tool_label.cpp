#include "protocols/bone_drilling/display/tool_label.h"

#include <fmt/format.h>

#include <algorithm>

namespace haptrial::protocols {

std::string words_of(const bone::ToolSpec& tool) {
  const auto* burr = tool.as<bone::BurrTool>();
  const auto* suction = tool.as<bone::SuctionTool>();
  const double diameter =
      burr != nullptr ? burr->burr.diameter : (suction != nullptr ? 2.0 * suction->radius : 0.0);
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

ToolLabel::ToolLabel(const render::Gl& gl, int width, int height)
    : height_(height), painter_(gl, width, height), text_(gl, width, height) {}

void ToolLabel::draw(const std::string& words, int left) {
  const render::Colour ink{0.96, 0.96, 0.96};
  const render::Colour plate{0.05, 0.06, 0.08, 0.55};
  constexpr double kLines = 40.0;  // of text in a picture's height
  const render::TextStyle style{std::max(10, static_cast<int>(height_ / kLines)), false, ink};
  const double em = style.size;
  const Eigen::Vector2d low(left + 0.6 * em, height_ - 2.4 * em);
  const Eigen::Vector2d high = low + Eigen::Vector2d(text_.width_of(words, style) + em, 1.8 * em);
  painter_.begin_over();
  painter_.fill({low, high}, 0.4 * em, plate);
  painter_.end();
  text_.begin();
  text_.line(words, {low.x() + 0.5 * em, high.y() - 0.55 * em}, style);
  text_.end();
}

}  // namespace haptrial::protocols
