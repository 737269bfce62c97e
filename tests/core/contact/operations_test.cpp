#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/base/random.h"
#include "core/contact/renderer_kinds.h"
#include "core/geometry/mesh/procedural.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 0.001;  // [s]

struct FeltBox {
  geometry::Mesh mesh{geometry::make_box(Vector3d(0.1, 0.1, 0.1))};
  ContactSurface surface{mesh};

  std::unique_ptr<Renderer> renderer(RendererKind kind) const {
    return make_renderer(kind, mesh, surface,
                         {.radius = kind == RendererKind::kRuspini ? 0.001 : 0.0});
  }
};

/// Operations that a tick adds.
Operations added(Renderer& renderer, const Vector3d& tool) {
  const Operations before = renderer.operations();
  renderer.tick(tool, kTick);
  Operations more = renderer.operations();
  for (const OperationCount& c : kOperationCounts) {
    more.*c.count -= before.*c.count;
  }
  more.ticks -= before.ticks;
  return more;
}

/// Each renderer counts what its method does, and nothing else.
TEST(OperationsTest, RenderersWithoutAProxyDoOneThingATick) {
  const FeltBox box;
  const Vector3d inside(0.01, 0.02, 0.049), outside(0.0, 0.0, 0.3);
  const auto one = [&](RendererKind kind, const Vector3d& tool) {
    const auto renderer = box.renderer(kind);
    renderer->start({0.0, 0.0, 0.06});
    return added(*renderer, tool);
  };
  for (const Vector3d& tool : {inside, outside}) {
    EXPECT_EQ(one(RendererKind::kPenalty, tool), (Operations{.ticks = 1, .nearest_searches = 1}));
  }
  EXPECT_EQ(one(RendererKind::kVoxel, inside),
            (Operations{.ticks = 1, .triangles_tested = 1, .cells = 1}));
  EXPECT_EQ(one(RendererKind::kVoxel, outside), (Operations{.ticks = 1})) << "beyond the grid";
  EXPECT_EQ(one(RendererKind::kDistanceField, inside), (Operations{.ticks = 1, .cells = 1}));
  EXPECT_EQ(one(RendererKind::kDistanceField, outside), (Operations{.ticks = 1}));
}

/// A proxy on the middle of one triangle of a face, away from its sides.
TEST(OperationsTest, AProxyOnAFaceOfABoxTakesTheStepsOfItsMethod) {
  const FeltBox box;
  const auto proxy = box.renderer(RendererKind::kProxy);
  proxy->start({0.02, 0.01, 0.051});
  // Down to the face, and the face's plane solved: the tool is straight below.
  const Operations down = added(*proxy, {0.02, 0.01, 0.049});
  EXPECT_EQ(down.sweeps, 1u);
  EXPECT_EQ(down.plane_solutions, 1u);
  EXPECT_EQ(down.lists, 1u);
  EXPECT_EQ(down.long_sweeps, 0u);
  EXPECT_EQ(down.nearest_searches, 0u);
  EXPECT_EQ(down.cells, 0u);
  EXPECT_GE(down.triangles_tested, 1u);
  EXPECT_LE(down.triangles_tested + down.triangles_passed, 12u) << "no more than the box has";
  // Held by the same plane: its triangle is tested again, nothing is swept.
  EXPECT_EQ(added(*proxy, {0.02, 0.01, 0.048}),
            (Operations{.ticks = 1, .triangles_tested = 1, .plane_solutions = 1}));
  // Aside: held; solved; swept along the face; held again there; solved again.
  const Operations aside = added(*proxy, {0.0205, 0.01, 0.048});
  EXPECT_EQ(aside.sweeps, 1u);
  EXPECT_EQ(aside.plane_solutions, 2u);
  EXPECT_EQ(aside.lists, 0u) << "the list reaches farther";
  EXPECT_GE(aside.triangles_tested, 2u);
  EXPECT_LE(aside.triangles_tested + aside.triangles_passed, 14u);
}

TEST(OperationsTest, AWayThatLeavesTheListIsALongSweep) {
  const FeltBox box;
  const auto proxy = box.renderer(RendererKind::kProxy);
  proxy->start({0.0, 0.0, 10.0});
  EXPECT_EQ(added(*proxy, {0.0, 0.0, 0.0}).long_sweeps, 1u);
}

TEST(OperationsTest, CountsGrowAndAStartSetsThemToZero) {
  const FeltBox box;
  for (const RendererKind kind : kRendererKinds) {
    const auto renderer = box.renderer(kind);
    for (int round = 0; round < 2; ++round) {
      renderer->start({0.0, 0.0, 0.08});
      EXPECT_EQ(renderer->operations(), Operations{}) << name_of(kind);
      RandomStream random(3, "operations");
      Operations before, first;
      for (int i = 1; i <= 1000; ++i) {
        const double x = random.uniform(-0.06, 0.06), y = random.uniform(-0.06, 0.06);
        renderer->tick({x, y, random.uniform(-0.06, 0.06)}, kTick);
        const Operations& now = renderer->operations();
        EXPECT_EQ(now.ticks, static_cast<std::uint64_t>(i));
        for (const OperationCount& c : kOperationCounts) {
          EXPECT_GE(now.*c.count, before.*c.count) << c.name;
        }
        before = now;
      }
      EXPECT_NE(before, Operations{.ticks = 1000}) << "something was counted";
      renderer->tick({NAN, 0.0, 0.0}, kTick);
      EXPECT_EQ(renderer->operations(), before) << "no operations on no place";
    }
  }
}

/// The same path takes the same operations: unlike times they can be compared.
TEST(OperationsTest, AreTheSameOnEveryRun) {
  const FeltBox box;
  const auto renderer = box.renderer(RendererKind::kProxy);
  Operations first;
  for (int round = 0; round < 2; ++round) {
    renderer->start({0.0, 0.0, 0.08});
    for (int i = 0; i < 1000; ++i) {
      renderer->tick({0.06 * std::sin(0.03 * i), 0.06 * std::cos(0.017 * i), 0.049}, kTick);
    }
    if (round == 0) {
      first = renderer->operations();
    }
  }
  EXPECT_EQ(renderer->operations(), first);
  EXPECT_GT(first.triangles_tested, 500u);
}

}  // namespace
}  // namespace haptrial::contact
