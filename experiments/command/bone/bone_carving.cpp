#include "experiments/command/bone/bone_carving.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/base/error.h"

namespace haptrial::experiments {
namespace {

/// Finite numbers between commas; none where one is not.
std::vector<double> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    const std::string_view part = text.substr(0, text.find(','));
    double number = 0.0;
    const auto [end, error] = std::from_chars(part.begin(), part.end(), number);
    if (error != std::errc{} || end != part.end() || !std::isfinite(number)) {
      return {};
    }
    numbers.push_back(number);
    if (part.size() == text.size()) {
      return numbers;
    }
    text.remove_prefix(part.size() + 1);
  }
}

/// @param outside  of a point: how far from what is cut away, negative within it [m]
template <class Outside>
void cut_away(bone::BoneVolume& volume, const std::vector<bool>& spared, Outside&& outside) {
  constexpr int kVoxels = bone::BoneVolume::kBrickVoxels;
  const geometry::VoxelGrid& grid = volume.grid();
  const double around = 0.5 * std::sqrt(3.0) * (bone::BoneVolume::kEdge + 1) * grid.spacing;
  for (std::int32_t brick = 1; brick < volume.bricks(); ++brick) {
    const bone::Voxel first = volume.brick_origin(brick);
    const Eigen::Vector3d middle =
        grid.centre(first) + Eigen::Vector3d::Constant(3.5 * grid.spacing);
    if (outside(middle) > around) {
      continue;
    }
    for (std::int32_t at = brick * kVoxels; at < (brick + 1) * kVoxels; ++at) {
      const bone::Voxel voxel = volume.voxel_at(at);
      const std::uint8_t label = volume.label(at);
      if (volume.density(at) == 0.0F || (label < spared.size() && spared[label])) {
        continue;
      }
      const double off = outside(grid.centre(voxel));
      const double share = std::clamp(0.5 + off / grid.spacing, 0.0, 1.0);
      const float left = share < 1.0 ? static_cast<float>(share) * volume.original(at) : 1.0F;
      volume.take(at, std::max(0.0F, volume.density(at) - left));
    }
  }
}

}  // namespace

Stroke parse_stroke(const char* name, const std::string& text) {
  const std::vector<double> n = numbers_of(text);
  if ((n.size() != 4 && n.size() != 7) || !(n.back() > 0.0)) {
    throw InputError(fmt::format(
        "{} is '{}'; allowed: X,Y,Z,DIAMETER or X,Y,Z,X2,Y2,Z2,DIAMETER with a diameter above 0 "
        "[mm]",
        name, text));
  }
  const Eigen::Vector3d from(n[0], n[1], n[2]);
  const Eigen::Vector3d to = n.size() == 4 ? from : Eigen::Vector3d(n[3], n[4], n[5]);
  return {kMillimetre * from, kMillimetre * to, kMillimetre * 0.5 * n.back()};
}

PlaneCut parse_plane_cut(const char* name, const std::string& text) {
  const std::vector<double> n = numbers_of(text);
  if (n.size() != 7 || !(n[6] > 0.0) || Eigen::Vector3d(n[3], n[4], n[5]).norm() == 0.0) {
    throw InputError(fmt::format(
        "{} is '{}'; allowed: X,Y,Z,NX,NY,NZ,WIDTH with a normal and a width above 0 [mm]", name,
        text));
  }
  return {kMillimetre * Eigen::Vector3d(n[0], n[1], n[2]),
          Eigen::Vector3d(n[3], n[4], n[5]).normalized(), kMillimetre * 0.5 * n[6]};
}

void carve(bone::BoneVolume& volume, const Stroke& stroke, const std::vector<bool>& spared) {
  const Eigen::Vector3d along = stroke.to - stroke.from;
  const double squared = along.squaredNorm();
  cut_away(volume, spared, [&](const Eigen::Vector3d& point) {
    const double t = squared == 0.0 ? 0.0 : (point - stroke.from).dot(along) / squared;
    return (point - stroke.from - std::clamp(t, 0.0, 1.0) * along).norm() - stroke.radius;
  });
}

void carve(bone::BoneVolume& volume, const PlaneCut& cut, const std::vector<bool>& spared) {
  cut_away(volume, spared, [&](const Eigen::Vector3d& point) {
    return std::abs(cut.normal.dot(point - cut.point)) - cut.half_width;
  });
}

}  // namespace haptrial::experiments
