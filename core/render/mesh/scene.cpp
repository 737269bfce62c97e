#include "core/render/mesh/scene.h"

#include <GL/glcorearb.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/base/error.h"
#include "core/render/gl/gl.h"
#include "core/render/gl/offscreen.h"

namespace haptrial::render {
namespace {

constexpr int kFiner = 2;  // drawn pixels to one of the picture, each way

constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 colour;
layout(location = 2) in vec3 corner;
out vec3 shade;
out vec3 from_edges;
void main() {
  gl_Position = vec4(place, 1.0);
  shade = colour;
  from_edges = corner;
})";

constexpr const char* kFragmentShader = R"(#version 330 core
in vec3 shade;
in vec3 from_edges;
out vec4 colour;
void main() {
  vec3 pixels = from_edges / max(fwidth(from_edges), vec3(1e-12));
  float inner = smoothstep(0.6, 1.6, min(pixels.x, min(pixels.y, pixels.z)));
  colour = vec4(mix(0.45 * shade, shade, inner), 1.0);
})";

struct Vertex {
  std::array<float, 3> place;  // clip space
  std::array<float, 3> colour;
  std::array<float, 3> corner;  // of the triangle; all large where edges do not show
};

/// Right, up and towards the eye, as rows.
Eigen::Matrix3d axes_of(const SceneView& view) {
  Eigen::Matrix3d axes;
  const Eigen::Vector3d eye = view.towards_eye();
  const Eigen::Vector3d right = view.up.cross(eye).normalized();
  axes << right.transpose(), eye.cross(right).transpose(), eye.transpose();
  return axes;
}

std::array<float, 3> floats(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

std::vector<Vertex> vertices_of(std::span<const SceneTriangle> triangles, const SceneView& view) {
  const Eigen::Matrix3d axes = axes_of(view);
  Eigen::AlignedBox3d box;
  for (const SceneTriangle& triangle : triangles) {
    for (const Eigen::Vector3d& corner : triangle.corners) {
      box.extend(axes * corner);
    }
  }
  if (box.isEmpty() || !box.sizes().allFinite()) {
    throw std::invalid_argument("draw_scene: a scene of finite triangles is needed");
  }
  constexpr float kFar = 1e6f;  // from an edge, so that it does not show
  constexpr double kMargin = 1.06;
  const double scale =
      2.0 /
      (kMargin * std::max({box.sizes().x() / view.width, box.sizes().y() / view.height, 1e-300}));
  const Eigen::Vector3d to_clip(scale / view.width, scale / view.height,
                                -1.8 / std::max(box.sizes().z(), 1e-300));
  std::vector<Vertex> vertices;
  vertices.reserve(3 * triangles.size());
  for (const SceneTriangle& t : triangles) {
    const Eigen::Vector3d normal =
        (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).stableNormalized();
    const double light = 0.35 + 0.65 * std::abs(normal.dot(axes.row(2).transpose()));
    const std::array<float, 3> shade =
        floats(light * Eigen::Vector3d(t.colour.red, t.colour.green, t.colour.blue));
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector3d place = to_clip.cwiseProduct(axes * t.corners[c] - box.center());
      std::array<float, 3> corner{kFar, kFar, kFar};
      if (view.edges) {
        corner = {0.0f, 0.0f, 0.0f};
        corner[c] = 1.0f;
        if (t.hidden_edge >= 0) {
          corner[static_cast<std::size_t>(t.hidden_edge)] = kFar;
        }
      }
      vertices.push_back({floats(place), shade, corner});
    }
  }
  return vertices;
}

/// A colour and a depth texture to draw into; bound until the end of its life.
class Canvas {
 public:
  Canvas(const Gl& gl, int width, int height) : gl_(gl) {
    gl_.gen_textures(2, textures_.data());
    gl_.bind_texture(GL_TEXTURE_2D, textures_[0]);
    gl_.tex_image_2d(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     nullptr);
    gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_.bind_texture(GL_TEXTURE_2D, textures_[1]);
    gl_.tex_image_2d(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, width, height, 0, GL_DEPTH_COMPONENT,
                     GL_FLOAT, nullptr);
    gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_.bind_texture(GL_TEXTURE_2D, 0);
    gl_.gen_framebuffers(1, &framebuffer_);
    gl_.bind_framebuffer(GL_FRAMEBUFFER, framebuffer_);
    gl_.framebuffer_texture_2d(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures_[0],
                               0);
    gl_.framebuffer_texture_2d(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, textures_[1], 0);
    if (gl_.check_framebuffer_status(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw RunError("OpenGL gives no picture with depth to draw into");
    }
  }
  ~Canvas() {
    gl_.bind_framebuffer(GL_FRAMEBUFFER, 0);
    gl_.delete_framebuffers(1, &framebuffer_);
    gl_.delete_textures(2, textures_.data());
  }
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

 private:
  Gl gl_;
  std::array<Gl::Name, 2> textures_{};
  Gl::Name framebuffer_{0};
};

void draw(const Gl& gl, const std::vector<Vertex>& vertices) {
  const Gl::Name program = build_program(gl, "the scene", kVertexShader, kFragmentShader);
  Gl::Name array = 0;
  Gl::Name buffer = 0;
  gl.use_program(program);
  gl.gen_vertex_arrays(1, &array);
  gl.bind_vertex_array(array);
  gl.gen_buffers(1, &buffer);
  gl.bind_buffer(GL_ARRAY_BUFFER, buffer);
  gl.buffer_data(GL_ARRAY_BUFFER, static_cast<std::ptrdiff_t>(vertices.size() * sizeof(Vertex)),
                 vertices.data(), GL_STREAM_DRAW);
  for (unsigned index = 0; index < 3; ++index) {
    const std::size_t offset = index * 3 * sizeof(float);
    gl.enable_vertex_attrib_array(index);
    gl.vertex_attrib_pointer(index, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                             reinterpret_cast<const void*>(offset));
  }
  gl.draw_arrays_instanced(GL_TRIANGLES, 0, static_cast<int>(vertices.size()), 1);
  gl.delete_buffers(1, &buffer);
  gl.delete_vertex_arrays(1, &array);
  gl.delete_program(program);
}

}  // namespace

Eigen::Vector3d SceneView::towards_eye() const {
  const Eigen::Vector3d axis = up.normalized();
  // The axis after `up` in the order x, y, z, x, made level.
  int next = 0;
  axis.cwiseAbs().maxCoeff(&next);
  const Eigen::Vector3d other = Eigen::Vector3d::Unit((next + 1) % 3);
  const Eigen::Vector3d level = (other - other.dot(axis) * axis).normalized();
  const Eigen::Vector3d around = std::cos(azimuth) * level + std::sin(azimuth) * axis.cross(level);
  return std::cos(elevation) * around + std::sin(elevation) * axis;
}

Image draw_scene(std::span<const SceneTriangle> triangles, const SceneView& view) {
  const std::vector<Vertex> vertices = vertices_of(triangles, view);
  const int width = kFiner * view.width;
  const int height = kFiner * view.height;
  OffscreenContext context(width, height);
  const Gl& gl = context.gl();
  const Canvas canvas(gl, width, height);
  gl.viewport(0, 0, width, height);
  gl.disable(GL_BLEND);
  gl.disable(GL_CULL_FACE);
  gl.enable(GL_DEPTH_TEST);
  gl.clear_color(static_cast<float>(view.background.red), static_cast<float>(view.background.green),
                 static_cast<float>(view.background.blue), 1.0f);
  gl.clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  draw(gl, vertices);
  return coarser(read_frame(gl, width, height), kFiner);
}

}  // namespace haptrial::render
