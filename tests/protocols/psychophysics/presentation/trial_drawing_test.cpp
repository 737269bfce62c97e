#include "protocols/psychophysics/presentation/trial_drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "core/deformable/touch/ball_touch.h"
#include "core/geometry/mesh/procedural.h"
#include "core/render/gl/image.h"
#include "core/render/gl/offscreen.h"
#include "protocols/psychophysics/presentation/trial_view.h"
#include "tests/protocols/psychophysics/definition/small_definition.h"

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

/// Seen from the front, the lowest side of a cell under the ball is where the ball's lowest point
/// is: the ball rests on the surface there.
class SeenBodyTest : public TrialDrawingTest, public testing::WithParamInterface<bool> {};
INSTANTIATE_TEST_SUITE_P(RestsOrMoves, SeenBodyTest, testing::Bool());

TEST_P(SeenBodyTest, ABodyThatGivesWayIsSeenAsTheHandPressesIt) {
  constexpr double kRadius = 0.006, kFinger = 0.005;  // over a corner of cells of 5 mm [m]
  const double half = 0.01;
  const bool moves = GetParam();
  const auto mesh = std::make_shared<const deformable::HapticMesh>(deformable::felt_block(
      {0.04, 2.0 * half, 0.04}, 8, {{deformable::BodySide::kBottom}, {deformable::BodySide::kTop}},
      "tissue"));
  const auto body = std::make_shared<const deformable::Compliance>(
      mesh, deformable::Tissue{10e3, 0.45, 1000.0, {}});
  const deformable::SharedMovingBody springs = deformable::prepared(
      mesh, deformable::SpringTissue{{6e-4, 2e-4, 1e-3}, nullptr, 1000.0, 50.0});
  const auto shape = std::make_shared<deformable::MovingShape>(mesh->tets.vertices.size());
  const auto bodies = std::make_shared<SeenBodies>();
  TrialObject object;
  object.name = "tissue";
  object.yields = true;
  object.body = std::make_shared<const contact::FeltBody>(geometry::make_box({0.04, 0.02, 0.04}));
  definition_.objects.push_back(object);
  definition_.view.from_above = false;
  drawing_ = trial_drawing(definition_, bodies)(context_.gl(), kWidth, kHeight);
  TrialView view;
  view.interval = 1;
  view.objects[0].object = 0;
  view.objects[0].body = bodies->number_of(moves ? SeenBody{nullptr, springs, shape}
                                                 : SeenBody{body, nullptr, nullptr});
  const auto row_of = [&](double y) { return 0.5 * kHeight - y / definition_.view.width * kWidth; };
  const auto lowest_line = [&](const render::Image& image, double x) {
    const auto column = static_cast<int>(0.5 * kWidth + x / definition_.view.width * kWidth);
    const render::Colour& line = definition_.display.target_colour;
    int lowest = -1;
    for (int row = 0; row < kHeight; ++row) {
      const auto at = static_cast<std::size_t>(3 * (row * kWidth + column));
      const bool red = std::abs(image.rgb[at] - 255.0 * line.red) < 60.0;
      const bool blue = std::abs(image.rgb[at + 2] - 255.0 * line.blue) < 60.0;
      lowest = red && blue ? row : lowest;
    }
    return lowest + 0.5;
  };
  const render::Image rest = picture_of(view, "body at rest");
  EXPECT_NEAR(lowest_line(rest, kFinger), row_of(half), 2.0);
  const deformable::TouchOptions ball{.radius = kRadius};
  std::unique_ptr<deformable::BodyTouch> made;
  if (moves) {
    made = std::make_unique<deformable::MovingTouch>(springs, ball, 1e-3, shape);
  } else {
    made = std::make_unique<deformable::BallTouch>(body, ball);
  }
  deformable::BodyTouch& touch = *made;
  touch.start({kFinger, half + kRadius, 0.0});
  contact::Contact felt;
  for (int tick = 1; tick <= 400; ++tick) {
    felt = touch.tick({kFinger, half + kRadius - 1e-5 * tick, 0.0}, 1e-3);
  }
  view.pressed.add(0, touch.forces());
  const render::Image pressed = picture_of(view, "body under the ball");
  const double bottom = felt.proxy.y() - kRadius;
  EXPECT_LT(bottom, half - 0.0025);
  EXPECT_NEAR(lowest_line(pressed, kFinger), row_of(bottom), 2.0);
  EXPECT_NEAR(lowest_line(pressed, -0.0175), row_of(half), 2.0) << "far from the finger";
}

TEST_F(TrialDrawingTest, OfTooManyForcesTheStrongestAreSeen) {
  SeenForces seen;
  std::vector<deformable::VertexForce> forces;
  for (int i = 0; i < 100; ++i) {
    forces.push_back({i, Eigen::Vector3f(0.0F, static_cast<float>((i * 37) % 100), 0.0F)});
  }
  seen.add(0, forces);
  ASSERT_EQ(seen.on(0).size(), SeenForces::kMost);
  EXPECT_TRUE(std::ranges::all_of(seen.on(0), [](const auto& f) { return f.newtons[1] >= 36.0F; }));
  EXPECT_TRUE(seen.on(1).empty());
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

/// Ink of the picture whose pixels are swapped left and right.
render::Image swapped(const render::Image& image) {
  render::Image other = image;
  const auto width = static_cast<std::size_t>(image.width);
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    const std::size_t row = i / (3 * width), column = i / 3 % width;
    std::copy_n(
        image.rgb.begin() + static_cast<std::ptrdiff_t>(i), 3,
        other.rgb.begin() + static_cast<std::ptrdiff_t>(3 * (row * width + width - 1 - column)));
  }
  return other;
}

TEST_F(TrialDrawingTest, ALeftHandSeesTheMirrorImage) {
  TrialView view;
  view.interval = 1;
  view.hand_shown = true;
  view.tool = {0.02, 0.01, 0.0};
  view.marks[0] = {{0.05F, -0.02F, 0.0F}, 0.008F};
  view.mark_count = 1;
  const render::Image right = picture_of(view, "right hand");
  definition_.display.mirrored = true;
  drawing_ = trial_drawing(definition_)(context_.gl(), kWidth, kHeight);
  const render::Image left = picture_of(view, "left hand");
  EXPECT_GT(ink(left), 0);
  EXPECT_NE(left.rgb, right.rgb);
  EXPECT_EQ(left.rgb, swapped(right).rgb);
  const auto p = drawing_->to_world({0.75 * kWidth, 0.5 * kHeight});
  ASSERT_TRUE(p);
  EXPECT_NEAR(p->x(), -0.04, 1e-12);
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
  // Area in pixels of ink, those that an edge covers in part counted in part.
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
