#include "core/bone/surface/surface_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace haptrial::bone {
namespace {

/// Five neighbours `step` apart, weighted 1, 4, 6, 4, 1.
template <class Number>
Number weighted(const Number* p, int step) {
  return static_cast<Number>(p[0] + p[4 * step] + 4 * (p[step] + p[3 * step]) + 6 * p[2 * step]);
}

/// Smooths a cube of kFrom³ numbers to one of (kFrom - 4)³, of which only the last step is as large
/// as its type.
template <int kFrom, class Number>
void smooth_cube(const Number* from, std::uint32_t* to) {
  constexpr int kTo = kFrom - 4;
  std::array<Number, kFrom * kFrom * kTo> along_x;
  std::array<Number, kFrom * kTo * kTo> along_y;
  for (int row = 0; row < kFrom * kFrom; ++row) {
    for (int i = 0; i < kTo; ++i) {
      along_x[static_cast<std::size_t>(kTo * row + i)] = weighted(from + kFrom * row + i, 1);
    }
  }
  for (int k = 0; k < kFrom; ++k) {
    const Number* plane = along_x.data() + kTo * kFrom * k;
    for (int at = 0; at < kTo * kTo; ++at) {
      along_y[static_cast<std::size_t>(kTo * kTo * k + at)] = weighted(plane + at, kTo);
    }
  }
  for (int at = 0; at < kTo * kTo * kTo; ++at) {
    const Number* p = along_y.data() + at;
    constexpr int kStep = kTo * kTo;
    to[at] = std::uint32_t{p[0]} + p[4 * kStep] + 4U * (std::uint32_t{p[kStep]} + p[3 * kStep]) +
             6U * std::uint32_t{p[2 * kStep]};
  }
}

/// Four times the slope in a cell of a cube of kSide³ numbers, from its eight corners.
template <int kSide, class Number>
Eigen::Vector3f slope_of(const Number* first) {
  Eigen::Vector3i slope = Eigen::Vector3i::Zero();
  for (int b = 0; b < 8; ++b) {
    const Voxel side(b & 1, b >> 1 & 1, b >> 2);
    const auto number = static_cast<int>(first[side.x() + kSide * (side.y() + kSide * side.z())]);
    slope += number * (2 * side - Voxel::Ones());
  }
  return slope.cast<float>();
}

/// The mean of the middles of the edges that are crossed, from the cell's middle, by its corners.
std::array<Eigen::Vector3f, 256> make_middles() {
  std::array<Eigen::Vector3f, 256> middles;
  for (unsigned corners = 0; corners < 256; ++corners) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    int crossed = 0;
    for (unsigned b = 0; b < 8; ++b) {
      for (unsigned axis = 1; axis < 8; axis *= 2) {
        if ((b & axis) == 0 && (corners >> b & 1U) != (corners >> (b | axis) & 1U)) {
          const auto along = [&](unsigned a) {
            return a == axis ? 0.0F : (b & a) != 0 ? 0.5F : -0.5F;
          };
          sum += Eigen::Vector3f(along(1), along(2), along(4));
          ++crossed;
        }
      }
    }
    middles[corners] = crossed == 0 ? sum : Eigen::Vector3f(sum / static_cast<float>(crossed));
  }
  return middles;
}
const std::array<Eigen::Vector3f, 256> kMiddles = make_middles();
constexpr float kThinShare = 0.5F;  // of the way there, or what is thin gets too thin
constexpr float kNearWay = 1.1F;    // a way that a bump or the surface itself may have [voxels]
constexpr float kFar = 1.4F;        // less than the 1.5 of a sheet of one voxel

/// Addition to the wide slope if other things close by outweigh the surface in it: the less it
/// agrees with the cell's own corners, the more of the nearer slope.
Eigen::Vector3f nearer_slopes(const Eigen::Vector3f& wide, const Eigen::Vector3f& slope,
                              const Eigen::Vector3f& step) {
  constexpr float kAgrees = 0.5F;  // cosine from which on the wide slope is enough
  constexpr float kStep = 200.0F * RemainingFraction::kWhole;  // as long as a slope of the sums
  const float lengths = wide.norm() * step.norm();
  const float cosine = lengths > 0.0F ? wide.dot(step) / lengths : 0.0F;
  const float doubt = 1.0F - std::clamp(cosine / kAgrees, 0.0F, 1.0F);
  return doubt * (slope + kStep * step);
}

}  // namespace

/// Rows of the wide cube: visit(number of the row, number of its first brick of the three along x,
/// y and z in them).
template <class Visit>
void CellField::for_each_row(const Visit& visit) {
  std::size_t row = 0;
  for (int k = kEdge - kReach; k < kEdge - kReach + kWide; ++k) {
    for (int j = kEdge - kReach; j < kEdge - kReach + kWide; ++j, ++row) {
      visit(row, static_cast<std::size_t>(3 * (j / kEdge) + 9 * (k / kEdge)), j % kEdge, k % kEdge);
    }
  }
}

