#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

#include "core/render/bone/bone_camera.h"
#include "core/render/gl/pixel_tiles.h"

namespace haptrial::render {

/// What a tool takes light away with: all within `radius` of the segment [m].
struct Capsule {
  Eigen::Vector3d from{0.0, 0.0, 0.0};
  Eigen::Vector3d to{0.0, 0.0, 0.0};
  double radius{0.0};
};

/// A ball in which bone lies that a shadow may fall on.
struct BoneBall {
  Eigen::Vector3d centre{0.0, 0.0, 0.0};
  double radius{0.0};
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
/// @param capsules, bones  in W; capsules from kMostCapsules on are left out
/// @param area  of the eye's picture
std::vector<PixelTiles::Part> shadowed_parts(const EyeView& view, const PixelBox& area,
                                             std::span<const Capsule> capsules,
                                             std::span<const BoneBall> bones);

}  // namespace haptrial::render
