#include "protocols/bone_drilling/display/plan_section.h"

#include <gtest/gtest.h>

#include <map>
#include <thread>

#include "protocols/bone_drilling/definition/smallest_burr.h"
#include "tests/support/wait.h"

namespace haptrial::protocols::plan_section_test {
namespace {

using Rgb = std::array<std::uint8_t, 3>;
constexpr Rgb kGreen{33, 158, 82}, kBlue{89, 153, 255}, kOrange{255, 148, 26}, kRed{230, 26, 26};

/// A block of 40 x 40 x 30 voxels of 1 mm with a nerve along x and a post as incus.
bone::BoneModel block() {
  bone::BoneModel model;
  model.name = "block";
  model.grid = {{40, 40, 30}, {0.0, 0.0, 0.0}, 1e-3};
  model.labels.assign(model.grid.count(), 1);
  for (int i = 0; i < 40; ++i) {
    model.labels[model.grid.index(i, 20, 16)] = 2;
  }
  model.labels[model.grid.index(20, 13, 12)] = 3;
  model.structures = {{},
                      {"bone", {0.9, 0.9, 0.8}, 1.0, false},
                      {"facial nerve", {1.0, 0.9, 0.2}, 0.5, true},
                      {"incus", {1.0, 0.5, 0.2}, 1.0, true}};
  return model;
}

std::map<Rgb, int> colours_of(const render::Image& image) {
  std::map<Rgb, int> counts;
  for (std::size_t at = 0; at < image.rgb.size(); at += 3) {
    ++counts[{image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]}];
  }
  return counts;
}

TEST(PlanSectionTest, ColoursOfTheLayerAtTheTipAreThoseOfThePlan) {
  const auto model = std::make_shared<const bone::BoneModel>(block());
  BoneDefinition d;
  d.placement.centre = {0.0195, 0.0195, 0.0145};  // B is W
  d.cavity.emplace();
  d.cavity->inward = Eigen::Vector3d::UnitZ();
  d.cavity->offset_B = {0.0, 7e-3, 2e-3};
  d.simulator.tools = {{.name = "burr", .kind = bone::BurrTool{}}};
  d.simulator.camera.start.eye = {0.02, 0.02, -0.2};
  d.simulator.camera.start.target = {0.02, 0.02, 0.0};
  d.simulator.camera.start.up = Eigen::Vector3d::UnitY();
  const subject::CavityPlan plan =
      subject::plan_cavity(*model, pose_of(d.placement, model->grid), *d.cavity, smallest_burr(d));
  bone::BoneVolume volume(*model);
  constexpr int kLayer = 20;  // of y: in the cavity and through the nerve
  int removed = 0, left = 0;
  for (int k = 0; k < 30; ++k) {
    for (int i = 0; i < 40; ++i) {
      if (plan.parts[model->grid.index(i, kLayer, k)] == subject::PlanPart::kPlanned) {
        const bool goes = k < 5;
        removed += goes ? 1 : 0;
        left += goes ? 0 : 1;
        if (goes) {
          volume.take(volume.address({i, kLayer, k}), 1.0F);
        }
      }
    }
  }
  for (const bone::Voxel& v :
       {bone::Voxel(0, kLayer, 29), bone::Voxel(1, kLayer, 29), bone::Voxel(3, kLayer, 16)}) {
    volume.take(volume.address(v), 1.0F);
  }
  PlanSection section(d, model);
  std::shared_ptr<const std::vector<render::Image>> images;
  test::wait_until([&] {
    images = section.at(volume, {0.02, 1e-3 * kLayer, 0.0});
    return images != nullptr;
  });
  const render::Image& image = images->front();
  EXPECT_EQ(image.width, 40);
  EXPECT_EQ(image.height, 30);
  auto counts = colours_of(image);
  EXPECT_GT(removed, 10);
  EXPECT_EQ(counts[kGreen], removed);
  EXPECT_EQ(counts[kBlue], left);
  EXPECT_EQ(counts[kOrange], 2);
  EXPECT_EQ(counts[kRed], 1);
  // The way out is up: the voxels beyond, deepest of all, are in the last line.
  const std::size_t last = 3UL * 40 * 29;
  EXPECT_EQ(colours_of({40,
                        1,
                        {image.rgb.begin() + static_cast<std::ptrdiff_t>(last),
                         image.rgb.end()}})[kOrange],
            2);
  EXPECT_EQ(section.at(volume, {0.02, 5e-3, 0.0})->front().width, 40);
}

}  // namespace
}  // namespace haptrial::protocols::plan_section_test
