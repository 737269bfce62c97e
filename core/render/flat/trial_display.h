#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "core/render/flat/painter.h"
#include "core/render/flat/trial_display_style.h"
#include "core/render/gl/image.h"
#include "core/stimulus/presentation.h"

namespace haptrial::render {

/// Draws what a participant sees during a trial: the spatial trajectory, the device's position on
/// it and, where the condition has them, bars of the target force (blue, left) and the applied
/// force (green, right) that move along with it, and a square while the device is saturated.
///
/// The view is that of somebody who looks down on the table: x runs to the right and z, which
/// points to the user, down the screen. One centimetre is equally long both ways, and y does not
/// show. The trajectory is fitted into the picture with room for full bars above it, in every
/// condition alike. A bar's height is proportional to its force; a frame with ticks shows full
/// scale, without numbers.
///
/// One thread, with the OpenGL context current whose functions are given, also for the destructor.
/// Source: Morris 2006, §4.2.3, §4.2.4, Figure 24.
class TrialDisplay {
 public:
  /// @param width, height  of the framebuffer that is drawn into [px]; they replace the style's.
  /// @throws std::invalid_argument as check() does; RunError as Painter does.
  TrialDisplay(const Gl& gl, const TrialDisplayStyle& style, int width, int height);

  /// The trajectory of the block; fits the view to it.
  /// @param points  p_W (N x 3) [m]; none takes the trajectory away and leaves the view.
  /// @throws std::invalid_argument when a point is not finite.
  void set_trajectory(std::span<const Eigen::Vector3d> points);

  /// Draws one picture. A tool position that is not finite is not drawn, nor are its bars; a force
  /// below zero or not finite is an empty bar and one beyond full scale a full one.
  void draw(const stimulus::Presentation& presentation);

  /// Place of a point p_W [m] in the picture [px].
  Eigen::Vector2d to_pixels(const Eigen::Vector3d& point) const;
  /// The point p_W of the xz plane that a pixel shows; y is 0 [m].
  Eigen::Vector3d to_world(const Eigen::Vector2d& pixel) const;

 private:
  enum class Side { kLeft, kRight };

  void draw_marker(const Eigen::Vector2d& centre);
  void draw_bar(const Eigen::Vector2d& marker, Side side, double force, const Colour& colour);
  void draw_frame(const Rectangle& bar, Side side, const Colour& colour);
  void draw_saturation();

  TrialDisplayStyle style_;
  Painter painter_;
  View view_;
  std::vector<Eigen::Vector2d> curve_;  // (N x 2) [px]
};

/// Draws trial pictures off screen, with an OpenGL context of its own. One thread at a time.
class FrameRenderer {
 public:
  /// @throws std::invalid_argument as TrialDisplay does; RunError when there is no OpenGL.
  explicit FrameRenderer(const TrialDisplayStyle& style);
  ~FrameRenderer();
  FrameRenderer(const FrameRenderer&) = delete;
  FrameRenderer& operator=(const FrameRenderer&) = delete;

  /// @param points  p_W (N x 3) [m]; see TrialDisplay.
  void set_trajectory(std::span<const Eigen::Vector3d> points);
  Image draw(const stimulus::Presentation& presentation);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::render
