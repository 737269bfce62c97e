#include "protocols/bone_drilling/display/placement_picture.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/bone/model/bone_volume.h"
#include "core/render/bone/bone_scene.h"
#include "core/render/flat/picture_quad.h"
#include "core/render/gl/offscreen.h"
#include "protocols/bone_drilling/display/bone_display.h"
#include "protocols/bone_drilling/display/stage_stills.h"

namespace haptrial::protocols {
namespace {

constexpr int kSharper = 2;                      // drawn pixels to one of the picture, each way
constexpr double kStructureShare = 0.55;         // of what shows through, in a pixel
constexpr double kCavityShare = 0.45;            // likewise
const render::Colour kCavity{0.95, 0.25, 0.20};  // unlike any known structure

/// Draws parts of a bone as the camera has them.
class Views {
 public:
  explicit Views(const PlacedBone& bone)
      : width_(kSharper * bone.width),
        height_(kSharper * bone.height),
        pose_(pose_of(bone.placement, bone.model->grid)) {
    frame_.camera = bone.camera;
    style_.visible_array = false;
  }
  render::Image draw(const bone::BoneModel& model, const render::BoneStyle& style, bool through) {
    const bone::BoneVolume volume(model);
    frame_.bones = {{0, &volume, pose_}};
    render::OffscreenContext context(width_, height_);
    render::BoneScene scene(context.gl(), style, model.structures,
                            through ? depths_of(model) : nullptr);
    scene.draw(frame_, width_, height_);
    return context.read();
  }
  const render::BoneStyle& style() const { return style_; }
  const Eigen::Isometry3d& pose() const { return pose_; }

 private:
  int width_;
  int height_;
  Eigen::Isometry3d pose_;
  render::BoneStyle style_;
  render::BoneFrame frame_;
};

/// Lays what is not background over a picture. @param share  of it in a pixel
void lay_over(const render::Image& over, double share, render::Image& image) {
  for (std::size_t at = 0; at < image.rgb.size(); at += 3) {
    const bool empty = over.rgb[at] == 0 && over.rgb[at + 1] == 0 && over.rgb[at + 2] == 0;
    for (std::size_t c = at; c < at + 3 && !empty; ++c) {
      image.rgb[c] = static_cast<std::uint8_t>(
          std::lround((1.0 - share) * image.rgb[c] + share * over.rgb[c]));
    }
  }
}

/// The model with only those voxels that `keeps` returns true for. @param keeps  by voxel's number
template <class Keeps>
bone::BoneModel part_of(const bone::BoneModel& model, Keeps&& keeps) {
  bone::BoneModel part = model;
  for (std::size_t at = 0; at < part.labels.size(); ++at) {
    if (part.labels[at] != 0 && !keeps(at)) {
      part.labels[at] = 0;
      if (!part.density.empty()) {
        part.density[at] = 0.0F;
      }
    }
  }
  return part;
}

bool holds_any(const bone::BoneModel& model) {
  return std::ranges::any_of(model.labels, [](std::uint8_t label) { return label != 0; });
}

render::Image bare_picture(const PlacedBone& bone) {
  const bone::BoneModel& model = *bone.model;
  Views views(bone);
  render::Image image = views.draw(model, views.style(), true);
  render::BoneStyle on_black = views.style();
  on_black.background = {};
  on_black.ambient = 0.4;  // nothing of what shows through is black
  const bone::BoneModel inner = part_of(model, [&](std::size_t at) {
    return model.structures[model.labels[at]].name != bone::kPlainBone;
  });
  if (holds_any(inner)) {
    lay_over(views.draw(inner, on_black, false), kStructureShare, image);
  }
  if (bone.cavity) {
    const subject::DrillingChart& chart = *bone.cavity;
    const subject::BurrReach reach =
        subject::burr_reach(chart, subject::cavity_floor(chart), bone.burr);
    const std::vector<float> depths = cavity_depths(model, views.pose(), chart, reach.floor);
    bone::BoneModel cavity = part_of(model, [&](std::size_t at) { return depths[at] >= 0.0F; });
    on_black.hard_bone = kCavity;
    on_black.soft_bone = kCavity;
    if (holds_any(cavity)) {
      lay_over(views.draw(cavity, on_black, false), kCavityShare, image);
    }
  }
  return render::coarser(image, kSharper);
}

}  // namespace

render::Image placement_picture(const PlacedBone& bone) {
  const auto bare = std::make_shared<const render::Image>(bare_picture(bone));
  render::OffscreenContext context(bare->width, bare->height);
  render::PictureQuad quad(context.gl(), bare->width, bare->height);
  quad.draw(bare, {{0.0, 0.0}, {static_cast<double>(bare->width), bare->height}});
  draw_placement_legend(context.gl(), bone);
  return context.read();
}

}  // namespace haptrial::protocols
