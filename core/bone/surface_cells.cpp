#include "core/bone/surface_cells.h"

#include <algorithm>
#include <cmath>

namespace haptrial::bone {
namespace {

constexpr int kReach = 2;  // voxels on either side that count

/// The brick's voxels in the volume's addresses; 0 where there is none.
std::int32_t first_address(const BoneVolume& volume, const Voxel& brick_origin) {
  return volume.address(brick_origin);
}

}  // namespace

bool CellField::read(const BoneVolume& volume, const Occupancy& occupancy,
                     const Voxel& origin) noexcept {
  std::array<std::int32_t, 27> bricks{};
  for (int b = 0; b < 27; ++b) {
    bricks[static_cast<std::size_t>(b)] =
        first_address(volume, origin + kEdge * (Voxel(b % 3, b / 3 % 3, b / 9) - Voxel::Ones()));
  }
  std::size_t at = 0;
  int corners_filled = 0;
  for (int k = -kReach; k < kWide - kReach; ++k) {
    for (int j = -kReach; j < kWide - kReach; ++j) {
      const auto row =
          static_cast<std::size_t>(3 * ((j + kEdge) / kEdge) + 9 * ((k + kEdge) / kEdge));
      const int in_brick = kEdge * ((j + kEdge) % kEdge + kEdge * ((k + kEdge) % kEdge));
      const bool corner_row = j >= 0 && j < kCorner && k >= 0 && k < kCorner;
      for (int i = -kReach; i < kWide - kReach; ++i, ++at) {
        const std::int32_t first = bricks[row + static_cast<std::size_t>((i + kEdge) / kEdge)];
        const bool filled = first != 0 && occupancy.holds(first + in_brick + (i + kEdge) % kEdge);
        filled_[at] = filled ? 1 : 0;
        corners_filled += filled && corner_row && i >= 0 && i < kCorner ? 1 : 0;
      }
    }
  }
  return corners_filled > 0 && corners_filled < kCorner * kCorner * kCorner;
}

unsigned CellField::corners(int i, int j, int k) const noexcept {
  const std::uint16_t* first =
      filled_.data() + (i + kReach) + kWide * ((j + kReach) + kWide * (k + kReach));
  unsigned bits = 0;
  for (int b = 0; b < 8; ++b) {
    const int step = (b & 1) + kWide * ((b >> 1 & 1) + kWide * (b >> 2));
    bits |= static_cast<unsigned>(first[step]) << b;
  }
  return bits;
}

void CellField::smooth() noexcept {
  constexpr int kRow = kWide * kWide;
  std::array<std::uint16_t, kCorner * kRow> along_x;  // [k][j][i], i only of corners
  std::array<std::uint16_t, kCorner * kCorner * kWide> along_y;
  const auto sum = [](const std::uint16_t* p, int step) {
    return static_cast<std::uint16_t>(p[0] + 4 * p[step] + 6 * p[2 * step] + 4 * p[3 * step] +
                                      p[4 * step]);
  };
  for (int row = 0; row < kRow; ++row) {
    for (int i = 0; i < kCorner; ++i) {
      along_x[static_cast<std::size_t>(kCorner * row + i)] =
          sum(filled_.data() + kWide * row + i, 1);
    }
  }
  for (int k = 0; k < kWide; ++k) {
    for (int j = 0; j < kCorner; ++j) {
      for (int i = 0; i < kCorner; ++i) {
        along_y[static_cast<std::size_t>(kCorner * (kCorner * k + j) + i)] =
            sum(along_x.data() + kCorner * (kWide * k + j) + i, kCorner);
      }
    }
  }
  for (int at = 0; at < kCorner * kCorner * kCorner; ++at) {
    sums_[static_cast<std::size_t>(at)] = sum(along_y.data() + at, kCorner * kCorner);
  }
}

Eigen::Vector3f CellField::place(int i, int j, int k, unsigned corners,
                                 Eigen::Vector3f& normal) const noexcept {
  int total = 0;
  int lowest_filled = kFull;
  int highest_empty = 0;
  Eigen::Vector3i slope = Eigen::Vector3i::Zero();  // 4 times that of the sums
  Eigen::Vector3i step = Eigen::Vector3i::Zero();   // the same of filled and empty alone
  for (int b = 0; b < 8; ++b) {
    const Voxel side(b & 1, b >> 1 & 1, b >> 2);
    const int sum = sums_[static_cast<std::size_t>(
        (i + side.x()) + kCorner * ((j + side.y()) + kCorner * (k + side.z())))];
    const bool filled = (corners >> b & 1U) != 0;
    total += sum;
    slope += sum * (2 * side - Voxel::Ones());
    if (filled) {
      lowest_filled = std::min(lowest_filled, sum);
      step += 2 * side - Voxel::Ones();
    } else {
      highest_empty = std::max(highest_empty, sum);
    }
  }
  if (slope.dot(step) <= 0) {  // in a sheet or gap thinner than the smoothing
    slope = step;
    total = 0;
  }
  const Eigen::Vector3f gradient = slope.cast<float>() / 4.0F;
  const float squared = gradient.squaredNorm();
  if (squared == 0.0F) {
    normal = Eigen::Vector3f::UnitZ();
    return Eigen::Vector3f::Zero();
  }
  normal = gradient / -std::sqrt(squared);
  if (total == 0) {
    return Eigen::Vector3f::Zero();
  }
  // To where the field is half full, unless the voxels that are filled are less than that, as in
  // what is thin, or the empty ones more: the more they are, the less far.
  const float middle = 0.5F * static_cast<float>(lowest_filled + highest_empty);
  const float half = 0.5F * static_cast<float>(std::max(lowest_filled - highest_empty, 1));
  const float share = std::clamp(2.0F - std::abs(0.5F * kFull - middle) / half, 0.0F, 1.0F);
  const float way = share * (0.5F * kFull - static_cast<float>(total) / 8.0F) / squared;
  return (way * gradient).cwiseMax(-0.5F).cwiseMin(0.5F);
}

}  // namespace haptrial::bone
