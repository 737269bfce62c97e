#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "core/render/flat/trial_display_style.h"
#include "core/render/gl/image.h"
#include "core/stimulus/presentation.h"

namespace haptrial::render {

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

/// One picture, for callers that want no more.
Image render_presentation(const TrialDisplayStyle& style,
                          std::span<const Eigen::Vector3d> trajectory,
                          const stimulus::Presentation& presentation);

}  // namespace haptrial::render
