#include "core/render/flat/shaded_surface.h"

#include <GL/glcorearb.h>

#include "core/render/flat/flat_quads.h"

namespace haptrial::render {
namespace {

constexpr const char* kSurfaceVertexShader = R"glsl(#version 330 core
layout(location = 0) in vec3 place;  // right, down, towards the eye [px]
uniform vec2 screen;                 // [px]
out vec3 at;

void main() {
  at = place;
  gl_Position = vec4(2.0 * place.x / screen.x - 1.0, 1.0 - 2.0 * place.y / screen.y,
                     -place.z / 16384.0, 1.0);
}
)glsl";

constexpr const char* kSurfaceFragmentShader = R"glsl(#version 330 core
in vec3 at;
uniform vec4 colour;
out vec4 result;

void main() {
  vec3 across = cross(dFdx(at), dFdy(at));
  float size = length(across);  // seen edge-on it is what it may be
  vec3 normal = size > 0.0 && size < 1e6 ? across / size : vec3(0.0, 0.0, 1.0);
  normal *= normal.z < 0.0 ? -1.0 : 1.0;
  float light = max(0.0, dot(normal, normalize(vec3(-0.5, -0.6, 0.8))));
  result = vec4(colour.rgb * (0.55 + 0.5 * light), 1.0);
}
)glsl";

}  // namespace

ShadedSurface::ShadedSurface(const Gl& gl, int width, int height)
    : gl_(gl), width_(width), height_(height) {
  program_ = build_program(gl_, "the shaded surface", kSurfaceVertexShader, kSurfaceFragmentShader);
  gl_.use_program(program_);
  gl_.uniform2f(gl_.get_uniform_location(program_, "screen"), static_cast<float>(width),
                static_cast<float>(height));
  colour_uniform_ = gl_.get_uniform_location(program_, "colour");
  gl_.gen_vertex_arrays(1, &array_);
  gl_.gen_buffers(2, buffers_.data());
  gl_.bind_vertex_array(array_);
  gl_.bind_buffer(GL_ARRAY_BUFFER, buffers_[0]);
  gl_.enable_vertex_attrib_array(0);
  gl_.vertex_attrib_pointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Eigen::Vector3f), nullptr);
  gl_.bind_buffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[1]);
  gl_.bind_vertex_array(0);
}

ShadedSurface::~ShadedSurface() {
  gl_.delete_buffers(2, buffers_.data());
  gl_.delete_vertex_arrays(1, &array_);
  gl_.delete_program(program_);
}

void ShadedSurface::draw(std::span<const Eigen::Vector3f> vertices,
                         std::span<const std::array<std::int32_t, 3>> triangles,
                         const Colour& colour) {
  begin_flat(gl_, width_, height_);
  gl_.disable(GL_BLEND);
  gl_.enable(GL_DEPTH_TEST);
  gl_.depth_func(GL_LESS);
  gl_.depth_mask(GL_TRUE);
  gl_.clear(GL_DEPTH_BUFFER_BIT);
  gl_.use_program(program_);
  gl_.uniform4f(colour_uniform_, static_cast<float>(colour.red), static_cast<float>(colour.green),
                static_cast<float>(colour.blue), 1.0F);
  gl_.bind_vertex_array(array_);
  gl_.bind_buffer(GL_ARRAY_BUFFER, buffers_[0]);
  gl_.buffer_data(GL_ARRAY_BUFFER, static_cast<std::ptrdiff_t>(vertices.size_bytes()),
                  vertices.data(), GL_STREAM_DRAW);
  gl_.buffer_data(GL_ELEMENT_ARRAY_BUFFER, static_cast<std::ptrdiff_t>(triangles.size_bytes()),
                  triangles.data(), GL_STREAM_DRAW);
  gl_.draw_elements(GL_TRIANGLES, static_cast<int>(3 * triangles.size()), GL_UNSIGNED_INT, nullptr);
  gl_.bind_vertex_array(0);
  gl_.disable(GL_DEPTH_TEST);
  gl_.enable(GL_BLEND);
}

}  // namespace haptrial::render
