#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/render/flat/flat_quads.h"
#include "core/render/flat/view.h"
#include "core/render/gl/colour.h"
#include "core/render/gl/gl.h"

namespace haptrial::render {

/// Draws flat shapes with smooth edges. Every shape is a rectangle with rounded corners, filled or
/// outlined, at an angle: a disc is one without straight sides, a thick line one with half its
/// width as the corner radius. The shader takes the part of each pixel that the shape covers from
/// the distance to the shape's edge, which is exact for edges along the pixel rows and columns.
///
/// Coordinates are pixels from the top left corner, x to the right and y down; a pixel is one unit
/// wide, its centre at a half. A View maps metres to them. Shapes are drawn in the order of the
/// calls, between begin() and end(), with the painter's context current, also for the destructor.
class Painter {
 public:
  /// @param width, height  of the framebuffer that will be bound in begin() [px].
  /// @throws RunError when the shaders or buffers cannot be made.
  Painter(const Gl& gl, int width, int height);
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// Fills the bound framebuffer with `background`.
  void begin(const Colour& background);
  /// Leaves the framebuffer as it is: what follows goes over it.
  void begin_over();
  /// Hands the last shapes to OpenGL.
  void end();

  /// A rectangle, its corners rounded with `radius` [px].
  void fill(const Rectangle& box, double radius, const Colour& colour);
  /// Draws the outline of a box, `width` [px] wide, half of that on either side of the edge.
  void outline(const Rectangle& box, double radius, double width, const Colour& colour);
  void disc(const Eigen::Vector2d& centre, double radius, const Colour& colour);
  void circle(const Eigen::Vector2d& centre, double radius, double width, const Colour& colour);
  /// A line with round ends.
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width,
            const Colour& colour);
  /// Lines from point to point with round joins and ends. A pixel that several of them touch is
  /// painted once, so a fine polyline has edges as smooth, and a transparent one as even, as a
  /// line.
  void polyline(std::span<const Eigen::Vector2d> points, double width, const Colour& colour);

 private:
  /// One shape as the shader reads it: place (centre, direction), form (half the straight sides,
  /// corner radius, outline width or 0) and colour.
  struct Shape {
    std::array<float, 4> place;
    std::array<float, 4> form;
    std::array<float, 4> colour;
  };

  static Shape box_shape(const Rectangle& box, double radius, double width, const Colour& colour);
  static Shape line_shape(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width,
                          const Colour& colour);
  Rectangle pixels_around(std::span<const Eigen::Vector2d> points, double reach) const;
  void build_program();
  void build_mask();
  void begin_mask(const Rectangle& box);
  void end_mask();
  void flush();

  Gl gl_;
  int width_;
  int height_;
  std::vector<Shape> shapes_;
  Gl::Name program_{0};
  FlatQuads quads_;
  Gl::Name mask_texture_{0};
  Gl::Name mask_framebuffer_{0};
  Gl::Name target_framebuffer_{0};
  int masked_uniform_{-1};
};

}  // namespace haptrial::render
