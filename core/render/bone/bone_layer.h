#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>

#include "core/render/gl/antialias.h"
#include "core/render/gl/gl.h"

namespace haptrial::render {

/// The pixels that a box may cover, with room for rounding; all of them where it reaches the
/// near plane; none for an empty box.
/// @param to_clip  from the box's frame to OpenGL's clip space
PixelBox pixels_of(const Eigen::AlignedBox3d& box, const Eigen::Matrix4d& to_clip, int width,
                   int height);

/// The pictures that a frame is put together from. Kept from frame to frame: the bones with their
/// normals and depth, how open each pixel lies, and the bones shaded by that. A copy of these is
/// what changes in every frame is drawn over. All are upside down: copied to a framebuffer of
/// OSMesa's, whose rows run the other way, they are then copied as they are, 25 times as fast. The
/// copies are exact. One thread, with the
/// context current.
class BoneLayer {
 public:
  explicit BoneLayer(const Gl& gl);
  ~BoneLayer();
  BoneLayer(const BoneLayer&) = delete;
  BoneLayer& operator=(const BoneLayer&) = delete;

  /// Later drawing goes to the kept picture of the bones, of width x height pixels: colour to
  /// attachment 0, normal to 1.
  /// @returns whether what was kept is still there
  /// @throws RunError when OpenGL does not give framebuffers of that size.
  bool begin(int width, int height);
  /// Later drawing goes to the openness, or to the shaded bones; what it reads are the textures
  /// kColour, kNormal, kDepth and kOpenness in the units of these numbers.
  void begin_openness() const;
  void begin_shaded() const;
  /// The shaded bones are the bones as they are.
  void shade_plainly() const;
  /// Makes a copy of the shaded bones.
  void copy() const;
  /// Later drawing goes over that copy; it may read the same textures.
  void begin_over() const;
  /// Smooths the edges of what was drawn over the copy, to a picture that is kept.
  /// @param left, width  of an eye's picture  @param parts  of it, from its lower left, that are
  /// not
  ///                     as they were the last time
  void smooth(int left, int width, std::span<const PixelBox> parts) const;
  /// Copies what was drawn over the copy, or the smoothed picture, to the lower left of the
  /// framebuffer that was bound at begin(), the right way up, and binds it again.
  void show(bool smooth) const;

  static constexpr int kColour = 0;
  static constexpr int kNormal = 1;
  static constexpr int kDepth = 2;
  static constexpr int kOpenness = 3;

 private:
  void make_room();
  void make_texture(int which, int format, Gl::Enum channels, Gl::Enum type, int filter);
  void attach(Gl::Name framebuffer, Gl::Enum attachment, Gl::Name texture) const;
  void check_complete();
  void bind_textures() const;

  static constexpr int kShaded = 4;
  static constexpr int kOver = 5;
  static constexpr int kSmooth = 6;
  Gl gl_;
  Antialias antialias_;
  std::array<Gl::Name, 7> textures_{};
  Gl::Name kept_{0};  // framebuffers
  Gl::Name openness_{0};
  Gl::Name shaded_{0};
  Gl::Name over_{0};
  Gl::Name smooth_{0};
  Gl::Name over_depth_{0};  // renderbuffers
  Gl::Name smooth_depth_{0};
  int width_{0};
  int height_{0};
  int shown_in_{0};  // framebuffer
};

}  // namespace haptrial::render
