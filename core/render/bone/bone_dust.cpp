#include "core/render/bone/bone_dust.h"

#include <GL/glcorearb.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

#include "core/render/bone/bone_layer.h"
#include "core/render/bone/bone_shaders.h"

namespace haptrial::render {
namespace {

/// The corners of all grains of a cell.
using Corners = std::array<bone::DustQuad, 4 * kGrains>;
/// Two triangles for each grain, of all of a cell or of its first.
using Triangles = std::array<std::uint32_t, 6 * kGrains>;
using FirstTriangles = std::array<std::uint32_t, 6>;
constexpr float kWider = 1.3F;  // a lump that stands for two

template <class Triangles>
Triangles grains_of(std::size_t cell) {
  constexpr std::array<std::uint32_t, 6> kTwo{0, 1, 2, 2, 1, 3};
  Triangles triangles;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::size_t grain = kGrains * cell + i / kTwo.size();
    triangles[i] = static_cast<std::uint32_t>(4 * grain + kTwo[i % kTwo.size()]);
  }
  return triangles;
}

template <class Triangles>
void put_triangles(ItemRange cells, std::byte* to) {
  for (std::size_t i = 0; i < cells.count; ++i) {
    const auto triangles = grains_of<Triangles>(cells.first + i);
    std::memcpy(to + i * sizeof(Triangles), triangles.data(), sizeof(Triangles));
  }
}

}  // namespace

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
      widen_(gl.get_uniform_location(program_, "widen")),
      corners_(gl, sizeof(Corners)),
      triangles_(gl, sizeof(Triangles)),
      first_grains_(gl, sizeof(FirstTriangles)) {
  gl_.use_program(program_);
  gl_.uniform1i(gl.get_uniform_location(program_, "openness"), BoneLayer::kOpenness);
  gl_.gen_vertex_arrays(1, &array_);
  gl_.bind_vertex_array(array_);
  corners_.bind(GL_ARRAY_BUFFER);
  for (unsigned index = 0; index < 2; ++index) {
    gl_.enable_vertex_attrib_array(index);
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

/// Every corner is a vertex of its own: instances of four, of which there are thousands, cost
/// llvmpipe more than what they draw.
void DustDrawing::send(std::span<const bone::DustQuad> dust, const Eigen::Vector3d& eye) {
  const std::vector<std::uint32_t> order = back_to_front(dust, eye);
  corners_.fill(dust.size(), [&](ItemRange range, std::byte* to) {
    Corners corners;
    for (std::size_t i = 0; i < range.count; ++i) {
      corners.fill(dust[order[range.first + i]]);
      std::memcpy(to + i * sizeof(Corners), corners.data(), sizeof(Corners));
    }
  });
  if (dust.size() > numbered_) {
    numbered_ = dust.size() + dust.size() / 8;
    triangles_.fill(numbered_, put_triangles<Triangles>);
    first_grains_.fill(numbered_, put_triangles<FirstTriangles>);
  }
}

void DustDrawing::draw(std::span<const bone::DustQuad> dust, const EyeView& view,
                       const Colour& colour, bool shaded, bool coarse) {
  if (dust.empty()) {
    return;
  }
  send(dust, view.eye);
  const Eigen::Matrix4f to_eye = view.view.cast<float>();
  const Eigen::Matrix4f to_clip = view.projection.cast<float>();
  gl_.use_program(program_);
  gl_.uniform_matrix4fv(to_eye_, 1, GL_FALSE, to_eye.data());
  gl_.uniform_matrix4fv(to_clip_, 1, GL_FALSE, to_clip.data());
  gl_.uniform4f(colour_, static_cast<float>(colour.red), static_cast<float>(colour.green),
                static_cast<float>(colour.blue), shaded ? 1.0F : 0.0F);
  gl_.uniform1f(widen_, coarse ? kWider : 1.0F);
  gl_.bind_vertex_array(array_);
  (coarse ? first_grains_ : triangles_).bind(GL_ELEMENT_ARRAY_BUFFER);
  const std::size_t count =
      dust.size() * (coarse ? std::tuple_size_v<FirstTriangles> : std::tuple_size_v<Triangles>);
  gl_.draw_elements(GL_TRIANGLES, static_cast<int>(count), GL_UNSIGNED_INT, nullptr);
  gl_.bind_vertex_array(0);
}

}  // namespace haptrial::render