/// Takes those voxels of which half or less is left out of filled_ that lie beside one with more.
void CellField::leave_out_rests(const RemainingFraction& remains) noexcept {
  Rows solid;
  for_each_row([&](std::size_t row, std::size_t first, int y, int z) {
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      bits |= RemainingFraction::more_than_half(remains.row(bricks_[first + b], y, z))
              << (kEdge * b);
    }
    solid[row] = holds_[row] & bits >> (kEdge - kReach);
  });
  // Rows around the cell's, first along x, then y, then z; only the corners' are used.
  Rows around;
  for (std::size_t row = 0; row < solid.size(); ++row) {
    around[row] = solid[row] | solid[row] << 1 | solid[row] >> 1;
  }
  for (const std::size_t step : {std::size_t{1}, std::size_t{kWide}}) {
    const Rows before = around;
    for (std::size_t row = step; row + step < around.size(); ++row) {
      around[row] |= before[row - step] | before[row + step];
    }
  }
  for (std::size_t row = 0; row < solid.size(); ++row) {
    filled_[row] = solid[row] | (holds_[row] & ~around[row]);
  }
}

bool CellField::read(const BoneVolume& volume, const Occupancy& occupancy,
                     const RemainingFraction& remains, const Voxel& origin) noexcept {
  bool whole = true;
  for (int b = 0; b < 27; ++b) {
    const Voxel brick = origin + kEdge * (Voxel(b % 3, b / 3 % 3, b / 9) - Voxel::Ones());
    const std::int32_t number = volume.address(brick) / BoneVolume::kBrickVoxels;
    bricks_[static_cast<std::size_t>(b)] = number;
    whole = whole && remains.all_whole(number);
  }
  for_each_row([&](std::size_t row, std::size_t first, int y, int z) {
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      const std::uint64_t layer = occupancy.layer(bricks_[first + b], z);
      bits |= static_cast<std::uint32_t>(layer >> (kEdge * y) & 0xFF) << (kEdge * b);
    }
    holds_[row] = bits >> (kEdge - kReach);
  });
  filled_ = holds_;
  if (!whole) {
    leave_out_rests(remains);
  }
  constexpr std::uint32_t kCorners = (1U << kCorner) - 1;
  std::uint32_t any = 0;
  std::uint32_t all = kCorners;
  for (std::size_t k = kReach; k < kReach + kCorner; ++k) {
    for (std::size_t j = kReach; j < kReach + kCorner; ++j) {
      const std::uint32_t row = filled_[j + kWide * k] >> kReach & kCorners;
      any |= row;
      all &= row;
    }
  }
  return any != 0 && all != kCorners;
}

CellField::Count CellField::count() const noexcept {
  constexpr std::uint32_t kCells = (1U << kEdge) - 1;
  Count found;
  for (std::size_t k = kReach; k < kReach + kEdge; ++k) {
    for (std::size_t j = kReach; j < kReach + kEdge; ++j) {
      const std::uint32_t* row = filled_.data() + j + kWide * k;
      const std::array<std::uint32_t, 4> rows{row[0] >> kReach, row[1] >> kReach,
                                              row[kWide] >> kReach, row[kWide + 1] >> kReach};
      const std::uint32_t any = rows[0] | rows[1] | rows[2] | rows[3];
      const std::uint32_t all = rows[0] & rows[1] & rows[2] & rows[3];
      const auto number = [](std::uint32_t bits) {
        return static_cast<std::size_t>(std::popcount(bits & kCells));
      };
      found.vertices += number((any | any >> 1) & ~(all & all >> 1));
      found.quads +=
          number(rows[0] ^ rows[0] >> 1) + number(rows[0] ^ rows[1]) + number(rows[0] ^ rows[2]);
    }
  }
  return found;
}

unsigned CellField::corners(int i, int j, int k) const noexcept {
  const std::uint32_t* row = filled_.data() + (j + kReach) + kWide * (k + kReach);
  const auto two = [&](int step) { return row[step] >> (i + kReach) & 3U; };
  return two(0) | two(1) << 2 | two(kWide) << 4 | two(kWide + 1) << 6;
}

void CellField::smooth(const RemainingFraction& remains, const BorderShares& border) noexcept {
  std::array<std::uint16_t, kWide * kWide * kWide> left;
  for_each_row([&](std::size_t row, std::size_t first, int y, int z) {
    std::array<std::uint32_t, 3> shares;
    for (std::size_t b = 0; b < 3; ++b) {
      shares[b] = remains.row(bricks_[first + b], y, z);
    }
    for (std::size_t i = 0; i < kWide; ++i) {
      const std::size_t x = i + kEdge - kReach;
      const std::uint32_t share = (shares[x / kEdge] >> (4 * (x % kEdge)) & 0xFU) + 1;
      left[kWide * row + i] = static_cast<std::uint16_t>((holds_[row] >> i & 1U) * share);
    }
    for (std::size_t b = 0; b < 3; ++b) {
      const std::uint8_t* shares_at_border = border.row(bricks_[first + b], y, z);
      for (std::size_t x = 0; shares_at_border != nullptr && x < kEdge; ++x) {
        const std::size_t i = kEdge * b + x - (kEdge - kReach);  // wraps below 0
        if (i < kWide) {
          std::uint16_t& here = left[kWide * row + i];
          here = static_cast<std::uint16_t>(
              (here * shares_at_border[x] + BorderShares::kWhole / 2) / BorderShares::kWhole);
        }
      }
    }
  });
  smooth_cube<kWide>(left.data(), sums_.data());
  smooth_cube<kSums>(sums_.data(), wide_sums_.data());
}

