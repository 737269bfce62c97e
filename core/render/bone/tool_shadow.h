#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/render/gl/pixel_tiles.h"

namespace haptrial::render {

/// Area of an eye's picture in the layer's [px].
struct EyeArea {
  int left{0};
  int width{0};
  int height{0};
};

/// A part of a tool that takes light away: all within `radius` of the segment [m].
struct Capsule {
  Eigen::Vector3d from{0.0, 0.0, 0.0};
  Eigen::Vector3d to{0.0, 0.0, 0.0};
  double radius{0.0};
};

/// Bone that shows in a part of an eye's picture: within `radius` of the segment from where it is
/// nearest to where it is farthest, in the eye's frame [m].
struct BoneColumn {
  Eigen::Vector3d nearest{0.0, 0.0, 0.0};
  Eigen::Vector3d farthest{0.0, 0.0, 0.0};
  double radius{0.0};
  PixelBox pixels;  // from the lower left of the eye's picture
};

/// The least distance between points of two segments.
double distance_of_segments(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c, const Eigen::Vector3d& d);

inline constexpr std::size_t kMostCapsules = 4;

/// The direction to the lamp, in the eye's frame: beside the eye, so that a shadow tells how high
/// a tool is.
Eigen::Vector3d to_lamp();

/// The parts of an eye's picture in which bone may be darkened, each with the capsules (a bit by
/// number) that may do it. The measures are those of the shadow's shader (bone_shading.cpp).
/// @param area  all of the picture
/// @param capsules  in the eye's frame; those from kMostCapsules on are left out
std::vector<PixelTiles::Part> shadowed_parts(const PixelBox& area,
                                             std::span<const Capsule> capsules,
                                             std::span<const BoneColumn> bone);

}  // namespace haptrial::render
