#include "core/render/flat/force_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace haptrial::render {
namespace {

constexpr double kLeft = 76.0;     // room for the axis of forces [px]
constexpr double kRight = 28.0;    // [px]
constexpr double kTop = 46.0;      // for the title [px]
constexpr double kBottom = 54.0;   // for the axis of time [px]
constexpr double kCurve = 2.5;     // width of a curve [px]
constexpr double kStep = 1.0;      // points nearer than this are one [px]
constexpr int kLetters = 15;       // [px]
constexpr double kLegend = 146.0;  // between the legend's entries [px]
constexpr Colour kShade{1.0, 1.0, 1.0};

/// 1, 2 or 5 times a power of ten, for at most `most` ticks.
double tick_step(double range, int most) {
  const double least = range / most;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1.0 - 1e-9)) {
      return factor * power;
    }
  }
  return 10.0 * power;
}

}  // namespace

ForcePanel::ForcePanel(const Gl& gl, const TrialDisplayStyle& style, int width, int height)
    : style_(style),
      width_(width),
      height_(height),
      painter_(gl, width, height),
      text_(gl, width, height),
      plot_{{kLeft, kTop}, {width - kRight, height - kBottom}} {
  if (!(plot_.size().minCoeff() > 0.0)) {
    throw std::invalid_argument("a panel of forces needs more than its margins");
  }
}

void ForcePanel::set_curves(ForceCurves curves) {
  if (curves.time.empty() || curves.time.size() != curves.target.size() ||
      curves.time.size() != curves.applied.size()) {
    throw std::invalid_argument(
        "a panel of forces needs as many times as forces, and one at least");
  }
  curves_ = std::move(curves);
}

Eigen::Vector2d ForcePanel::to_pixels(double time, double force) const {
  const double end = std::max(curves_.time.back(), 1e-3);
  const double held = std::clamp(force, 0.0, style_.full_scale);
  return {plot_.low.x() + plot_.size().x() * time / end,
          plot_.high.y() - plot_.size().y() * held / style_.full_scale};
}

void ForcePanel::draw(double now) {
  const auto count = static_cast<std::size_t>(
      std::upper_bound(curves_.time.begin(), curves_.time.end(), now) - curves_.time.begin());
  painter_.begin(style_.background);
  text_.begin();
  draw_axes();
  draw_curve(curves_.target, style_.target_colour, count);
  draw_curve(curves_.applied, style_.applied_colour, count);
  const double x = to_pixels(std::clamp(now, 0.0, curves_.time.back()), 0.0).x();
  painter_.fill({{x - 0.5, plot_.low.y()}, {x + 0.5, plot_.high.y()}}, 0.0,
                with_alpha(style_.marker_colour, 0.5));
  draw_words(count);
  painter_.end();
  text_.end();
}

void ForcePanel::draw_axes() {
  const Colour faint = with_alpha(style_.trajectory_colour, 0.45);
  const TextStyle small{kLetters - 1, false, with_alpha(style_.marker_colour, 0.75)};
  painter_.fill({{0.0, 0.0}, {static_cast<double>(width_), 1.0}}, 0.0, faint);
  painter_.fill({{to_pixels(curves_.run_begin, 0.0).x(), plot_.low.y()},
                 {to_pixels(curves_.run_end, 0.0).x(), plot_.high.y()}},
                0.0, kShade);
  for (int i = 0; i <= style_.bar_divisions; ++i) {  // as the bars are divided
    const double force = style_.full_scale * i / style_.bar_divisions;
    const double y = std::round(to_pixels(0.0, force).y());
    painter_.fill({{plot_.low.x(), y - 0.5}, {plot_.high.x(), y + 0.5}}, 0.0, faint);
    text_.line(fmt::format("{:g}", force), {plot_.low.x() - 10.0, y + 0.36 * small.size}, small,
               Align::kRight);
  }
  const double end = std::max(curves_.time.back(), 1e-3);
  const double time_step = tick_step(end, std::max(2, width_ / 110));
  for (int i = 0; i * time_step <= end * (1.0 + 1e-9); ++i) {
    const double x = std::round(to_pixels(i * time_step, 0.0).x());
    painter_.fill({{x - 0.5, plot_.high.y()}, {x + 0.5, plot_.high.y() + 5.0}}, 0.0, faint);
    text_.line(fmt::format("{:g}", i * time_step), {x, plot_.high.y() + 20.0}, small,
               Align::kCentre);
  }
  text_.line("time [s]", {plot_.centre().x(), height_ - 12.0}, small, Align::kCentre);
  text_.line_upwards("force [N]", {24.0, plot_.centre().y()}, small);
}

void ForcePanel::draw_curve(const std::vector<double>& forces, const Colour& colour,
                            std::size_t count) {
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector2d last{0.0, 0.0};
  for (std::size_t i = 0; i < count && curves_.time[i] <= curves_.run_end; ++i) {
    if (curves_.time[i] < curves_.run_begin) {
      continue;
    }
    last = to_pixels(curves_.time[i], forces[i]);
    if (points.empty() || (last - points.back()).norm() >= kStep) {
      points.push_back(last);
    }
  }
  if (!points.empty()) {
    points.push_back(last);
  }
  painter_.polyline(points, kCurve, colour);
}

void ForcePanel::draw_words(std::size_t count) {
  const double base = 28.0;
  const TextStyle bold{kLetters + 1, true, style_.marker_colour};
  const TextStyle plain{kLetters, false, style_.marker_colour};
  text_.line(curves_.title, {plot_.low.x(), base}, bold);
  const auto entry = [&](double right, const char* name, const std::vector<double>& forces,
                         const Colour& colour) {
    const double left = right - kLegend;
    painter_.fill({{left, base - 8.0}, {left + 18.0, base - 4.0}}, 2.0, colour);
    text_.line(name, {left + 24.0, base}, plain);
    const double now = count > 0 ? curves_.time[count - 1] : -1.0;
    if (now >= curves_.run_begin && now <= curves_.run_end) {
      text_.line(fmt::format("{:.1f} N", forces[count - 1]), {right, base}, plain, Align::kRight);
    }
  };
  entry(plot_.high.x(), "applied", curves_.applied, style_.applied_colour);
  entry(plot_.high.x() - kLegend - 24.0, "target", curves_.target, style_.target_colour);
  text_.line(curves_.remark, {plot_.high.x() - 2.0 * kLegend - 56.0, base},
             {kLetters, false, with_alpha(style_.marker_colour, 0.6)}, Align::kRight);
}

}  // namespace haptrial::render
