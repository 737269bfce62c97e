#pragma once

#include <Eigen/Geometry>

#include "core/render/gl/gl.h"

namespace haptrial::render {

/// Pixels from min() to max(), both included, from the lower left of a framebuffer.
using PixelBox = Eigen::AlignedBox2i;

PixelBox all_pixels(int width, int height);
/// The pixels that a box may cover, with room for rounding; all of them where it reaches the
/// near plane; none for an empty box.
/// @param to_clip  from the box's frame to OpenGL's clip space
PixelBox pixels_of(const Eigen::AlignedBox3d& box, const Eigen::Matrix4d& to_clip, int width,
                   int height);

/// Two pictures with depth: one that is kept from frame to frame, and a copy that what changes in
/// every frame is drawn over. Both are upside down: copied to a framebuffer of OSMesa's, whose
/// rows run the other way, they are then copied as they are, 25 times as fast. The copies are
/// exact. One thread, with the context current.
class BoneLayer {
 public:
  explicit BoneLayer(const Gl& gl);
  ~BoneLayer();
  BoneLayer(const BoneLayer&) = delete;
  BoneLayer& operator=(const BoneLayer&) = delete;

  /// Later drawing goes to the kept picture, of width x height pixels.
  /// @returns whether what was kept is still there
  /// @throws RunError when OpenGL does not give framebuffers of that size.
  bool begin(int width, int height);
  /// Later drawing goes over a copy of the kept picture.
  void copy() const;
  /// Copies that to the lower left of the framebuffer that was bound at begin(), the right way up,
  /// and binds it again.
  void show() const;

 private:
  struct Target {
    Gl::Name framebuffer{0};
    Gl::Name colour{0};
    Gl::Name depth{0};
  };
  void make_room(const Target& target);

  Gl gl_;
  Target kept_;
  Target over_;
  int width_{0};
  int height_{0};
  int shown_in_{0};  // framebuffer
};

}  // namespace haptrial::render
