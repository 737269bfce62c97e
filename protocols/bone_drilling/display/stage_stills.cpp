#include "protocols/bone_drilling/display/stage_stills.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/bone/model/bone_volume.h"
#include "core/render/bone/bone_scene.h"
#include "core/render/gl/offscreen.h"
#include "core/subject/drilling/cavity_plan.h"
#include "protocols/bone_drilling/definition/placement.h"
#include "protocols/bone_drilling/display/bone_display.h"

namespace haptrial::protocols {

namespace {

/// @param width, height  of each [px]
std::vector<StageStill> make_stills(const BoneDefinition& d, const bone::BoneModel& model,
                                    const subject::DrillingChart& chart, int stages, int width,
                                    int height) {
  const Eigen::Isometry3d pose = pose_of(d.placement, model.grid);
  const subject::BurrReach reach =
      subject::burr_reach(chart, subject::cavity_floor(chart), smallest_burr(d));
  const std::vector<float> depths = cavity_depths(model, pose, chart, reach.floor);
  const float deepest = *std::max_element(depths.begin(), depths.end());

  constexpr int kFiner = 2;  // edges are smoothed
  render::BoneStyle style;
  style.visible_array = false;
  render::OffscreenContext context(kFiner * width, kFiner * height);
  render::BoneScene scene(context.gl(), style, model.structures, depths_of(model));
  bone::BoneVolume volume(model);
  const Camera& camera = d.simulator.camera.start;
  render::BoneFrame frame;
  frame.camera = camera;
  frame.bones = {{0, &volume, pose}};
  std::vector<StageStill> stills;
  for (int stage = 0; stage < stages; ++stage) {
    const double share = static_cast<double>(stage) / (stages - 1);
    geometry::visit_voxels(model.grid, [&](const bone::Voxel& voxel, std::size_t at) {
      if (stage > 0 && subject::is_gone_at(depths[at], share, deepest)) {
        volume.take(volume.address(voxel), 1.0F);
      }
    });
    context.make_current();
    scene.draw(frame, kFiner * width, kFiner * height);
    stills.push_back({share, render::coarser(context.read(), kFiner)});
  }
  return stills;
}

}  // namespace

std::vector<StageStill> stage_stills(const BoneDefinition& d, int stages) {
  if (d.charts.empty() || d.bones.empty()) {
    throw InputError(
        fmt::format("{}: has no table [cavity]; stages are those of a cavity", d.file_name));
  }
  return make_stills(d, *d.bones.front(), *d.charts.front(), stages, d.display.width,
                     d.display.height);
}

std::shared_ptr<const std::vector<render::Image>> screen_stills(const BoneDefinition& d,
                                                                const bone::BoneModel& model) {
  if (d.stills == 0 || !d.cavity) {
    return nullptr;
  }
  const subject::DrillingChart chart =
      make_chart(model, pose_of(d.placement, model.grid), *d.cavity);
  auto images = std::make_shared<std::vector<render::Image>>();
  for (StageStill& still :
       make_stills(d, model, chart, d.stills, d.display.width / 2, d.display.height / 2)) {
    images->push_back(std::move(still.image));
  }
  return images;
}

}  // namespace haptrial::protocols
