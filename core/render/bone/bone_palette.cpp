#include "core/render/bone/bone_palette.h"

#include <algorithm>
#include <cmath>

namespace haptrial::render {
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

std::array<std::uint8_t, 4> BonePalette::of(const bone::SurfaceVertex& vertex) const {
  Rgb colour = bone_[vertex.density];
  if (vertex.label < is_structure_.size() && is_structure_[vertex.label]) {
    colour = structures_[vertex.label];
  } else if (vertex.near_label != 0 && vertex.near_label < structures_.size()) {
    colour = mixed(colour, structures_[vertex.near_label], through_[vertex.near_depth]);
  }
  const auto byte = [](float c) {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(c, 0.0F, 1.0F)));
  };
  return {byte(colour[0]), byte(colour[1]), byte(colour[2]), 255};
}

}  // namespace haptrial::render
