#include "protocols/trials/presentation/trial_drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "core/geometry/mesh/procedural.h"
#include "core/render/gl/image.h"
#include "core/render/gl/offscreen.h"
#include "protocols/trials/presentation/trial_view.h"
#include "tests/protocols/trials/definition/small_definition.h"

namespace haptrial::protocols {
namespace {

class TrialDrawingTest : public testing::Test {
 protected:
  TrialDrawingTest() : context_(kWidth, kHeight) {
    read_small(small_trials(kSmallStaircase), definition_);
    drawing_ = trial_drawing(definition_)(context_.gl(), kWidth, kHeight);
  }
  render::Image picture_of(const TrialView& view, const std::string& name) {
    drawing_->draw(stimulus::Shown(view));
    render::Image image = context_.read();
    if (const char* folder = std::getenv("HAPTRIAL_WRITE_PICTURES")) {
      render::write_png(std::string(folder) + "/" + name + ".png", image);
    }
    return image;
  }
  /// Pixels that are not background.
  static auto ink(const render::Image& image) {
    std::ptrdiff_t count = 0;
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
      count += image.rgb[i] < 200 || image.rgb[i + 1] < 200 || image.rgb[i + 2] < 200 ? 1 : 0;
    }
    return count;
  }
  static constexpr int kWidth = 640, kHeight = 360;
  TrialsDefinition definition_;
  render::OffscreenContext context_;
  std::unique_ptr<Drawing> drawing_;
};

TEST_F(TrialDrawingTest, ShowsWhatAStageNamesAndNothingElse) {
  TrialView view;
  view.interval = 1;
  EXPECT_EQ(ink(picture_of(view, "nothing")), 0);
  view.hand_shown = true;
  const auto hand = ink(picture_of(view, "hand"));
  // A disc of 3 mm in a picture of 16 cm.
  const double radius = 0.003 / 0.16 * kWidth;
  EXPECT_NEAR(static_cast<double>(hand), 3.14159 * radius * radius,
              0.1 * 3.14159 * radius * radius);
  view.marks[0] = {{0.0F, 0.02F, 0.0F}, 0.008F};
  view.mark_count = 1;
  view.number_shown = true;
  EXPECT_GT(ink(picture_of(view, "interval")), hand + 100);
}

/// The outline of a ball of 2 cm is a circle of lines, 2 px wide: more where facets make it zigzag.
TEST_F(TrialDrawingTest, AnObjectIsSeenAsItsOutline) {
  definition_.objects.push_back(
      {"ball",
       {},
       std::make_shared<const contact::FeltBody>(geometry::make_sphere(0.02, 16)),
       false});
  TrialView view;
  view.interval = 1;
  view.objects[0].object = 0;
  const double circle = 2.0 * 3.14159 * 0.02 / 0.16 * kWidth;
  const auto outline = static_cast<double>(ink(picture_of(view, "object")));
  EXPECT_GT(outline, 1.5 * circle);
  EXPECT_LT(outline, 5.0 * circle);
  view.objects[0].scale = 2.0F;
  EXPECT_GT(static_cast<double>(ink(picture_of(view, "larger object"))), 1.6 * outline);
  view.objects[0].object = 7;  // of another definition
  EXPECT_EQ(ink(picture_of(view, "no object")), 0);
}

TEST_F(TrialDrawingTest, AsksAndTellsWhetherItWasRight) {
  TrialView view;
  view.question = 1;
  const auto question = ink(picture_of(view, "question"));
  EXPECT_GT(question, 500);
  view.verdict = Verdict::kRight;
  const auto right = ink(picture_of(view, "right"));
  EXPECT_GT(right, 0);
  EXPECT_LT(right, question);
}

TEST_F(TrialDrawingTest, PixelsArePlaces) {
  const auto p = drawing_->to_world({0.5 * kWidth + 0.25 * kWidth, 0.5 * kHeight});
  ASSERT_TRUE(p);
  EXPECT_NEAR(p->x(), 0.04, 1e-12);
  EXPECT_NEAR(p->y(), 0.0, 1e-12);
}

TEST_F(TrialDrawingTest, ShowsEachEyeItsOwnDotsInItsHalf) {
  definition_.view.stereo = true;
  drawing_ = trial_drawing(definition_)(context_.gl(), kWidth, kHeight);
  TrialView view;
  view.interval = 1;
  view.dots.shown = true;
  view.dots.seed = 5;
  view.dots.dots.count = 300;
  view.dots.dots.diameter = 0.002;
  view.dots.dots.height = 0.03;
  view.dots.dots.width = 0.08;
  const render::Image image = picture_of(view, "random-dots");
  // In pixels of ink, those that an edge covers in part counted in part.
  const double paper = image.rgb[0];
  const double ink = *std::min_element(image.rgb.begin(), image.rgb.end());
  const auto dark_in = [&](int from, int to) {
    double sum = 0.0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = from; x < to; ++x) {
        const auto at = 3 * (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x));
        sum += (paper - image.rgb[at]) / (paper - ink);
      }
    }
    return sum;
  };
  const double left = dark_in(0, kWidth / 2);
  const double right = dark_in(kWidth / 2, kWidth);
  // 300 discs of 2 mm in a picture of 16 cm and 320 pixels; some overlap or leave the picture.
  const double all = 300.0 * 3.14159 * 2.0 * 2.0;
  EXPECT_GT(left, 0.7 * all);
  EXPECT_LT(left, 1.02 * all);
  EXPECT_NEAR(right, left, 0.1 * all);
  view.dots.dots.step = 0.0;  // without depth both eyes see the same
  view.dots.seed = 6;
  const render::Image flat = picture_of(view, "random-dots-flat");
  int different = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth / 2; ++x) {
      const auto at = 3 * (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x));
      different += std::abs(flat.rgb[at] - flat.rgb[at + 3 * (kWidth / 2)]) > 100 ? 1 : 0;
    }
  }
  EXPECT_EQ(different, 0);
}

}  // namespace
}  // namespace haptrial::protocols
