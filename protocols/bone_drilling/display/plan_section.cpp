#include "protocols/bone_drilling/display/plan_section.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "protocols/bone_drilling/definition/placement.h"

namespace haptrial::protocols {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

constexpr Rgb kAir{20, 23, 28};
constexpr Rgb kBone{222, 214, 196};
constexpr Rgb kRemoved{33, 158, 82};
constexpr Rgb kLeft{89, 153, 255};
constexpr Rgb kBesides{184, 209, 140};
constexpr Rgb kBeyond{255, 148, 26};
constexpr Rgb kInjured{230, 26, 26};

}  // namespace

PlanSection::PlanSection(const BoneDefinition& definition,
                         std::shared_ptr<const bone::BoneModel> model)
    : model_(std::move(model)) {
  const Eigen::Isometry3d X_WB = pose_of(definition.placement, model_->grid);
  X_BW_ = X_WB.inverse();
  const Camera& camera = definition.simulator.camera.start;
  const Eigen::Vector3d out_B = -(X_BW_.linear() * definition.cavity->inward);
  out_B.cwiseAbs().maxCoeff(&up_);
  upwards_ = out_B[up_] > 0.0;
  Eigen::Vector3d right_B = X_BW_.linear() * (camera.target - camera.eye).cross(camera.up);
  right_B[up_] = 0.0;
  right_B.cwiseAbs().maxCoeff(&across_);
  across_ = across_ == up_ ? (up_ + 1) % 3 : across_;
  rightwards_ = right_B[across_] >= 0.0;
  through_ = 3 - up_ - across_;
  made_ = std::async(std::launch::async, [bone = model_, X_WB, cavity = *definition.cavity,
                                          burr = smallest_burr(definition)] {
    return subject::plan_cavity(*bone, X_WB, cavity, burr);
  });
}

std::array<std::uint8_t, 3> PlanSection::colour_of(std::size_t index, bool stands) const {
  const std::uint8_t label = model_->labels[index];
  const subject::PlanPart part = plan_->parts[index];
  switch (part) {
    case subject::PlanPart::kPlanned:
      return stands ? kLeft : kRemoved;
    case subject::PlanPart::kMargin:
      return stands ? kBone : kBesides;
    case subject::PlanPart::kBeyond:
      return stands ? kBone : kBeyond;
    case subject::PlanPart::kVital:
      if (stands) {
        Rgb own{};
        std::transform(model_->structures[label].colour.begin(),
                       model_->structures[label].colour.end(), own.begin(),
                       [](double c) { return static_cast<std::uint8_t>(std::lround(255.0 * c)); });
        return own;
      }
      return kInjured;
    case subject::PlanPart::kAir:
      break;
  }
  return kAir;
}

std::shared_ptr<const std::vector<render::Image>> PlanSection::at(const bone::BoneVolume& volume,
                                                                  const Eigen::Vector3d& tip_W) {
  if (!plan_) {
    if (made_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      return nullptr;
    }
    plan_ = made_.get();
  }
  const geometry::VoxelGrid& grid = model_->grid;
  const Eigen::Vector3d tip = (X_BW_ * tip_W - grid.origin) / grid.spacing;
  const auto size = [&grid](int axis) { return grid.size[static_cast<std::size_t>(axis)]; };
  render::Image image{size(across_), size(up_), {}};
  bone::Voxel voxel;
  const double layer = std::isfinite(tip[through_]) ? std::round(tip[through_]) : 0.0;
  voxel[through_] = static_cast<int>(std::clamp(layer, 0.0, size(through_) - 1.0));
  for (int y = 0; y < image.height; ++y) {
    voxel[up_] = upwards_ ? image.height - 1 - y : y;
    for (int x = 0; x < image.width; ++x) {
      voxel[across_] = rightwards_ ? x : image.width - 1 - x;
      const std::size_t index = grid.index(voxel);
      const bool stands = model_->labels[index] != 0 && volume.density(voxel) > 0.0F;
      const Rgb colour = colour_of(index, stands);
      image.rgb.insert(image.rgb.end(), colour.begin(), colour.end());
    }
  }
  return std::make_shared<const std::vector<render::Image>>(1, std::move(image));
}

}  // namespace haptrial::protocols
