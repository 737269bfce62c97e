// Slices of a block with known densities: pixels are looked up by their place in millimetres. And
// the plan in a layer of a block.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <thread>
#include <vector>

#include "protocols/bone_drilling/definition/placement.h"
#include "protocols/bone_drilling/display/ct_slices.h"
#include "protocols/bone_drilling/display/plan_section.h"
#include "tests/support/solid_bone.h"
#include "tests/support/wait.h"

namespace haptrial::protocols::ct_slices_test {
namespace {

using Rgb = std::array<int, 3>;

constexpr int kVoxels = 40;
constexpr double kMillimetre = 1e-3;

/// A block of voxels of 1 mm whose density grows with x, with a nerve of 4 x 4 voxels along y.
bone::BoneModel block() {
  bone::BoneModel model;
  model.name = "block";
  model.grid = {{kVoxels, kVoxels, kVoxels}, {0.0, 0.0, 0.0}, kMillimetre};
  model.labels.assign(model.grid.count(), 1);
  model.density.assign(model.grid.count(), 0.0F);
  model.structures = {
      {}, {"bone", {0.9, 0.9, 0.8}, 1.0, false}, {"facial nerve", {1.0, 0.8, 0.2}, 0.2, true}};
  for (int k = 0; k < kVoxels; ++k) {
    for (int j = 0; j < kVoxels; ++j) {
      for (int i = 0; i < kVoxels; ++i) {
        const std::size_t at = model.grid.index(i, j, k);
        const bool nerve = std::abs(i - 26) < 2 && std::abs(k - 28) < 2;
        model.labels[at] = nerve ? 2 : 1;
        model.density[at] = nerve ? 1.0F : static_cast<float>(100 + i) / 255.0F;
      }
    }
  }
  return model;
}

/// The pixel of slice `plane` that shows a place so far to the right of the tip and below it [mm].
Rgb pixel(const render::Image& image, int plane, double right, double below) {
  const double per_pixel = 1e3 * CtSlices::kWidth / CtSlices::kSide;
  const auto x = CtSlices::kSide / 2 + static_cast<int>(std::lround(right / per_pixel));
  const auto y = CtSlices::kSide / 2 + static_cast<int>(std::lround(below / per_pixel));
  const auto line = static_cast<std::size_t>(plane * (CtSlices::kSide + CtSlices::kGap) + y);
  const std::size_t at = 3 * (line * CtSlices::kSide + static_cast<std::size_t>(x));
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

Rgb grey(double level) {
  const int value = static_cast<int>(std::lround(level));
  return {value, value, value};
}

class CtSlicesTest : public testing::Test {
 protected:
  std::shared_ptr<const bone::BoneModel> model_{std::make_shared<const bone::BoneModel>(block())};
  bone::BoneVolume volume_{*model_};
  const Eigen::Vector3d tip_{20e-3, 20e-3, 20e-3};
};

TEST_F(CtSlicesTest, GreyIsDensityAtThePlaceOfEachPixel) {
  CtSlices slices(model_, Eigen::Isometry3d::Identity(), {});
  const render::Image image = slices.at(volume_, tip_)->front();
  EXPECT_EQ(image.width, CtSlices::kSide);
  // Axial and coronal slices have x to the right, the sagittal one y.
  for (const int plane : {0, 1}) {
    EXPECT_EQ(pixel(image, plane, 3.0, 5.0), grey(123)) << plane;
    EXPECT_EQ(pixel(image, plane, -7.0, 5.0), grey(113)) << plane;
  }
  EXPECT_EQ(pixel(image, 2, 3.0, 5.0), grey(120));
  EXPECT_EQ(pixel(image, 2, -7.0, -5.0), grey(120));
  EXPECT_NE(pixel(image, 0, 0.0, 5.0), grey(120)) << "a line leads to the tip";
  EXPECT_EQ(pixel(image, 0, 0.0, 0.5), grey(120)) << "and leaves the tip free";
}

TEST_F(CtSlicesTest, AWindowStretchesTheGrey) {
  CtSlices slices(model_, Eigen::Isometry3d::Identity(), {110.0 / 255.0, 130.0 / 255.0});
  const render::Image image = slices.at(volume_, tip_)->front();
  EXPECT_EQ(pixel(image, 0, 0.0, 0.5), grey(127.5));
  EXPECT_EQ(pixel(image, 0, -11.0, 5.0), grey(0));
  EXPECT_EQ(pixel(image, 0, 12.0, 5.0), grey(255));
}

TEST_F(CtSlicesTest, ANerveHasAnOutlineAndTheGreyOfSoftTissueWithin) {
  CtSlices slices(model_, Eigen::Isometry3d::Identity(), {});
  const render::Image image = slices.at(volume_, tip_)->front();
  // In the coronal slice z points up: the nerve is 6 mm to the right and 8 mm above.
  EXPECT_EQ(pixel(image, 1, 6.0, -8.0), grey(51));
  int outline = 0;
  for (double right = 3.5; right < 9.0; right += 0.25) {
    outline += pixel(image, 1, right, -8.0) == Rgb{255, 204, 51} ? 1 : 0;
  }
  EXPECT_EQ(outline, 1) << "a line of one pixel, on one of both sides";
  EXPECT_EQ(pixel(image, 0, 6.0, -8.0), grey(126)) << "no axial slice at the tip holds it";
}

TEST_F(CtSlicesTest, DrilledBoneIsBlackAndEverySliceFollowsWithinThreePictures) {
  CtSlices slices(model_, Eigen::Isometry3d::Identity(), {});
  slices.at(volume_, tip_);
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) {
      for (int k = -2; k <= 2; ++k) {
        volume_.take(volume_.address({20 + i, 20 + j, 20 + k}), 1.0F);
      }
    }
  }
  render::Image image;
  for (int frame = 0; frame < 3; ++frame) {
    image = slices.at(volume_, tip_)->front();
  }
  for (const int plane : {0, 1, 2}) {
    EXPECT_EQ(pixel(image, plane, 0.5, 0.5), grey(0)) << plane;
    EXPECT_NE(pixel(image, plane, 4.0, 1.0), grey(0)) << plane;
  }
}

TEST_F(CtSlicesTest, APlaceThatIsNoneOrFarAwayIsNoMistake) {
  CtSlices slices(model_, Eigen::Isometry3d::Identity(), {});
  EXPECT_EQ(slices.at(volume_, {std::nan(""), 0.0, 0.0})->size(), 1U);
  const render::Image far = slices.at(volume_, {0.5, 0.5, 0.5})->front();
  EXPECT_EQ(pixel(far, 0, 5.0, 5.0), grey(0));
}

}  // namespace
}  // namespace haptrial::protocols::ct_slices_test

namespace haptrial::protocols::plan_section_test {
namespace {

using Rgb = std::array<std::uint8_t, 3>;
constexpr Rgb kGreen{33, 158, 82}, kBlue{89, 153, 255}, kOrange{255, 148, 26}, kRed{230, 26, 26};

std::map<Rgb, int> colours_of(const render::Image& image) {
  std::map<Rgb, int> counts;
  for (std::size_t at = 0; at < image.rgb.size(); at += 3) {
    ++counts[{image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]}];
  }
  return counts;
}

TEST(PlanSectionTest, ColoursOfTheLayerAtTheTipAreThoseOfThePlan) {
  const auto model = std::make_shared<const bone::BoneModel>(test::block_with_nerve());
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
