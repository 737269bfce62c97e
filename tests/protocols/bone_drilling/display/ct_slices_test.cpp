// Slices of a block with known densities: pixels are looked up by their place in millimetres.

#include "protocols/bone_drilling/display/ct_slices.h"

#include <gtest/gtest.h>

#include <cmath>

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
