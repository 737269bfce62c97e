#include "core/render/flat/painter.h"

#include <GL/glcorearb.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"

namespace haptrial::render {
namespace {

/// One instance is one shape; its four corners come from the vertex number.
constexpr const char* kVertexShader = R"glsl(#version 330 core
layout(location = 0) in vec4 place;   // centre [px], direction of the first axis
layout(location = 1) in vec4 form;    // half sizes of the straight part, radius, outline width [px]
layout(location = 2) in vec4 colour;
uniform vec2 screen;                  // [px]
out vec2 local;
flat out vec4 shape;
flat out vec4 paint;

void main() {
  vec2 corner = 2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0;
  const float kEdge = 1.0;            // room for the pixels that the shape covers in part [px]
  local = corner * (form.xy + form.z + 0.5 * form.w + kEdge);
  vec2 pixel = place.xy + local.x * place.zw + local.y * vec2(-place.w, place.z);
  gl_Position = vec4(2.0 * pixel.x / screen.x - 1.0, 1.0 - 2.0 * pixel.y / screen.y, 0.0, 1.0);
  shape = form;
  paint = colour;
}
)glsl";

/// Coverage is that of a pixel cut by a straight edge at the signed distance, and never more than
/// the thickness of the shape, so that what is thinner than a pixel fades instead of growing.
constexpr const char* kFragmentShader = R"glsl(#version 330 core
in vec2 local;
flat in vec4 shape;
flat in vec4 paint;
uniform bool masked;
uniform sampler2D mask;
out vec4 result;

void main() {
  vec2 outside = abs(local) - shape.xy;
  float distance = length(max(outside, 0.0)) + min(max(outside.x, outside.y), 0.0) - shape.z;
  float thickness = 2.0 * (min(shape.x, shape.y) + shape.z);
  if (shape.w > 0.0) {
    distance = abs(distance) - 0.5 * shape.w;
    thickness = shape.w;
  }
  float coverage = clamp(min(0.5 - distance, thickness), 0.0, 1.0);
  if (shape.z == 0.0 && shape.w == 0.0) {  // sharp corners: the overlap of two boxes is a product
    vec2 sides = clamp(min(0.5 - outside, 2.0 * shape.xy), 0.0, 1.0);
    coverage = sides.x * sides.y;
  }
  if (masked) {
    coverage *= texelFetch(mask, ivec2(gl_FragCoord.xy), 0).r;
  }
  result = vec4(paint.rgb, 1.0) * (paint.a * coverage);  // premultiplied
}
)glsl";

constexpr unsigned kShapeAttributes = 3;  // place, form, colour
constexpr double kEdge = 1.0;             // pixels beyond a shape that it covers in part
constexpr Colour kWhite{1.0, 1.0, 1.0};

std::array<float, 4> floats(double a, double b, double c, double d) {
  return {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c),
          static_cast<float>(d)};
}

std::array<float, 4> floats(const Colour& colour) {
  return floats(colour.red, colour.green, colour.blue, colour.alpha);
}

}  // namespace

Painter::Painter(const Gl& gl, int width, int height)
    : gl_(gl), width_(width), height_(height), quads_(gl, kShapeAttributes) {
  static_assert(sizeof(Shape) == kShapeAttributes * 4 * sizeof(float));
  build_program();
  build_mask();
}

Painter::~Painter() {
  gl_.delete_framebuffers(1, &mask_framebuffer_);
  gl_.delete_textures(1, &mask_texture_);
  gl_.delete_program(program_);
}

void Painter::build_program() {
  program_ = render::build_program(gl_, "the painter", kVertexShader, kFragmentShader);
  gl_.use_program(program_);
  gl_.uniform2f(gl_.get_uniform_location(program_, "screen"), static_cast<float>(width_),
                static_cast<float>(height_));
  gl_.uniform1i(gl_.get_uniform_location(program_, "mask"), 0);
  masked_uniform_ = gl_.get_uniform_location(program_, "masked");
}

