#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "core/render/gl/offscreen.h"
#include "protocols/bone_drilling/display/bone_display.h"
#include "tests/protocols/drilling_fixture.h"

namespace haptrial::protocols {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

/// Two blocks of bone, seen from above.
std::shared_ptr<const BoneStage> stage() {
  test::Workshop shop;
  auto stage = std::make_shared<BoneStage>();
  stage->model = std::make_shared<const bone::BoneModel>(shop.model);
  stage->start_view.eye = {0.01, 0.06, 0.03};
  stage->start_view.target = {0.0, 0.0, 0.0};
  stage->start_view.field_of_view = 0.4;
  stage->depths = depths_of(*stage->model);
  stage->simulator = std::move(shop.simulator);
  stage->companions = std::move(shop.companions);
  return stage;
}

/// A window's drawing, off screen.
struct View {
  explicit View(const BoneDefinition& definition)
      : drawing(bone_drawing(definition, stage(), nullptr)(context.gl(), kWidth, kHeight)) {}
  /// Picture of a bone at rest: from the second picture on only what faces the eye is drawn.
  std::vector<std::uint8_t> picture() {
    drawing->draw({});
    drawing->draw({});
    return context.read().rgb;
  }
  render::OffscreenContext context{kWidth, kHeight};
  std::unique_ptr<Drawing> drawing;
};

TEST(BoneDrawingTest, VStepsThroughTheQualitiesAndAFixedOneStays) {
  const BoneDefinition free;
  View view(free);
  const auto full = view.picture();
  view.drawing->pressed('X');
  view.drawing->pressed('V');
  EXPECT_EQ(view.picture(), full) << "as much as the machine draws, at first";
  view.drawing->pressed('V');
  const auto shaded = view.picture();
  EXPECT_NE(shaded, full);
  view.drawing->pressed('V');
  const auto plain = view.picture();
  EXPECT_NE(plain, shaded);
  EXPECT_NE(plain, full);
  view.drawing->pressed('V');
  EXPECT_EQ(view.picture(), full);

  BoneDefinition fixed;
  fixed.quality = render::Quality::kShaded;
  View other(fixed);
  EXPECT_EQ(other.picture(), shaded);
  other.drawing->pressed('V');
  EXPECT_EQ(other.picture(), shaded);
}

TEST(BoneDrawingTest, CShowsSlicesAtTheLeftAndHidesThemAndADefinitionMayBeginWithThem) {
  const BoneDefinition without;
  View view(without);
  const auto plain = view.picture();
  view.drawing->pressed('C');
  const auto sliced = view.picture();
  int left = 0;
  int right = 0;
  for (std::size_t at = 0; at < plain.size(); ++at) {
    const bool differs = plain[at] != sliced[at];
    (at / 3 % kWidth < kWidth / 3 ? left : right) += differs ? 1 : 0;
  }
  EXPECT_GT(left, 1000);
  EXPECT_EQ(right, 0);
  view.drawing->pressed('C');
  EXPECT_EQ(view.picture(), plain);

  BoneDefinition with;
  with.slices = true;
  EXPECT_EQ(View(with).picture(), sliced);
}

bool is_red(const std::uint8_t* pixel) { return pixel[0] > 150 && pixel[1] < 60 && pixel[2] < 60; }

TEST(BoneDrawingTest, AnInjuryHasARedFrameAtOnceAndWordsForAWhile) {
  const BoneDefinition definition;
  View view(definition);
  const auto reds = [&view](double since) {
    bone::DrillingView seen;
    seen.shown = true;
    seen.eye = {0.01, 0.06, 0.03};
    seen.injury = {1, since};
    view.drawing->draw(seen);
    const std::vector<std::uint8_t> picture = view.context.read().rgb;
    int edge = 0;
    int inside = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const bool rim = x < 5 || x >= kWidth - 5 || y < 5 || y >= kHeight - 5;
        (rim ? edge : inside) += is_red(&picture[3 * static_cast<std::size_t>(y * kWidth + x)]);
      }
    }
    return std::pair(edge, inside);
  };
  const auto [edge, words] = reds(0.0);
  EXPECT_GT(edge, 2 * 5 * (kWidth + kHeight) * 9 / 10);
  EXPECT_GT(words, 500);
  const auto [faded, still] = reds(3.0);
  EXPECT_EQ(faded, 0);
  EXPECT_GT(still, 500);
  EXPECT_EQ(reds(6.0).second, 0);
}

/// A replay for raters has no clock, and its words have the time all the same.
TEST(BoneDrawingTest, WordsOfAnInjurySayWhenItWas) {
  const BoneDefinition definition;
  View view(definition);
  const auto picture = [&view](double elapsed, double since) {
    bone::DrillingView seen;
    seen.shown = true;
    seen.eye = {0.01, 0.06, 0.03};
    seen.injury = {1, since};
    seen.elapsed = elapsed;
    for (int frame = 0; frame < 3; ++frame) {  // a camera at rest draws from another array
      view.drawing->draw(seen);
    }
    return view.context.read().rgb;
  };
  EXPECT_EQ(picture(13.5, 3.5), picture(15.0, 5.0)) << "both were after 0:10";
  EXPECT_NE(picture(13.5, 3.5), picture(73.5, 3.5));
}

}  // namespace
}  // namespace haptrial::protocols
