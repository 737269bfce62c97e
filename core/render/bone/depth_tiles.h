#pragma once

#include <vector>

#include "core/render/bone/tool_shadow.h"
#include "core/render/gl/gl.h"

namespace haptrial::render {

/// How near and how far the bone lies that shows in each tile of an eye's picture: found by OpenGL
/// in the kept picture's depths, where they changed, and read back as one number pair for each
/// tile. One thread, with the context current.
class DepthTiles {
 public:
  /// @param unit  of the texture with the depths
  DepthTiles(const Gl& gl, int unit);
  ~DepthTiles();
  DepthTiles(const DepthTiles&) = delete;
  DepthTiles& operator=(const DepthTiles&) = delete;

  /// The depths of a part of the eye's picture, from its lower left, changed since they were read.
  void change(const PixelBox& part);
  /// The bone that shows, by tiles that have some. The depths are bound; another framebuffer,
  /// viewport and program are afterwards.
  /// @param lens  the eye's projection
  const std::vector<BoneColumn>& columns(const Eigen::Matrix4d& lens, const EyeArea& area);

 private:
  void make_room(const EyeArea& area);
  void find(const EyeArea& area);

  Gl gl_;
  Gl::Name program_;
  int area_;
  Gl::Name nothing_{0};
  Gl::Name texture_{0};
  Gl::Name framebuffer_{0};
  Eigen::Vector2i tiles_{0, 0};
  PixelBox changed_;  // pixels
  std::vector<Eigen::Vector2f> depths_;
  std::vector<BoneColumn> columns_;
};

}  // namespace haptrial::render
