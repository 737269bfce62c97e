// Parts that a picture leaves out of a tool's shadow are those that the shadow's law leaves alone.
#include "core/render/bone/tool_shadow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/base/random.h"

namespace haptrial::render::tool_shadow_test {
namespace {

Eigen::Vector3d random_place(RandomStream& random, double extent) {
  return {random.uniform(-extent, extent), random.uniform(-extent, extent),
          random.uniform(-extent, extent)};
}

TEST(ToolShadowTest, NoTwoPointsOfSegmentsAreNearerThanTheirDistance) {
  RandomStream random(1, "segments");
  for (int run = 0; run < 200; ++run) {
    const Eigen::Vector3d a = random_place(random, 1.0);
    const Eigen::Vector3d b = run % 10 == 0 ? a : random_place(random, 1.0);
    const Eigen::Vector3d c = random_place(random, 1.0);
    const Eigen::Vector3d d =
        run % 7 == 0 ? Eigen::Vector3d(c + 2.0 * (b - a)) : random_place(random, 1.0);
    double least = 10.0;
    constexpr int kSteps = 200;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; j <= kSteps; ++j) {
        const Eigen::Vector3d p = a + i * (b - a) / kSteps;
        const Eigen::Vector3d q = c + j * (d - c) / kSteps;
        least = std::min(least, (p - q).norm());
      }
    }
    const double found = distance_of_segments(a, b, c, d);
    EXPECT_LE(found, least + 1e-12);
    EXPECT_GE(found, least - 0.03);  // the samples' distance
  }
}

double distance_to(const Capsule& capsule, const Eigen::Vector3d& p) {
  return distance_of_segments(p, p, capsule.from, capsule.to);
}

/// Whether a point may be darker by the law of bone-look.md: nearness up to four radii; a shadow
/// after a way s between r + 0.25 s + 0.1 r, up to 40 mm.
bool may_be_darker(const Capsule& capsule, const Eigen::Vector3d& p) {
  if (distance_to(capsule, p) < 4.0 * capsule.radius) {
    return true;
  }
  for (double s = 0.0; s < 0.04; s += 0.0002) {
    if (distance_to(capsule, p + s * to_lamp()) < 1.1 * capsule.radius + 0.25 * s) {
      return true;
    }
  }
  return false;
}

TEST(ToolShadowTest, AllBoneThatATubeMayDarkenIsInAPart) {
  RandomStream random(2, "bone");
  const PixelBox area(Eigen::Vector2i(0, 0), Eigen::Vector2i(31, 31));
  int dark = 0;
  int left_out = 0;
  for (int run = 0; run < 10000; ++run) {
    const std::vector<Capsule> capsules{
        {random_place(random, 0.03), random_place(random, 0.03), random.uniform(0.0005, 0.003)}};
    BoneColumn column{random_place(random, 0.05), {}, random.uniform(0.0, 0.003), area};
    column.farthest = column.nearest + random_place(random, 0.004);
    const Eigen::Vector3d off = random_place(random, 1.0).normalized() * column.radius;
    const Eigen::Vector3d p = column.nearest +
                              random.uniform(0.0, 1.0) * (column.farthest - column.nearest) +
                              random.uniform(0.0, 1.0) * off;
    const bool has_part = !shadowed_parts(area, capsules, std::vector{column}).empty();
    if (may_be_darker(capsules[0], p)) {
      EXPECT_TRUE(has_part) << run;
      ++dark;
    }
    left_out += has_part ? 0 : 1;
  }
  EXPECT_GT(dark, 300);
  EXPECT_GT(left_out, 300);
}

TEST(ToolShadowTest, EachPartNamesTheCapsulesThatReachIt) {
  const PixelBox area(Eigen::Vector2i(0, 0), Eigen::Vector2i(63, 31));
  const PixelBox left(Eigen::Vector2i(0, 0), Eigen::Vector2i(31, 31));
  const PixelBox right(Eigen::Vector2i(32, 0), Eigen::Vector2i(63, 31));
  const Eigen::Vector3d here(0.0, 0.0, -0.1);
  const Eigen::Vector3d there(0.2, 0.0, -0.1);
  const std::vector<Capsule> capsules{{here, here, 0.001}, {there, there, 0.001}};
  const std::vector<BoneColumn> bone{{here, here, 0.0, left}, {there, there, 0.0, right}};
  const auto parts = shadowed_parts(area, capsules, bone);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].what, 1);
  EXPECT_EQ(parts[0].box.max().x(), 31);
  EXPECT_EQ(parts[1].what, 2);
}

}  // namespace
}  // namespace haptrial::render::tool_shadow_test
