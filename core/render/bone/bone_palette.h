#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/surface/surface_cells.h"
#include "core/render/bone/bone_style.h"

namespace haptrial::render {

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
