#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "core/render/gl/colour.h"
#include "core/render/gl/gl.h"

namespace haptrial::render {

/// Draws a surface that changes from picture to picture, seen along parallel lines and lit from
/// above the left shoulder; each triangle is as bright as it faces the light, from either side.
///
/// Coordinates are those of Painter with a third, towards the eye [px]. It draws at once and over
/// what is there, hidden by nearer triangles of the same surface alone: between end() and
/// begin_over() of a Painter. One thread, with the context current, also for the destructor.
class ShadedSurface {
 public:
  /// @throws RunError when the shaders cannot be made.
  ShadedSurface(const Gl& gl, int width, int height);
  ~ShadedSurface();
  ShadedSurface(const ShadedSurface&) = delete;
  ShadedSurface& operator=(const ShadedSurface&) = delete;

  void draw(std::span<const Eigen::Vector3f> vertices,
            std::span<const std::array<std::int32_t, 3>> triangles, const Colour& colour);

 private:
  Gl gl_;
  int width_;
  int height_;
  Gl::Name program_{0};
  Gl::Name array_{0};
  std::array<Gl::Name, 2> buffers_{};  // vertices, corners of triangles
  int colour_uniform_{-1};
};

}  // namespace haptrial::render