Eigen::Vector3f CellField::place(int i, int j, int k, unsigned corners,
                                 Eigen::Vector3f& normal) const noexcept {
  constexpr int kInner = (kSums - kCorner) / 2;  // of sums_ before the first corner
  const std::uint32_t* sums =
      sums_.data() + (i + kInner) + kSums * ((j + kInner) + kSums * (k + kInner));
  int total = 0;
  Eigen::Vector3f step = Eigen::Vector3f::Zero();  // of filled and empty alone
  for (int b = 0; b < 8; ++b) {
    const Voxel side(b & 1, b >> 1 & 1, b >> 2);
    const auto sum = static_cast<int>(sums[side.x() + kSums * (side.y() + kSums * side.z())]);
    total += sum;
    if ((corners >> b & 1U) != 0) {
      step += (2 * side - Voxel::Ones()).cast<float>();
    }
  }
  const Eigen::Vector3f slope = slope_of<kSums>(sums) / 4.0F;
  constexpr float kWeights =
      kFull / RemainingFraction::kWhole;  // of a sum: a slope of the sums is as long
  const Eigen::Vector3f wide =
      slope_of<kCorner>(wide_sums_.data() + i + kCorner * (j + kCorner * k)) / (4.0F * kWeights);
  const Eigen::Vector3f inwards = wide + nearer_slopes(wide, slope, step);
  const float length = inwards.norm();
  normal = length > 0.0F ? Eigen::Vector3f(inwards / -length) : Eigen::Vector3f::UnitZ();

  // The place goes along the slope to where the field is half full, which is no way off. In thin
  // bone the field never is, or far away: there the place goes to the middle of the cell's crossed
  // edges.
  const float missing = 0.5F * kFull - static_cast<float>(total) / 8.0F;
  const float steepness = slope.norm();
  const Eigen::Vector3f thin = kThinShare * kMiddles[corners];
  if (slope.dot(step) <= 0.0F || std::abs(missing) >= kFar * steepness) {
    return thin;
  }
  const float share =
      std::clamp((kFar - std::abs(missing) / steepness) / (kFar - kNearWay), 0.0F, 1.0F);
  const Eigen::Vector3f way = missing / (steepness * steepness) * slope;
  return (share * way + (1.0F - share) * thin).cwiseMax(-0.5F).cwiseMin(0.5F);
}

LabelMix::LabelMix(const BoneVolume& volume)
    : labels_(static_cast<std::size_t>(volume.bricks()), 0) {
  for (std::int32_t brick = 1; brick < volume.bricks(); ++brick) {
    std::uint8_t& one = labels_[static_cast<std::size_t>(brick)];
    for (int place = 0; place < BoneVolume::kBrickVoxels && one != kMixed; ++place) {
      const std::uint8_t label = volume.label(brick * BoneVolume::kBrickVoxels + place);
      one = one == 0 || label == 0 || label == one ? std::max(one, label) : kMixed;
    }
  }
}

bool LabelMix::is_mixed(const BoneVolume& volume, const Voxel& origin) const noexcept {
  std::uint8_t one = 0;
  for (int b = 0; b < 27; ++b) {
    const Voxel in_brick =
        origin + BoneVolume::kEdge * (Voxel(b % 3, b / 3 % 3, b / 9) - Voxel::Ones());
    const std::uint8_t label =
        labels_[static_cast<std::size_t>(volume.address(in_brick) / BoneVolume::kBrickVoxels)];
    if (label == kMixed || (one != 0 && label != 0 && label != one)) {
      return true;
    }
    one = std::max(one, label);
  }
  return false;
}

LabelMix::OtherLabel LabelMix::around(const BoneVolume& volume, const CellField& field,
                                      const Voxel& origin, const Voxel& of_brick,
                                      std::uint8_t own) noexcept {
  constexpr std::array<int, 4> kWeights{1, 3, 3, 1};
  std::array<int, 256> weights{};
  int all = 0;
  for (int n = 0; n < 64; ++n) {
    const Voxel step(n % 4, n / 4 % 4, n / 16);
    const Voxel voxel = of_brick + step - Voxel::Ones();
    if (field.is_filled(voxel)) {
      const int weight = kWeights[static_cast<std::size_t>(step.x())] *
                         kWeights[static_cast<std::size_t>(step.y())] *
                         kWeights[static_cast<std::size_t>(step.z())];
      weights[volume.label(Voxel(origin + voxel))] += weight;
      all += weight;
    }
  }
  const int mine = std::exchange(weights[own], 0);
  const auto most = std::max_element(weights.begin(), weights.end());
  if (all == 0 || *most == 0) {
    return {};
  }
  return {static_cast<std::uint8_t>(most - weights.begin()),
          static_cast<std::uint8_t>(255 * *most / (mine + *most))};
}

}  // namespace haptrial::bone
