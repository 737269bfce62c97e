#include "core/bone/simulator/cut_plane.h"

#include <bit>
#include <cmath>

#include "core/base/definition/schema.h"
#include "core/bone/model/voxel_walk.h"

namespace haptrial::bone {
namespace {

// A square of rays so far apart leaves no point farther than 0.7 / sqrt(2) < 1/2 from a ray.
constexpr double kRaySpacing = 0.7;  // [voxels]
constexpr double kMaxSide = 1e4;     // [voxels]

bool can_cut(const CutPlane& plane, double spacing) {
  const auto side = [spacing](double length) {
    return length > 0.0 && length <= kMaxSide * spacing;
  };
  return plane.pose_WC.matrix().allFinite() && side(plane.width) && side(plane.height) &&
         plane.depth >= 0.0 && plane.depth <= kMaxSide * spacing;
}

int rays_along(double length, double spacing) {
  return static_cast<int>(std::ceil(length / (kRaySpacing * spacing)));
}

}  // namespace

const Schema<CutPlane>& cut_plane_schema() {
  using P = CutPlane;
  static const auto schema =
      Schema<P>()
          .number("width", &P::width, {0.0, 0.3, true}, "m", "Width of the plane of a cut")
          .required()
          .number("height", &P::height, {0.0, 0.3, true}, "m", "Height of the plane of a cut")
          .required()
          .number("depth", &P::depth, {0.0, 0.3}, "m",
                  "Thickness of the bone that a cut removes; 0: what the plane passes through")
          .required();
  return schema;
}

void CutPlaneTool::begin(const BoneWorld& world, const CutPlane& plane) noexcept {
  removed_ = {};
  plane_ = plane;
  const double spacing = world.volume(0).grid().spacing;
  busy_ = can_cut(plane, spacing);
  if (!busy_) {
    return;
  }
  columns_ = rays_along(plane.width, spacing);
  rows_ = rays_along(plane.height, spacing);
  pieces_ = 0;
  for (int piece = 0; piece < world.pieces(); ++piece) {
    if (world.is_born(piece)) {
      pieces_ |= PieceSet{1} << piece;
      pose_BC_[static_cast<std::size_t>(piece)] = world.pose(piece).inverse() * plane.pose_WC;
    }
  }
  piece_ = std::countr_zero(pieces_);
  ray_ = 0;
}

void CutPlaneTool::step(BoneWorld& world, int most) noexcept {
  // Volumes that were split off a piece since begin(), or are being so, lay where the piece did.
  const auto volumes_of = [&](int wanted) {
    PieceSet volumes = 0;
    for (int i = 0; i < world.pieces(); ++i) {
      int origin = i;
      while (((pieces_ >> origin) & 1U) == 0) {
        origin = world.parent(origin);
      }
      volumes |= origin == wanted ? PieceSet{1} << i : 0;
    }
    return volumes;
  };
  count_ = 0;
  PieceSet volumes = busy_ ? volumes_of(piece_) : 0;
  for (int passed = 0; busy_ && passed < most;) {
    const TraceResult ray = trace(world, volumes);
    if (!ray.whole) {
      return;  // the next step traces it again: what it has emptied is not in its way
    }
    passed += ray.passed;
    if (++ray_ == std::int64_t{columns_} * rows_) {
      busy_ = next_piece();
      volumes = busy_ ? volumes_of(piece_) : 0;
    }
  }
}

bool CutPlaneTool::next_piece() noexcept {
  ray_ = 0;
  const PieceSet rest = piece_ + 1 < kMaxPieces ? pieces_ >> (piece_ + 1) : 0;
  piece_ += 1 + (rest == 0 ? 0 : std::countr_zero(rest));
  return rest != 0;
}

CutPlaneTool::TraceResult CutPlaneTool::trace(BoneWorld& world, PieceSet volumes) noexcept {
  const auto place = [](std::int64_t number, int count, double length) {
    return length * ((static_cast<double>(number) + 0.5) / count - 0.5);
  };
  const Eigen::Vector3d from_C(place(ray_ % columns_, columns_, plane_.width),
                               place(ray_ / columns_, rows_, plane_.height), 0.0);
  const Eigen::Isometry3d& pose_BC = pose_BC_[static_cast<std::size_t>(piece_)];
  const Eigen::Vector3d to_C = from_C + plane_.depth * Eigen::Vector3d::UnitZ();
  TraceResult ray{0, true};
  walk_voxels(world.volume(0).grid(), pose_BC * from_C, pose_BC * to_C,
              [&](const Voxel& voxel, double, double) {
                ++ray.passed;
                for (PieceSet set = volumes; set != 0; set &= set - 1) {
                  const int piece = std::countr_zero(set);
                  BoneVolume& volume = world.volume(piece);
                  const std::int32_t address = volume.address(voxel);
                  if (!(volume.density(address) > 0.0F)) {
                    continue;
                  }
                  ray.whole = count_ < kMostEmptied;
                  if (!ray.whole) {
                    return false;
                  }
                  const std::uint8_t label = volume.label(address);
                  removed_.amount += static_cast<double>(volume.take(address, 1.0F));
                  ++removed_.voxels;
                  ++removed_.by_label[label];
                  emptied_[count_++] = {world.known_as(piece), voxel, label, true};
                }
                return true;
              });
  ray.passed = std::max(ray.passed, 1);
  return ray;
}

}  // namespace haptrial::bone