void Painter::build_mask() {
  gl_.gen_textures(1, &mask_texture_);
  gl_.bind_texture(GL_TEXTURE_2D, mask_texture_);
  gl_.tex_image_2d(GL_TEXTURE_2D, 0, GL_R8, width_, height_, 0, GL_RED, GL_UNSIGNED_BYTE, nullptr);
  gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  int previous = 0;
  gl_.get_integerv(GL_FRAMEBUFFER_BINDING, &previous);
  gl_.gen_framebuffers(1, &mask_framebuffer_);
  gl_.bind_framebuffer(GL_FRAMEBUFFER, mask_framebuffer_);
  gl_.framebuffer_texture_2d(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, mask_texture_, 0);
  const bool complete = gl_.check_framebuffer_status(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  gl_.bind_framebuffer(GL_FRAMEBUFFER, static_cast<Gl::Name>(previous));
  if (!complete) {
    throw RunError(
        fmt::format("OpenGL gives no texture of {} x {} pixels to draw into", width_, height_));
  }
}

void Painter::begin(const Colour& background) {
  begin_over();
  const std::array<float, 4> colour = floats(background);
  gl_.clear_color(colour[0], colour[1], colour[2], colour[3]);
  gl_.clear(GL_COLOR_BUFFER_BIT);
}

void Painter::begin_over() {
  int target = 0;
  gl_.get_integerv(GL_FRAMEBUFFER_BINDING, &target);
  target_framebuffer_ = static_cast<Gl::Name>(target);
  begin_flat(gl_, width_, height_);
  gl_.use_program(program_);
  gl_.uniform1i(masked_uniform_, 0);
  quads_.bind();
  gl_.active_texture(GL_TEXTURE0);
  gl_.bind_texture(GL_TEXTURE_2D, mask_texture_);
  shapes_.clear();
}

void Painter::end() { flush(); }

void Painter::flush() {
  if (shapes_.empty()) {
    return;
  }
  quads_.draw(shapes_.data(), shapes_.size());
  shapes_.clear();
}

Painter::Shape Painter::box_shape(const Rectangle& box, double radius, double width,
                                  const Colour& colour) {
  const Eigen::Vector2d half = 0.5 * box.size();
  const double rounded = std::clamp(radius, 0.0, std::max(0.0, half.minCoeff()));
  return {floats(box.centre().x(), box.centre().y(), 1.0, 0.0),
          floats(half.x() - rounded, half.y() - rounded, rounded, width), floats(colour)};
}

Painter::Shape Painter::line_shape(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                   double width, const Colour& colour) {
  const Eigen::Vector2d along = to - from;
  const double length = along.norm();
  const Eigen::Vector2d direction =
      length > 0.0 ? Eigen::Vector2d(along / length) : Eigen::Vector2d::UnitX();
  const Eigen::Vector2d centre = 0.5 * (from + to);
  return {floats(centre.x(), centre.y(), direction.x(), direction.y()),
          floats(0.5 * length, 0.0, 0.5 * width, 0.0), floats(colour)};
}

void Painter::fill(const Rectangle& box, double radius, const Colour& colour) {
  shapes_.push_back(box_shape(box, radius, 0.0, colour));
}

void Painter::outline(const Rectangle& box, double radius, double width, const Colour& colour) {
  if (width > 0.0) {
    shapes_.push_back(box_shape(box, radius, width, colour));
  }
}

void Painter::disc(const Eigen::Vector2d& centre, double radius, const Colour& colour) {
  shapes_.push_back(line_shape(centre, centre, 2.0 * radius, colour));
}

void Painter::circle(const Eigen::Vector2d& centre, double radius, double width,
                     const Colour& colour) {
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(radius);
  outline({centre - half, centre + half}, radius, width, colour);
}

void Painter::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width,
                   const Colour& colour) {
  shapes_.push_back(line_shape(from, to, width, colour));
}

Rectangle Painter::pixels_around(std::span<const Eigen::Vector2d> points, double reach) const {
  Rectangle box{points.front(), points.front()};
  for (const Eigen::Vector2d& point : points) {
    box.low = box.low.cwiseMin(point);
    box.high = box.high.cwiseMax(point);
  }
  const Eigen::Vector2d screen(width_, height_);
  const auto on_screen = [&screen](const Eigen::Vector2d& point) {
    return Eigen::Vector2d(point.cwiseMax(0.0).cwiseMin(screen));
  };
  return {on_screen((box.low.array() - reach).floor().matrix()),
          on_screen((box.high.array() + reach).ceil().matrix())};
}

void Painter::polyline(std::span<const Eigen::Vector2d> points, double width,
                       const Colour& colour) {
  if (points.empty() || !(width > 0.0)) {
    return;
  }
  flush();
  const Rectangle box = pixels_around(points, 0.5 * width + kEdge);
  begin_mask(box);
  shapes_.push_back(line_shape(points.front(), points.front(), width, kWhite));
  for (std::size_t i = 1; i < points.size(); ++i) {
    shapes_.push_back(line_shape(points[i - 1], points[i], width, kWhite));
  }
  flush();
  end_mask();
  gl_.uniform1i(masked_uniform_, 1);
  fill(box, 0.0, colour);
  flush();
  gl_.uniform1i(masked_uniform_, 0);
}

/// Shapes that are drawn next leave their largest coverage in the mask instead of colour on the
/// screen.
void Painter::begin_mask(const Rectangle& box) {
  gl_.bind_texture(GL_TEXTURE_2D, 0);  // a texture is not read while it is drawn into
  gl_.bind_framebuffer(GL_FRAMEBUFFER, mask_framebuffer_);
  gl_.blend_equation(GL_MAX);
  gl_.enable(GL_SCISSOR_TEST);
  gl_.scissor(static_cast<int>(box.low.x()), height_ - static_cast<int>(box.high.y()),
              static_cast<int>(box.size().x()), static_cast<int>(box.size().y()));
  gl_.clear_color(0.0f, 0.0f, 0.0f, 0.0f);
  gl_.clear(GL_COLOR_BUFFER_BIT);
}

void Painter::end_mask() {
  gl_.disable(GL_SCISSOR_TEST);
  gl_.blend_equation(GL_FUNC_ADD);
  gl_.bind_framebuffer(GL_FRAMEBUFFER, target_framebuffer_);
  gl_.bind_texture(GL_TEXTURE_2D, mask_texture_);
}

}  // namespace haptrial::render
