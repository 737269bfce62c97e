#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/bone/surface/surface.h"
#include "core/render/bone/bone_blocks.h"
#include "core/render/bone/bone_layer.h"
#include "core/render/bone/bone_palette.h"
#include "core/render/gl/gl.h"
#include "core/render/gl/gl_buffer.h"

namespace haptrial::render {

/// A bone in a scene: its surface, also in OpenGL. One thread, with the context current.
class BoneObject {
 public:
  /// @param surface  that was built already; null: one is built with these depths
  BoneObject(const Gl& gl, std::shared_ptr<const bone::StructureDepths> depths,
             std::shared_ptr<bone::Surface> surface = nullptr);
  ~BoneObject();
  BoneObject(const BoneObject&) = delete;
  BoneObject& operator=(const BoneObject&) = delete;

  /// Brings surface and buffers up to date.
  /// @returns the bytes sent to OpenGL
  std::size_t follow(const bone::BoneVolume& volume, const BonePalette& palette);

  /// @returns triangles sent
  std::size_t draw() const;
  /// Draws only the triangles that may fall into a part of a picture of width x height pixels, in
  /// the order of draw(): of two that have the same depth, the same one shows.
  /// @param to_clip  from B to clip space
  /// @param bent     there are dents, which move vertices: only whole blocks are left out then
  std::size_t draw(const PixelBox& part, const Eigen::Matrix4d& to_clip, int width, int height,
                   bool bent);
  const BoneBlocks& blocks() const noexcept { return blocks_; }
  std::size_t triangle_count() const noexcept { return surface_->triangle_count(); }

 private:
  std::size_t send(const BonePalette& palette);
  class PartOfPicture;
  void gather(std::span<const std::int32_t> quads, const PartOfPicture* seen);
  void draw_triangles(const GlBuffer& from, std::size_t count) const;

  struct GpuVertex {
    std::array<float, 3> place;
    std::array<std::int16_t, 4> normal;  // and the label
    std::array<std::uint8_t, 4> colour;
  };

  Gl gl_;
  std::shared_ptr<bone::Surface> surface_;
  BoneBlocks blocks_;
  GlBuffer vertices_;
  GlBuffer complete_;
  GlBuffer part_;                     // what is drawn of a part of the picture
  std::vector<std::uint32_t> slots_;  // of these triangles; kept for its room
  Gl::Name array_{0};
};

}  // namespace haptrial::render
