#include "core/bone/surface/border_shares.h"

#include <algorithm>
#include <cmath>

namespace haptrial::bone {
namespace {

constexpr int kNoFace = -1;
constexpr int kRounds = 60;        // of relaxation: terraces of some twenty voxels become slopes
constexpr int kSpreading = 8;      // rounds
constexpr float kSteep = 0.78F;    // flatness of a slope of about 1 in 2
constexpr float kFlat = 0.88F;     // and of 1 in 4
constexpr float kOverstep = 1.8F;  // of a round: successive overrelaxation
constexpr float kHalf = 0.5F;      // of a voxel, that a face may stand in or out by

bool is_filled(const BoneVolume& volume, std::int32_t address) {
  return volume.label(address) != 0 && volume.original(address) > 0.0F;
}

/// The faces of a volume that look along one axis in one direction, with what they stand out by.
class Membrane {
 public:
  Membrane(const BoneVolume& volume, const Voxel& out) : volume_(volume), out_(out) {
    find_faces();
    find_neighbours();
  }

  void relax() {
    spread_flatness();
    for (int round = 0; round < kRounds; ++round) {
      for (Face& face : faces_) {
        if (face.moves) {
          face.height = relaxed(face);
        }
      }
    }
  }

  /// visit(address of the voxel, how far its face stands out).
  template <class Visit>
  void for_each_moved(const Visit& visit) const {
    for (const Face& face : faces_) {
      if (face.moves) {
        visit(face.address, weight_of(face.flatness) * face.height);
      }
    }
  }

 private:
  struct Face {
    std::int32_t address;
    std::array<std::int32_t, 4> beside{kNoFace, kNoFace, kNoFace, kNoFace};
    std::array<std::int8_t, 4> step{};  // of that one, along the axis
    float height{0.0F};
    float flatness{0.0F};  // share of faces beside it at its own height
    bool moves{false};
  };
  using Numbers = std::array<std::int32_t, BoneVolume::kBrickVoxels>;

  bool is_face(const Voxel& voxel, std::int32_t address) const {
    return is_filled(volume_, address) && !is_filled(volume_, volume_.address(voxel + out_)) &&
           is_filled(volume_, volume_.address(voxel - out_));  // no sheet
  }

  void find_faces() {
    numbers_.resize(static_cast<std::size_t>(volume_.bricks()));
    for (std::int32_t brick = 1; brick < volume_.bricks(); ++brick) {
      for (int place = 0; place < BoneVolume::kBrickVoxels; ++place) {
        const std::int32_t address = brick * BoneVolume::kBrickVoxels + place;
        if (volume_.label(address) == 0 || !is_face(volume_.voxel_at(address), address)) {
          continue;
        }
        std::unique_ptr<Numbers>& numbers = numbers_[static_cast<std::size_t>(brick)];
        if (numbers == nullptr) {
          numbers = std::make_unique<Numbers>();
          numbers->fill(kNoFace);
        }
        (*numbers)[static_cast<std::size_t>(place)] = static_cast<std::int32_t>(faces_.size());
        faces_.push_back({address});
      }
    }
  }

  std::int32_t number_at(const Voxel& voxel) const {
    const auto address = static_cast<std::size_t>(volume_.address(voxel));
    const auto& numbers = numbers_[address / BoneVolume::kBrickVoxels];
    return numbers == nullptr ? kNoFace : (*numbers)[address % BoneVolume::kBrickVoxels];
  }

  void find_neighbours() {
    for (Face& face : faces_) {
      const Voxel voxel = volume_.voxel_at(face.address);
      std::size_t side = 0;
      face.moves = true;
      for (int axis = 0; axis < 3; ++axis) {
        if (out_[axis] != 0) {
          continue;
        }
        const bool up = find_beside(face, side++, voxel + Voxel::Unit(axis));
        const bool down = find_beside(face, side++, voxel - Voxel::Unit(axis));
        face.moves = face.moves && (up || down);
      }
      for (std::size_t n = 0; n < side; ++n) {
        face.flatness += face.beside[n] != kNoFace && face.step[n] == 0 ? 0.25F : 0.0F;
      }
    }
  }

  bool find_beside(Face& face, std::size_t side, const Voxel& voxel) const {
    for (const int step : {0, 1, -1}) {
      const std::int32_t number = number_at(voxel + step * out_);
      if (number != kNoFace) {
        face.beside[side] = number;
        face.step[side] = static_cast<std::int8_t>(step);
        return true;
      }
    }
    return false;
  }

  /// The mean over the faces around, whose steps are a matter of luck.
  void spread_flatness() {
    for (int round = 0; round < kSpreading; ++round) {
      for (Face& face : faces_) {
        float sum = face.flatness;
        float count = 1.0F;
        for (const std::int32_t number : face.beside) {
          if (number != kNoFace) {
            sum += faces_[static_cast<std::size_t>(number)].flatness;
            count += 1.0F;
          }
        }
        face.flatness = sum / count;
      }
    }
  }

  static float weight_of(float flatness) {
    return std::clamp((flatness - kSteep) / (kFlat - kSteep), 0.0F, 1.0F);
  }

  float relaxed(const Face& face) const {
    float sum = 0.0F;
    float count = 0.0F;
    for (std::size_t side = 0; side < face.beside.size(); ++side) {
      if (face.beside[side] != kNoFace) {
        sum += faces_[static_cast<std::size_t>(face.beside[side])].height + face.step[side];
        count += 1.0F;
      }
    }
    const float wanted = face.height + kOverstep * (sum / count - face.height);
    return std::clamp(wanted, -kHalf, kHalf);
  }

  const BoneVolume& volume_;
  Voxel out_;
  std::vector<Face> faces_;
  std::vector<std::unique_ptr<Numbers>> numbers_;  // of faces, by brick
};

/// The share of the last voxel of a flat whose smoothed field is half full `height` beyond its
/// face: docs/algorithms/bone-surface.md, solved for the share.
float share_of(float height) { return (5.0F + 4.0F * height) / (5.0F - 2.0F * height); }

}  // namespace

BorderShares::BorderShares(const BoneVolume& volume) {
  bricks_.resize(static_cast<std::size_t>(volume.bricks()));
  std::vector<std::unique_ptr<std::array<float, BoneVolume::kBrickVoxels>>> sums(bricks_.size());
  for (int side = 0; side < 6; ++side) {
    Membrane membrane(volume, (side % 2 == 0 ? 1 : -1) * Voxel::Unit(side / 2));
    membrane.relax();
    membrane.for_each_moved([&](std::int32_t address, float height) {
      auto& sum = sums[static_cast<std::size_t>(address / BoneVolume::kBrickVoxels)];
      if (sum == nullptr) {
        sum = std::make_unique<std::array<float, BoneVolume::kBrickVoxels>>();
        sum->fill(0.0F);
      }
      (*sum)[static_cast<std::size_t>(address % BoneVolume::kBrickVoxels)] += height;
    });
  }
  for (std::size_t brick = 0; brick < sums.size(); ++brick) {
    if (sums[brick] == nullptr) {
      continue;
    }
    bricks_[brick] = std::make_unique<Brick>();
    std::transform(
        sums[brick]->begin(), sums[brick]->end(), bricks_[brick]->begin(), [](float height) {
          const float share = share_of(std::clamp(height, -kHalf, kHalf));
          return static_cast<std::uint8_t>(
              std::clamp(static_cast<int>(std::lround(kWhole * share)), kWhole / 2, kMost));
        });
  }
}

}  // namespace haptrial::bone
