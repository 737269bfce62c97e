#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/surface/surface_cells.h"
#include "core/render/gl/colour.h"

namespace haptrial::render {

/// How bone looks.
struct BoneStyle {
  Colour background{0.08, 0.09, 0.11};
  Colour hard_bone{0.93, 0.88, 0.78};  // of density 1
  Colour soft_bone{0.80, 0.58, 0.45};  // of density 0
  Colour dust{0.90, 0.83, 0.72};       // wet
  Colour blood{0.50, 0.03, 0.03};
  double ambient{0.22};           // light from everywhere
  double diffuse{0.72};           // light at the eye, by the cosine
  double specular{0.13};          // its reflection on wet bone, ...
  double shininess{32.0};         // ... by this power of the cosine
  double occlusion{0.85};         // share of the light that a closed-in place loses; 0: not drawn
  double occlusion_reach{0.005};  // how far what closes it in may lie [m]
  double shadow{0.5};             // share of the light that a tool takes; 0: not drawn
  double vignette{0.0};           // share of the light that the corners of a picture lose
  bool smooth_edges{true};        // of the whole picture
  bool shades_moving{false};      // all of this also while the camera moves: pictures, no screen
  double through_length{0.0007};  // the share of a structure's colour in the bone over it is
  double through_share{0.85};     // share exp(-depth / length) [m]
  /// The visibility pass on a thread of its own, for a screen. When it ends is then a matter of
  /// luck, and with it a pixel here and there: pictures that must be the same each time do without.
  bool background_visibility{false};
  bool visible_array{true};  // else the complete array always
  bool kept_layer{true};     // what rests is drawn once; else all in every frame
};

/// As a microscope shows wet bone.
BoneStyle microscope_style();

/// The colours of surface vertices, before they are lit.
class BonePalette {
 public:
  BonePalette(const BoneStyle& style, std::span<const bone::Structure> structures);

  /// Bone between soft and hard by density; a structure in its own colour; bone over a structure
  /// with share exp(-depth / through_length) of the structure's; at a border the colours of both
  /// sides run into each other.
  /// @returns red, green, blue, 255
  std::array<std::uint8_t, 4> of(const bone::SurfaceVertex& vertex) const;

 private:
  bool is_structure(std::uint8_t label) const;
  std::array<float, 3> colour_of(std::uint8_t label, const bone::SurfaceVertex& vertex) const;

  std::array<std::array<float, 3>, 256> bone_;  // by density
  std::vector<std::array<float, 3>> structures_;
  std::vector<bool> is_structure_;
  std::array<float, 256> through_;  // share by depth
};

}  // namespace haptrial::render
