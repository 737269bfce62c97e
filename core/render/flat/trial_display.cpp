#include "core/render/flat/trial_display.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/render/gl/offscreen.h"

namespace haptrial::render {
namespace {

constexpr double kCurveStep = 1.0;  // points of the trajectory nearer than this are one point [px]

TrialDisplayStyle checked(TrialDisplayStyle style, int width, int height) {
  style.width = width;
  style.height = height;
  check(style);
  return style;
}

/// Seen from above: x to the right, or mirrored to the left, z (towards the user) down the screen.
Eigen::Vector2d seen_from_above(const Eigen::Vector3d& point, const TrialDisplayStyle& style) {
  return {style.mirrored ? -point.x() : point.x(), point.z()};
}

Rectangle bounds(std::span<const Eigen::Vector3d> points, const TrialDisplayStyle& style) {
  const Eigen::Vector2d first = seen_from_above(points.front(), style);
  Rectangle box{first, first};
  for (const Eigen::Vector3d& point : points) {
    if (!point.allFinite()) {
      throw std::invalid_argument("a point of the trajectory to be drawn is not finite");
    }
    box.low = box.low.cwiseMin(seen_from_above(point, style));
    box.high = box.high.cwiseMax(seen_from_above(point, style));
  }
  const Eigen::Vector2d half = 0.5 * box.size().cwiseMax(style.smallest_extent);
  return {box.centre() - half, box.centre() + half};
}

Rectangle screen_for_trajectory(const TrialDisplayStyle& style) {
  return {{style.room_beside(), style.room_above()},
          {style.width - style.room_beside(), style.height - style.room_below()}};
}

/// The part of full scale that a force fills, 0 to 1.
double fraction(double force, double full_scale) {
  return force > 0.0 ? std::min(force / full_scale, 1.0) : 0.0;
}

Rectangle grown(const Rectangle& box, double by) {
  const Eigen::Vector2d all = Eigen::Vector2d::Constant(by);
  return {box.low - all, box.high + all};
}

}  // namespace

TrialDisplay::TrialDisplay(const Gl& gl, const TrialDisplayStyle& style, int width, int height)
    : style_(checked(style, width, height)), painter_(gl, width, height) {
  const std::array origin{Eigen::Vector3d::Zero().eval()};
  view_ = fit(bounds(origin, style_), screen_for_trajectory(style_));
}

void TrialDisplay::set_trajectory(std::span<const Eigen::Vector3d> points) {
  if (points.empty()) {
    curve_.clear();
    return;
  }
  view_ = fit(bounds(points, style_), screen_for_trajectory(style_));
  curve_.clear();
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector2d pixel = to_pixels(point);
    if (curve_.empty() || (pixel - curve_.back()).norm() >= kCurveStep) {
      curve_.push_back(pixel);
    }
  }
  curve_.push_back(to_pixels(points.back()));
}

Eigen::Vector2d TrialDisplay::to_pixels(const Eigen::Vector3d& point) const {
  return view_.to_pixels(seen_from_above(point, style_));
}

Eigen::Vector3d TrialDisplay::to_world(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d point = view_.to_point(pixel);
  return {style_.mirrored ? -point.x() : point.x(), 0.0, point.y()};
}

void TrialDisplay::draw(const stimulus::Presentation& presentation) {
  painter_.begin(style_.background);
  if (presentation.show_trajectory) {
    painter_.polyline(curve_, style_.trajectory_width, style_.trajectory_colour);
  }
  if (presentation.tool.allFinite()) {
    const Eigen::Vector2d marker = to_pixels(presentation.tool);
    if (presentation.show_target_bar) {
      draw_bar(marker, Side::kLeft, presentation.target_force, style_.target_colour);
    }
    if (presentation.show_applied_bar) {
      draw_bar(marker, Side::kRight, presentation.applied_force, style_.applied_colour);
    }
    if (presentation.show_trajectory && presentation.self_paced) {  // a ring: it is one's turn
      painter_.disc(marker, style_.marker_radius + 2.5 * style_.marker_halo, style_.marker_colour);
    }
    if (presentation.show_trajectory) {
      draw_marker(marker);
    }
  }
  if (presentation.show_saturation) {
    draw_saturation();
  }
  painter_.end();
}

void TrialDisplay::draw_marker(const Eigen::Vector2d& centre) {
  painter_.disc(centre, style_.marker_radius + style_.marker_halo, style_.background);
  painter_.disc(centre, style_.marker_radius, style_.marker_colour);
}

void TrialDisplay::draw_bar(const Eigen::Vector2d& marker, Side side, double force,
                            const Colour& colour) {
  const double inner = 0.5 * style_.bar_gap;
  const double left = side == Side::kLeft ? -inner - style_.bar_width : inner;
  const double foot = marker.y() - style_.marker_radius - style_.bar_gap;
  const Rectangle full{{marker.x() + left, foot - style_.bar_height},
                       {marker.x() + left + style_.bar_width, foot}};
  draw_frame(full, side, colour);
  const double height = style_.bar_height * fraction(force, style_.full_scale);
  painter_.fill({{full.low.x(), foot - height}, full.high}, 0.0, colour);
}

void TrialDisplay::draw_frame(const Rectangle& bar, Side side, const Colour& colour) {
  const Rectangle frame = grown(bar, style_.frame_padding + 0.5 * style_.frame_width);
  const Colour faint = with_alpha(colour, style_.frame_opacity);
  painter_.fill(frame, style_.frame_radius, with_alpha(style_.background, style_.panel_opacity));
  painter_.outline(frame, style_.frame_radius, style_.frame_width, faint);
  const double half = 0.5 * style_.frame_width;
  const double from =
      side == Side::kLeft ? frame.low.x() - half - style_.tick_length : frame.high.x() + half;
  for (int tick = 1; tick < style_.bar_divisions; ++tick) {
    const double y = bar.high.y() - bar.size().y() * tick / style_.bar_divisions;
    painter_.fill({{from, y - half}, {from + style_.tick_length, y + half}}, 0.0, faint);
  }
}

void TrialDisplay::draw_saturation() {
  const double side = style_.saturation_size;
  const double inset = std::max(0.0, 0.5 * (style_.margin - side));  // where no bar can reach
  const double right = style_.width - inset;
  painter_.fill({{right - side, inset}, {right, inset + side}}, 0.0, style_.saturation_colour);
}

struct FrameRenderer::Impl {
  explicit Impl(const TrialDisplayStyle& style)
      : context(style.width, style.height),
        display(context.gl(), style, style.width, style.height) {}
  // The display frees what it has in this context, which another may have replaced as current.
  ~Impl() { context.make_current(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  OffscreenContext context;
  TrialDisplay display;
};

FrameRenderer::FrameRenderer(const TrialDisplayStyle& style)
    : impl_(std::make_unique<Impl>(style)) {}

FrameRenderer::~FrameRenderer() = default;

void FrameRenderer::set_trajectory(std::span<const Eigen::Vector3d> points) {
  impl_->display.set_trajectory(points);
}

Image FrameRenderer::draw(const stimulus::Presentation& presentation) {
  impl_->context.make_current();
  impl_->display.draw(presentation);
  return impl_->context.read();
}

}  // namespace haptrial::render
