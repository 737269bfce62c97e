#include "core/bone/data/ear_side.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace haptrial::bone {
namespace {

/// Middles of all labels, at once.
struct Middles {
  std::array<Eigen::Vector3d, 256> sum;
  std::array<std::size_t, 256> count{};
};

Middles middles_of(const BoneModel& model) {
  Middles middles;
  middles.sum.fill(Eigen::Vector3d::Zero());
  geometry::visit_voxels(model.grid, [&](const Eigen::Vector3i& voxel, std::size_t at) {
    const std::uint8_t label = model.labels[at];
    middles.sum[label] += voxel.cast<double>();
    ++middles.count[label];
  });
  return middles;
}

/// The middle of the first structure by one of these names that has voxels [voxels].
std::optional<Eigen::Vector3d> middle_of(const BoneModel& model, const Middles& middles,
                                         std::span<const char* const> names) {
  for (const char* name : names) {
    for (std::size_t label = 1; label < model.structures.size(); ++label) {
      if (model.structures[label].name == name && middles.count[label] > 0) {
        return middles.sum[label] / static_cast<double>(middles.count[label]);
      }
    }
  }
  return std::nullopt;
}

constexpr std::array kInner{"internal auditory canal", "bony labyrinth", "cochlear nerve"};
constexpr std::array kOuter{"external auditory canal", "malleus"};
constexpr std::array kBehind{"sigmoid sinus and dura", "vestibular aqueduct"};

}  // namespace

std::optional<EarDirections> ear_directions(const BoneModel& model) {
  const Middles middles = middles_of(model);
  const auto inner = middle_of(model, middles, kInner);
  const auto outer = middle_of(model, middles, kOuter);
  const auto behind = middle_of(model, middles, kBehind);
  if (!inner || !outer || !behind) {
    return std::nullopt;
  }
  const Eigen::Vector3d outwards = *outer - *inner;
  const Eigen::Vector3d back = *behind - *outer;
  if (!(outwards.norm() > 0.0 && back.norm() > 0.0)) {
    return std::nullopt;
  }
  return EarDirections{outwards.normalized(), back.normalized()};
}

std::optional<EarSide> ear_side(const BoneModel& model) {
  const auto directions = ear_directions(model);
  constexpr double kAlong = 0.5;  // cosine
  if (!directions || std::abs(directions->outwards.x()) < kAlong) {
    return std::nullopt;
  }
  return directions->outwards.x() < 0.0 ? EarSide::kRight : EarSide::kLeft;
}

Eigen::Vector3d outside_view(const BoneModel& model) {
  const Eigen::Vector3d right(-1.0, 0.2, 0.1);
  return ear_side(model) == EarSide::kLeft ? Eigen::Vector3d(-right.x(), right.y(), right.z())
                                           : right;
}

BoneModel mirrored(const BoneModel& model) {
  BoneModel other = model;
  const geometry::VoxelGrid& grid = model.grid;
  const auto row = static_cast<std::ptrdiff_t>(grid.size[0]);
  const auto turn_rows = [&](auto& values) {
    for (auto at = values.begin(); at != values.end(); at += row) {
      std::reverse(at, at + row);
    }
  };
  turn_rows(other.labels);
  turn_rows(other.density);
  other.grid.origin.x() = -grid.centre(grid.size[0] - 1, 0, 0).x();
  other.source += "; left and right exchanged";
  return other;
}

}  // namespace haptrial::bone
