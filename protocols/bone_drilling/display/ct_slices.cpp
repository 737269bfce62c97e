#include "protocols/bone_drilling/display/ct_slices.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptrial::protocols {
namespace {

constexpr std::array<std::uint8_t, 3> kCross{255, 214, 64};
constexpr int kCrossGap = 4;  // half of the opening of the lines at the tip [px]

std::uint8_t byte_of(double share) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
}

/// Whether a pixel lies on the lines that cross in the middle of a slice and leave the tip free.
bool is_cross(int x, int y) {
  constexpr int kMiddle = CtSlices::kSide / 2;
  const int aside = std::abs(x - kMiddle);
  const int above = std::abs(y - kMiddle);
  return (x == kMiddle && above > kCrossGap) || (y == kMiddle && aside > kCrossGap);
}

}  // namespace

CtSlices::CtSlices(std::shared_ptr<const bone::BoneModel> model, const Eigen::Isometry3d& X_BW,
                   const SliceWindow& window)
    : model_(std::move(model)), X_BW_(X_BW), window_(window) {
  image_.width = kSide;
  image_.height = 3 * kSide + 2 * kGap;
  image_.rgb.assign(3UL * static_cast<std::size_t>(image_.width * image_.height), 0);
}

bone::Voxel CtSlices::voxel_at(const Plane& plane, const Eigen::Vector3d& tip_B, int x,
                               int y) const {
  constexpr double kPixel = kWidth / kSide;
  Eigen::Vector3d p_B = tip_B;
  p_B[plane.across] += kPixel * (x - kSide / 2);
  p_B[plane.down] += kPixel * (plane.upside_down ? kSide / 2 - y : y - kSide / 2);
  return model_->grid.nearest(p_B);
}

/// The structure that stands in a voxel; 0 for air, drilled bone and places outside the grid.
std::uint8_t CtSlices::label_at(const bone::BoneVolume& volume, const bone::Voxel& voxel) const {
  const std::int32_t address = volume.address(voxel);
  return address != 0 && volume.density(address) > 0.0F ? volume.label(address) : std::uint8_t{0};
}

CtSlices::Rgb CtSlices::grey(const bone::BoneVolume& volume, const bone::Voxel& voxel) const {
  const std::uint8_t label = label_at(volume, voxel);
  const double density = label == 0 ? 0.0 : static_cast<double>(volume.density(voxel));
  const double hardness = std::min(1.0, model_->structures[label].hardness);
  const double share = (density * hardness - window_.low) / (window_.high - window_.low);
  const std::uint8_t level = byte_of(share);
  return {level, level, level};
}

void CtSlices::draw_slice(const bone::BoneVolume& volume, std::size_t plane,
                          const Eigen::Vector3d& tip_B) {
  const Plane& axes = kPlanes[plane];
  std::uint8_t* pixel =
      image_.rgb.data() + 3UL * kSide * plane * static_cast<std::size_t>(kSide + kGap);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x, pixel += 3) {
      const bone::Voxel here = voxel_at(axes, tip_B, x, y);
      const std::uint8_t label = label_at(volume, here);
      const bool border = label != label_at(volume, voxel_at(axes, tip_B, x + 1, y)) ||
                          label != label_at(volume, voxel_at(axes, tip_B, x, y + 1));
      Rgb colour = grey(volume, here);
      const bone::Structure& structure = model_->structures[label];
      if (label != 0 && border && structure.name != bone::kPlainBone) {
        std::transform(structure.colour.begin(), structure.colour.end(), colour.begin(), byte_of);
      }
      if (is_cross(x, y)) {
        colour = kCross;
      }
      std::copy(colour.begin(), colour.end(), pixel);
    }
  }
}

std::shared_ptr<const std::vector<render::Image>> CtSlices::at(const bone::BoneVolume& volume,
                                                               const Eigen::Vector3d& tip_W) {
  const Eigen::Vector3d tip_B = X_BW_ * tip_W;
  if (tip_B.allFinite() && tip_B.cwiseAbs().maxCoeff() < 1.0) {
    for (std::size_t plane = 0; plane < kPlanes.size(); ++plane) {
      if (!drawn_ || plane == next_) {
        draw_slice(volume, plane, tip_B);
      }
    }
    drawn_ = true;
    next_ = (next_ + 1) % kPlanes.size();
  }
  return std::make_shared<const std::vector<render::Image>>(1, image_);
}

}  // namespace haptrial::protocols
