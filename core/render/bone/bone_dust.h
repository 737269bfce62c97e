#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/bone/dust/dust.h"
#include "core/render/bone/bone_camera.h"
#include "core/render/gl/colour.h"
#include "core/render/gl/gl.h"
#include "core/render/gl/gl_buffer.h"

namespace haptrial::render {

/// The numbers of the quads from the farthest to the nearest, as seen from the eye.
std::vector<std::uint32_t> back_to_front(std::span<const bone::DustQuad> dust,
                                         const Eigen::Vector3d& eye);

/// Draws dust over what is drawn already. One thread, with the context current.
class DustDrawing {
 public:
  explicit DustDrawing(const Gl& gl);
  ~DustDrawing();
  DustDrawing(const DustDrawing&) = delete;
  DustDrawing& operator=(const DustDrawing&) = delete;

  /// @param shaded  the openness of a BoneLayer, which is bound, is that of this picture
  /// @param coarse  one lump a cell, larger, in place of two: half of the time
  void draw(std::span<const bone::DustQuad> dust, const EyeView& view, const Colour& colour,
            bool shaded, bool coarse);

 private:
  void send(std::span<const bone::DustQuad> dust, const Eigen::Vector3d& eye);

  Gl gl_;
  Gl::Name program_;
  int to_eye_;
  int to_clip_;
  int colour_;
  int widen_;
  GlBuffer corners_;
  GlBuffer triangles_;
  GlBuffer first_grains_;
  std::size_t numbered_{0};  // cells that have triangles
  Gl::Name array_{0};
};

}  // namespace haptrial::render
