#include "core/render/bone/bone_palette.h"

#include <algorithm>
#include <cmath>

namespace haptrial::render {

BoneStyle microscope_style() {
  BoneStyle style;
  style.ambient = 0.24;
  style.diffuse = 0.72;
  style.specular = 0.22;
  style.shininess = 70.0;
  style.vignette = 0.6;
  return style;
}

namespace {

using Rgb = std::array<float, 3>;

Rgb rgb(const Colour& colour) {
  return {static_cast<float>(colour.red), static_cast<float>(colour.green),
          static_cast<float>(colour.blue)};
}

Rgb mixed(const Rgb& a, const Rgb& b, float share) {
  return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])};
}

}  // namespace

BonePalette::BonePalette(const BoneStyle& style, std::span<const bone::Structure> structures)
    : is_structure_(bone::all_but_bone(structures)) {
  for (std::size_t d = 0; d < bone_.size(); ++d) {
    bone_[d] = mixed(rgb(style.soft_bone), rgb(style.hard_bone), static_cast<float>(d) / 255.0F);
    const double depth = bone::SurfaceVertex::kDepthUnit * static_cast<double>(d);
    through_[d] = static_cast<float>(style.through_share * std::exp(-depth / style.through_length));
  }
  for (const bone::Structure& structure : structures) {
    structures_.push_back(rgb({structure.colour[0], structure.colour[1], structure.colour[2]}));
  }
}

bool BonePalette::is_structure(std::uint8_t label) const {
  return label < is_structure_.size() && is_structure_[label];
}

/// A structure in its own colour, bone over one with some of that.
std::array<float, 3> BonePalette::colour_of(std::uint8_t label,
                                            const bone::SurfaceVertex& vertex) const {
  if (is_structure(label)) {
    return structures_[label];
  }
  const Rgb& bone = bone_[vertex.density];
  return vertex.near_label != 0 && vertex.near_label < structures_.size()
             ? mixed(bone, structures_[vertex.near_label], through_[vertex.near_depth])
             : bone;
}

std::array<std::uint8_t, 4> BonePalette::of(const bone::SurfaceVertex& vertex) const {
  Rgb colour = colour_of(vertex.label, vertex);
  if (vertex.other_label != 0) {
    // Half way if both fill as much, and only one or the other a little way off.
    constexpr float kSteep = 1.7F;
    const float share = 0.5F + kSteep * (static_cast<float>(vertex.other_share) / 255.0F - 0.5F);
    colour = mixed(colour, colour_of(vertex.other_label, vertex), std::clamp(share, 0.0F, 1.0F));
  }
  const auto byte = [](float c) {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(c, 0.0F, 1.0F)));
  };
  return {byte(colour[0]), byte(colour[1]), byte(colour[2]), 255};
}

}  // namespace haptrial::render
