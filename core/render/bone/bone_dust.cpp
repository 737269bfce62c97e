#include "core/render/bone/bone_dust.h"

#include <GL/glcorearb.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "core/render/bone/bone_layer.h"
#include "core/render/bone/bone_shaders.h"
#include "core/render/gl/gl_program.h"

namespace haptrial::render {

std::vector<std::uint32_t> back_to_front(std::span<const bone::DustQuad> dust,
                                         const Eigen::Vector3d& eye) {
  std::vector<float> distances(dust.size());
  std::transform(dust.begin(), dust.end(), distances.begin(), [&](const bone::DustQuad& quad) {
    return (quad.position - eye.cast<float>()).squaredNorm();
  });
  std::vector<std::uint32_t> order(dust.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return distances[a] > distances[b]; });
  return order;
}

DustDrawing::DustDrawing(const Gl& gl)
    : gl_(gl),
      program_(build_program(gl, "the dust", kDustVertexShader, kDustFragmentShader)),
      to_eye_(gl.get_uniform_location(program_, "to_eye")),
      to_clip_(gl.get_uniform_location(program_, "to_clip")),
      colour_(gl.get_uniform_location(program_, "dust")),
      quads_(gl, sizeof(bone::DustQuad)) {
  gl_.use_program(program_);
  gl_.uniform1i(gl.get_uniform_location(program_, "openness"), BoneLayer::kOpenness);
  gl_.gen_vertex_arrays(1, &array_);
  gl_.bind_vertex_array(array_);
  quads_.bind(GL_ARRAY_BUFFER);
  for (unsigned index = 0; index < 2; ++index) {
    gl_.enable_vertex_attrib_array(index);
    gl_.vertex_attrib_divisor(index, kGrains);
  }
  gl_.vertex_attrib_pointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(bone::DustQuad), nullptr);
  gl_.vertex_attrib_pointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(bone::DustQuad),
                            reinterpret_cast<const void*>(offsetof(bone::DustQuad, size)));
  gl_.bind_vertex_array(0);
}

DustDrawing::~DustDrawing() {
  gl_.delete_vertex_arrays(1, &array_);
  gl_.delete_program(program_);
}

void DustDrawing::draw(std::span<const bone::DustQuad> dust, const EyeView& view,
                       const Colour& colour, bool shaded) {
  if (dust.empty()) {
    return;
  }
  const std::vector<std::uint32_t> order = back_to_front(dust, view.eye);
  quads_.update(dust.size(), order, [&](ItemRange range, std::byte* to) {
    for (std::size_t i = 0; i < range.count; ++i) {
      std::memcpy(to + i * sizeof(bone::DustQuad), &dust[order[range.first + i]],
                  sizeof(bone::DustQuad));
    }
  });
  const Eigen::Matrix4f to_eye = view.view.cast<float>();
  const Eigen::Matrix4f to_clip = view.projection.cast<float>();
  gl_.use_program(program_);
  gl_.uniform_matrix4fv(to_eye_, 1, GL_FALSE, to_eye.data());
  gl_.uniform_matrix4fv(to_clip_, 1, GL_FALSE, to_clip.data());
  gl_.uniform4f(colour_, static_cast<float>(colour.red), static_cast<float>(colour.green),
                static_cast<float>(colour.blue), shaded ? 1.0F : 0.0F);
  gl_.bind_vertex_array(array_);
  gl_.draw_arrays_instanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<int>(kGrains * dust.size()));
  gl_.bind_vertex_array(0);
}

}  // namespace haptrial::render
