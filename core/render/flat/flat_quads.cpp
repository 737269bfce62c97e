#include "core/render/flat/flat_quads.h"

#include <GL/glcorearb.h>

namespace haptrial::render {
namespace {

constexpr int kCorners = 4;
constexpr int kFloats = 4;  // of an attribute

}  // namespace

FlatQuads::FlatQuads(const Gl& gl, unsigned attributes)
    : gl_(gl), item_size_(attributes * kFloats * sizeof(float)) {
  gl_.gen_vertex_arrays(1, &vertex_array_);
  gl_.gen_buffers(1, &buffer_);
  bind();
  for (unsigned index = 0; index < attributes; ++index) {
    const std::size_t offset = index * kFloats * sizeof(float);
    gl_.enable_vertex_attrib_array(index);
    gl_.vertex_attrib_pointer(index, kFloats, GL_FLOAT, GL_FALSE, static_cast<int>(item_size_),
                              reinterpret_cast<const void*>(offset));
    gl_.vertex_attrib_divisor(index, 1);
  }
}

FlatQuads::~FlatQuads() {
  gl_.delete_buffers(1, &buffer_);
  gl_.delete_vertex_arrays(1, &vertex_array_);
}

void FlatQuads::bind() const {
  gl_.bind_vertex_array(vertex_array_);
  gl_.bind_buffer(GL_ARRAY_BUFFER, buffer_);
}

void FlatQuads::draw(const void* items, std::size_t count) const {
  gl_.buffer_data(GL_ARRAY_BUFFER, static_cast<std::ptrdiff_t>(count * item_size_), items,
                  GL_STREAM_DRAW);
  gl_.draw_arrays_instanced(GL_TRIANGLE_STRIP, 0, kCorners, static_cast<int>(count));
}

void begin_flat(const Gl& gl, int width, int height) {
  gl.viewport(0, 0, width, height);
  gl.disable(GL_SCISSOR_TEST);
  gl.disable(GL_DEPTH_TEST);
  gl.disable(GL_CULL_FACE);
  gl.enable(GL_BLEND);
  gl.blend_equation(GL_FUNC_ADD);
  gl.blend_func_separate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

}  // namespace haptrial::render
