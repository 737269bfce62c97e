#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/bone/surface/surface.h"
#include "core/render/bone/bone_blocks.h"
#include "core/render/bone/bone_layer.h"
#include "core/render/bone/bone_palette.h"
#include "core/render/bone/bone_visibility.h"
#include "core/render/gl/gl.h"
#include "core/render/gl/gl_buffer.h"

namespace haptrial::render {

/// A bone in a scene: its surface, its visible array, and both in OpenGL. One thread, with the
/// context current.
class BoneObject {
 public:
  /// @param id  for results of the visibility pass
  /// @param surface  that was built already; null: one is built with these depths
  BoneObject(const Gl& gl, std::uint32_t id, std::shared_ptr<const bone::StructureDepths> depths,
             std::shared_ptr<bone::Surface> surface = nullptr);
  ~BoneObject();
  BoneObject(const BoneObject&) = delete;
  BoneObject& operator=(const BoneObject&) = delete;

  /// Brings surface and buffers up to date.
  /// @param eyes    in B [m]
  /// @param worker  for the visibility pass; null: it is done here
  /// @returns the bytes sent to OpenGL
  std::size_t follow(const bone::BoneVolume& volume, const BonePalette& palette,
                     const std::vector<Eigen::Vector3d>& eyes, VisibilityWorker* worker);
  /// A finished pass; thrown away where the eyes or the surface have moved on.
  void take(const VisibilityResult& result);

  /// @param visible  may draw only the visible array, where there is one
  /// @returns triangles sent
  std::size_t draw(bool visible) const;
  /// Draws only the triangles that may fall into a part of a picture of width x height pixels, in
  /// the order of draw(): of two that have the same depth, the same one shows.
  /// @param to_clip  from B to clip space
  /// @param bent     there are dents, which move vertices: only whole blocks are left out then
  std::size_t draw(bool visible, const PixelBox& part, const Eigen::Matrix4d& to_clip, int width,
                   int height, bool bent);
  bool has_visible_array() const noexcept { return valid_; }
  /// Grows when the visible array is begun anew; 0 while there is none.
  std::uint64_t array() const noexcept { return valid_ ? generation_ : 0; }
  const BoneBlocks& blocks() const noexcept { return blocks_; }
  std::size_t triangle_count() const noexcept { return surface_->triangle_count(); }

 private:
  void look(const std::vector<Eigen::Vector3d>& eyes, VisibilityWorker* worker);
  std::size_t send(const BonePalette& palette);
  void copy_triangle(bool chosen, std::size_t place, std::byte* to, std::size_t i) const;
  class PartOfPicture;
  void gather(bool chosen, std::span<const std::int32_t> quads, const PartOfPicture* seen);
  void draw_triangles(const GlBuffer& from, std::size_t count) const;

  struct GpuVertex {
    std::array<float, 3> place;
    std::array<std::int16_t, 4> normal;  // and the label
    std::array<std::uint8_t, 4> colour;
  };

  Gl gl_;
  std::uint32_t id_;
  std::shared_ptr<bone::Surface> surface_;
  BoneBlocks blocks_;
  VisibleArray visible_;
  bool valid_{false};                  // visible_ is right for eyes_
  bool waiting_{false};                // for a pass
  bool rested_{false};                 // the eyes are where they were a frame ago
  std::uint64_t generation_{0};        // of passes
  std::vector<Eigen::Vector3d> eyes_;  // of the last frame
  std::vector<std::int32_t> since_;    // quads changed since the pass that is waited for
  GlBuffer vertices_;
  GlBuffer complete_;
  GlBuffer chosen_;                    // the visible array
  GlBuffer part_;                      // what is drawn of a part of the picture
  std::vector<std::uint32_t> places_;  // of these triangles in their array; kept for its room
  Gl::Name array_{0};
};

}  // namespace haptrial::render
