#include "core/bone/simulator/held_bone.h"

#include <bit>

#include "core/bone/simulator/plate.h"

namespace haptrial::bone {
namespace {

using Eigen::Vector3d;

constexpr int kFirstEvery = 4;        // of surface voxels
constexpr int kBricksPerTick = 24;    // with bone, that are looked at
constexpr int kPlacesPerTick = 4096;  // of the grid's bricks, with bone or without
constexpr double kRayReach = 4e-3;    // deeper samples say nothing [m]

bool holds(const BoneWorld& world, PieceSet pieces, const Voxel& voxel) noexcept {
  for (; pieces != 0; pieces &= pieces - 1) {
    if (world.volume(std::countr_zero(pieces)).density(voxel) > 0.0F) {
      return true;
    }
  }
  return false;
}

/// Away from the bone around a surface voxel; zero within bone, and where nothing has a side.
Vector3d outward(const BoneWorld& world, PieceSet pieces, const Voxel& voxel) noexcept {
  bool surface = false;
  for (int axis = 0; axis < 3 && !surface; ++axis) {
    const Voxel step = Voxel::Unit(axis);
    surface = !holds(world, pieces, voxel + step) || !holds(world, pieces, voxel - step);
  }
  Vector3d sum = Vector3d::Zero();
  if (!surface) {
    return sum;
  }
  constexpr int kWide = 2;  // voxels around: steps of single voxels are evened out
  for (int k = -kWide; k <= kWide; ++k) {
    for (int j = -kWide; j <= kWide; ++j) {
      for (int i = -kWide; i <= kWide; ++i) {
        if (!holds(world, pieces, voxel + Voxel(i, j, k))) {
          sum += Vector3d(i, j, k);
        }
      }
    }
  }
  const double length = sum.norm();
  return length > 0.5 ? Vector3d(sum / length) : Vector3d(Vector3d::Zero());
}

contact::Coupling coupling() {
  contact::Coupling coupling;
  coupling.stiffness = HeldBone::kHandStiffness;
  coupling.turning_stiffness = HeldBone::kHandTurning;
  coupling.contact_stiffness = HeldBone::kContactStiffness;
  coupling.friction = HeldBone::kFriction;
  return coupling;
}

}  // namespace

HeldBone::HeldBone() : tool_(coupling()) {
  samples_.reserve(kMostSamples + BoneVolume::kBrickVoxels);
  touching_.reserve(kMostSamples + BoneVolume::kBrickVoxels);
}

void HeldBone::begin(const Eigen::Isometry3d& hand) noexcept {
  begin_samples(0);
  tool_.begin(hand);
}

void HeldBone::begin_samples(PieceSet group) noexcept {
  samples_.clear();
  group_ = group;
  every_ = kFirstEvery;
  brick_ = 0;
}

/// Neighbours in a plane of the grid are not wanted together.
bool HeldBone::is_wanted(const Voxel& voxel) const noexcept {
  return ((voxel.x() + 3 * voxel.y() + 5 * voxel.z()) & (every_ - 1)) == 0;
}

void HeldBone::thin_out() noexcept {
  while (samples_.size() > kMostSamples) {
    every_ *= 2;
    std::erase_if(samples_, [this](const Sample& sample) { return !is_wanted(sample.voxel); });
  }
}

void HeldBone::sample_brick(const BoneWorld& world, const Voxel& first) noexcept {
  const PieceSet group = world.held_group();
  for (int n = 0; n < BoneVolume::kBrickVoxels; ++n) {
    const Voxel voxel = first + Voxel(n % 8, n / 8 % 8, n / 64);
    if (!is_wanted(voxel) || !holds(world, group, voxel)) {
      continue;
    }
    const Vector3d normal = outward(world, group, voxel);
    if (normal.squaredNorm() > 0.0) {
      samples_.push_back({voxel, normal, world.known_as(world.holder(voxel))});
    }
  }
  thin_out();
}

/// Goes on over the grid by the place of bricks, which is the same whatever a volume's memory.
void HeldBone::look_for_samples(const BoneWorld& world) noexcept {
  PieceSet born = 0;  // one in the making has no samples of its own
  for (PieceSet set = world.held_group(); set != 0; set &= set - 1) {
    const int piece = std::countr_zero(set);
    born |= world.is_born(piece) ? PieceSet{1} << piece : 0;
  }
  if (born != group_) {
    begin_samples(born);
  }
  const std::array<std::int32_t, 3> size = world.volume(0).view().table_size;
  const std::int32_t end = size[0] * size[1] * size[2];
  int places = 0;
  for (int bricks = 0; brick_ < end && bricks < kBricksPerTick && places < kPlacesPerTick;
       ++brick_, ++places) {
    bool any = false;
    for (PieceSet set = world.held_group(); set != 0; set &= set - 1) {
      const BoneVolume::View view = world.volume(std::countr_zero(set)).view();
      any = any || view.holding[view.table[brick_]] > 0;
    }
    if (any) {
      ++bricks;
      const Voxel at(brick_ % size[0], brick_ / size[0] % size[1], brick_ / (size[0] * size[1]));
      sample_brick(world, BoneVolume::kEdge * at);
    }
  }
}

void HeldBone::find_touching(const BoneWorld& world) noexcept {
  touching_.clear();
  const geometry::VoxelGrid& grid = world.volume(0).grid();
  const PieceSet group = world.held_group();
  for (int other = 0; other < world.pieces(); ++other) {
    if (((group >> other) & 1U) != 0 || !world.is_born(other)) {
      continue;
    }
    const Eigen::Isometry3d to_other = world.pose(other).inverse(Eigen::Isometry);
    int piece = -1;
    Eigen::Isometry3d change =
        Eigen::Isometry3d::Identity();  // from the held piece's bone frame to the other's
    for (const Sample& sample : samples_) {
      if (sample.piece != piece) {
        piece = sample.piece;
        change = to_other * world.pose(piece);
      }
      const Vector3d at = grid.centre(sample.voxel);
      const Vector3d from = change * at;
      const Vector3d to = from - kRayReach * (change.linear() * sample.normal_B);
      const auto depth = way_out(world, other, from, to);
      const int holder = depth ? world.holder(sample.voxel) : -1;
      if (holder >= 0 && ((group >> holder) & 1U) != 0) {
        const Eigen::Isometry3d& pose = world.pose(holder);
        touching_.push_back(
            {pose * at - tool_.pose().translation(), -(pose.linear() * sample.normal_B), *depth});
      }
    }
  }
}

HeldBone::HeldStep HeldBone::follow(const BoneWorld& world, const Eigen::Isometry3d& hand,
                                    double dt) noexcept {
  if (!hand.matrix().allFinite()) {
    return {tool_.pose(), Vector3d::Zero(), 0};
  }
  look_for_samples(world);
  find_touching(world);
  const Vector3d force = tool_.follow(hand, touching_, dt).force;
  return {tool_.pose(), force, static_cast<int>(touching_.size())};
}

}  // namespace haptrial::bone
