#pragma once

#include <span>
#include <vector>

#include "core/render/bone/bone_camera.h"
#include "core/render/bone/bone_layer.h"
#include "core/render/bone/bone_palette.h"
#include "core/render/bone/tool_shadow.h"
#include "core/render/gl/gl.h"

namespace haptrial::render {

/// Darkens bone that is closed in and bone under a tool. Each pixel follows from the kept picture
/// within kReach pixels around it, so a part drawn again is as it is in the whole. One thread,
/// with the context current; leaves its own program, blending and scissor behind.
class BoneShading {
 public:
  /// How far, in pixels, a change of the bones' picture reaches in the shaded one.
  static constexpr int kReach = 42;

  /// The pixels of an eye's shaded picture that a changed part may reach.
  static PixelBox reached_by(const PixelBox& part, int width, int height);

  explicit BoneShading(const Gl& gl, const BoneStyle& style);
  ~BoneShading();
  BoneShading(const BoneShading&) = delete;
  BoneShading& operator=(const BoneShading&) = delete;

  /// The layer's shaded bones from what it keeps of the bones, where they changed.
  /// @param part  changed pixels of the eye's picture, from its lower left; none: nothing is done
  void draw(const BoneLayer& layer, const EyeView& view, const EyeArea& area,
            const PixelBox& part) const;
  /// Draws the tools' shadows over the layer's copy, before the tools: the part of the bone's light
  /// that tools keep off. More than kMostCapsules are left out.
  /// @param capsules  in W
  /// @param bone      all that shows of it
  /// @returns the pixels that it may have darkened, from the eye's lower left
  std::vector<PixelBox> draw_shadows(const EyeView& view, const EyeArea& area,
                                     std::span<const Capsule> capsules,
                                     std::span<const BoneColumn> bone) const;

 private:
  struct Pass {
    Gl::Name program{0};
    int lens{-1};
    int depth_terms{-1};
    int area{-1};
    int measures{-1};
  };
  Pass make_pass(const char* whose, const char* fragment) const;
  void use(const Pass& pass, const EyeView& view, const EyeArea& area) const;
  void fill(const EyeArea& area, const PixelBox& part) const;
  void cast(std::span<const Capsule> capsules, unsigned which) const;

  Gl gl_;
  BoneStyle style_;
  Gl::Name nothing_{0};  // a vertex array: the corners follow from their numbers
  Pass openness_;
  Pass shade_;
  Pass shadow_;
  std::array<int, kMostCapsules> from_{};
  std::array<int, kMostCapsules> to_{};
  int count_{-1};
};

}  // namespace haptrial::render
