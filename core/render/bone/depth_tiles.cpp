#include "core/render/bone/depth_tiles.h"

#include <GL/glcorearb.h>

#include "core/base/error.h"

namespace haptrial::render {
namespace {

constexpr int kTile = PixelTiles::kEdge;

/// The least and the greatest depth of bone in a tile; the greatest is 0 where there is none.
constexpr const char* kTileShader = R"(#version 330 core
uniform sampler2D depths;
uniform vec4 area;  // left, edge of a tile, width, height of the eye's picture [px]
out vec2 result;
void main() {
  ivec2 low = ivec2(gl_FragCoord.xy) * int(area.y);
  ivec2 high = min(low + int(area.y), ivec2(area.zw));
  result = vec2(1.0, 0.0);
  for (int j = low.y; j < high.y; ++j) {
    for (int i = low.x; i < high.x; ++i) {
      float depth = texelFetch(depths, ivec2(i + int(area.x), j), 0).r;
      if (depth < 1.0) {
        result = vec2(min(result.x, depth), max(result.y, depth));
      }
    }
  }
})";

/// The place in the eye's frame of a point of the picture, as the shading's shaders have it.
Eigen::Vector3d place_of(const Eigen::Vector2d& across, double depth, const Eigen::Matrix4d& p) {
  const double away = p(2, 3) / (2.0 * depth - 1.0 + p(2, 2));
  return away *
         Eigen::Vector3d((across.x() + p(0, 2)) / p(0, 0), (across.y() + p(1, 2)) / p(1, 1), -1.0);
}

}  // namespace

DepthTiles::DepthTiles(const Gl& gl, int unit)
    : gl_(gl),
      program_(build_program(gl, "the tiles' depths", kScreenVertexShader, kTileShader)),
      area_(gl.get_uniform_location(program_, "area")) {
  gl_.use_program(program_);
  gl_.uniform1i(gl_.get_uniform_location(program_, "depths"), unit);
  gl_.gen_vertex_arrays(1, &nothing_);
  gl_.gen_textures(1, &texture_);
  gl_.gen_framebuffers(1, &framebuffer_);
}

DepthTiles::~DepthTiles() {
  gl_.delete_framebuffers(1, &framebuffer_);
  gl_.delete_textures(1, &texture_);
  gl_.delete_vertex_arrays(1, &nothing_);
  gl_.delete_program(program_);
}

void DepthTiles::change(const PixelBox& part) { changed_.extend(part); }

void DepthTiles::make_room(const EyeArea& area) {
  const Eigen::Vector2i tiles((area.width + kTile - 1) / kTile, (area.height + kTile - 1) / kTile);
  gl_.bind_framebuffer(GL_FRAMEBUFFER, framebuffer_);
  if (tiles == tiles_) {
    return;
  }
  tiles_ = tiles;
  changed_ = all_pixels(area.width, area.height);
  depths_.resize(static_cast<std::size_t>(tiles.prod()));
  gl_.active_texture(GL_TEXTURE0);
  gl_.bind_texture(GL_TEXTURE_2D, texture_);
  gl_.tex_image_2d(GL_TEXTURE_2D, 0, GL_RG32F, tiles.x(), tiles.y(), 0, GL_RG, GL_FLOAT, nullptr);
  gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_.bind_texture(GL_TEXTURE_2D, 0);
  gl_.framebuffer_texture_2d(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
  if (gl_.check_framebuffer_status(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw RunError("OpenGL gives no framebuffer for the depths of the bone");
  }
}

void DepthTiles::find(const EyeArea& area) {
  const Eigen::Vector2i first = changed_.min() / kTile;
  const Eigen::Vector2i count = changed_.max() / kTile - first + Eigen::Vector2i::Ones();
  gl_.use_program(program_);
  gl_.uniform4f(area_, static_cast<float>(area.left), static_cast<float>(kTile),
                static_cast<float>(area.width), static_cast<float>(area.height));
  gl_.disable(GL_BLEND);
  gl_.disable(GL_DEPTH_TEST);
  gl_.disable(GL_CULL_FACE);
  gl_.enable(GL_SCISSOR_TEST);
  gl_.viewport(0, 0, tiles_.x(), tiles_.y());
  gl_.scissor(first.x(), first.y(), count.x(), count.y());
  gl_.bind_vertex_array(nothing_);
  gl_.draw_arrays_instanced(GL_TRIANGLES, 0, 3, 1);
  gl_.bind_vertex_array(0);
  gl_.disable(GL_SCISSOR_TEST);
  gl_.enable(GL_CULL_FACE);
  gl_.enable(GL_DEPTH_TEST);
  gl_.pixel_storei(GL_PACK_ALIGNMENT, 4);
  gl_.read_pixels(0, 0, tiles_.x(), tiles_.y(), GL_RG, GL_FLOAT, depths_.data());
  changed_.setEmpty();
}

const std::vector<BoneColumn>& DepthTiles::columns(const Eigen::Matrix4d& lens,
                                                   const EyeArea& area) {
  make_room(area);
  if (!changed_.isEmpty()) {
    find(area);
  }
  columns_.clear();
  const PixelBox all = all_pixels(area.width, area.height);
  const Eigen::Vector2d size(area.width, area.height);
  const double half_diagonal =
      (kTile / size.array() / lens.diagonal().head<2>().array().abs()).matrix().norm();
  for (int row = 0; row < tiles_.y(); ++row) {
    for (int column = 0; column < tiles_.x(); ++column) {
      const Eigen::Vector2f& depth = depths_[static_cast<std::size_t>(column + tiles_.x() * row)];
      if (depth.y() == 0.0F) {
        continue;
      }
      const Eigen::Vector2i low = kTile * Eigen::Vector2i(column, row);
      const Eigen::Vector2d across =
          2.0 * (low.cast<double>().array() + 0.5 * kTile) / size.array() - 1.0;
      const Eigen::Vector3d farthest = place_of(across, depth.y(), lens);
      columns_.push_back({place_of(across, depth.x(), lens), farthest,
                          -farthest.z() * half_diagonal,
                          PixelBox(low, low.array() + kTile - 1).intersection(all)});
    }
  }
  return columns_;
}

}  // namespace haptrial::render
