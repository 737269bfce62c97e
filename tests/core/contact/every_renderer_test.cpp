// One suite over all renderers: what each must do on a plane face and a sphere, what it gives back
// on a closed path, and what no renderer may do.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "core/base/random.h"
#include "core/contact/renderer_kinds.h"
#include "core/geometry/mesh/procedural.h"
#include "tests/core/contact/hard_meshes.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod = 0.001;  // [s]

struct RendererCase {
  RendererKind kind;
  double radius;  // of the tool [m]
};

std::string case_name(const testing::TestParamInfo<RendererCase>& info) {
  std::string name(name_of(info.param.kind));
  std::erase(name, ' ');
  return name + (info.param.radius > 0.0 ? "Sphere" : "Point");
}

/// A body with the renderer of a case.
struct Felt {
  geometry::Mesh mesh;
  ContactSurface surface;
  std::unique_ptr<Renderer> renderer;

  Felt(geometry::Mesh body, const RendererCase& c, RendererOptions options = {})
      : mesh(std::move(body)), surface(mesh) {
    options.radius = c.radius;
    renderer = make_renderer(c.kind, mesh, surface, options);
  }
};

class EveryRendererTest : public testing::TestWithParam<RendererCase> {};

TEST_P(EveryRendererTest, APlaneFaceIsExact) {
  const double half = 0.05, depth = 0.001, radius = GetParam().radius;
  Felt felt(make_box(Vector3d::Constant(-half), Vector3d::Constant(half)), GetParam(),
            {.stiffness = 800.0});
  felt.renderer->start({0.0, 0.0, 0.1});
  for (int i = 0; i < 500; ++i) {
    const double a = 0.02 * i;
    const Vector3d above(0.001 * a * std::cos(a), 0.0015 * a * std::sin(a), half + radius + 1e-4);
    const Contact& free = felt.renderer->tick(above, kPeriod);
    ASSERT_EQ(free.force, Vector3d(Vector3d::Zero()));
    ASSERT_EQ(free.state, ContactState::kFree);
    const Vector3d below = above - Vector3d(0, 0, 1e-4 + depth);
    const Contact& contact = felt.renderer->tick(below, kPeriod);
    ASSERT_LT((contact.force - Vector3d(0, 0, 800.0 * depth)).norm(), 1e-9);
    ASSERT_LT((contact.proxy - below - Vector3d(0, 0, depth)).norm(), 1e-12);
    ASSERT_LT((contact.normal - Vector3d::UnitZ()).norm(), 1e-12);
    ASSERT_NE(contact.state, ContactState::kFree);
  }
}

/// A closed path in the surface of a sphere around the origin, its depth changing on the way.
Vector3d on_loop(double turn, double radius) {
  const double a = 2.0 * M_PI * turn;
  const Vector3d out =
      Vector3d(std::cos(a), std::sin(a), 0.6 * std::sin(2.0 * a + 0.4)).normalized();
  return (radius - 0.001 - 0.0005 * std::cos(3.0 * a)) * out;
}

TEST_P(EveryRendererTest, ASphereIsFeltToItsResolution) {
  // A force's direction may be off by the angle that an edge of the mesh and a cell span.
  const double radius = 0.03, reach = radius + GetParam().radius;
  constexpr int kFrequency = 24;
  const RendererOptions options;
  Felt felt(geometry::make_sphere(radius, kFrequency), GetParam(), options);
  const double edge = 1.2 * radius / kFrequency, cell = 2.0 * radius / options.resolution;
  felt.renderer->start({0.0, 0.0, 0.1});
  for (int i = 0; i < 3; ++i) {  // in from outside
    felt.renderer->tick(on_loop(0.0, reach) * (1.1 - 0.05 * i), kPeriod);
  }
  for (int i = 0; i <= 2000; ++i) {
    const Vector3d tool = on_loop(i / 2000.0, reach);
    const Vector3d exact = options.stiffness * (reach - tool.norm()) * tool.normalized();
    const Contact& contact = felt.renderer->tick(tool, kPeriod);
    ASSERT_LT((contact.force - exact).norm(), exact.norm() * (edge + cell) / radius + 0.02) << i;
  }
}

/// Work of a renderer on the tool on the second round of a closed path.
struct Work {
  double given{0.0};  // [J]
  double moved{0.0};  // the sum of what goes to and fro [J]
  double bound{0.0};  // of the trapezoid rule's error: |dF| |dx| / 2 a step [J]
};

Work work_on_loop(const RendererCase& c, int frequency) {
  const double radius = 0.03, reach = radius + c.radius;
  Felt felt(geometry::make_sphere(radius, frequency), c);
  felt.renderer->start({0.0, 0.0, 0.1});
  constexpr int kSteps = 60000;
  Work work;
  Vector3d before_tool = on_loop(0.0, reach), before = Vector3d::Zero();
  felt.renderer->tick(1.05 * before_tool, kPeriod);
  for (int i = -kSteps; i <= kSteps; ++i) {
    const Vector3d tool = on_loop(static_cast<double>(i) / kSteps, reach);
    const Vector3d force = felt.renderer->tick(tool, kPeriod).force;
    if (i > 0) {
      const double given = 0.5 * (before + force).dot(tool - before_tool);
      work.given += given;
      work.moved += std::abs(given);
      work.bound += 0.5 * (force - before).norm() * (tool - before_tool).norm();
    }
    before = force;
    before_tool = tool;
  }
  return work;
}

/// All but the voxel grid, which jumps between planes and claims no energy.
class ContinuousRendererTest : public testing::TestWithParam<RendererCase> {};

TEST_P(ContinuousRendererTest, AClosedPathGivesBackWhatItTook) {
  const RendererCase& c = GetParam();
  const Work coarse = work_on_loop(c, 12);
  EXPECT_LT(coarse.given, coarse.bound) << "it gives out energy";
  if (c.kind == RendererKind::kPenalty || c.kind == RendererKind::kDistanceField) {
    EXPECT_LT(std::abs(coarse.given), coarse.bound);
    EXPECT_LT(coarse.bound, 0.05 * coarse.moved) << "the bound says nothing";
  }
  if (c.kind == RendererKind::kProxy && c.radius == 0.0) {
    // Over a convex edge the god object falls from one face to the next and loses k/2 d² a² there,
    // a the angle: with edges half as long half as much in all.
    const Work fine = work_on_loop(c, 24);
    EXPECT_LT(-coarse.given, 0.1 * coarse.moved);
    EXPECT_NEAR(fine.given / coarse.given, 0.5, 0.1);
    EXPECT_LT(fine.bound, 0.2 * -fine.given) << "the bound says nothing";
  }
}

TEST_P(EveryRendererTest, TicksDoNotAllocate) {
  Felt felt(geometry::make_sphere(0.03, 16), GetParam(), {.damping = 1.0, .crease_angle = -1.0});
  RandomStream random(1, "tool");
  const test::AllocationGuard guard;
  felt.renderer->start({0.0, 0.0, 0.05});
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(-0.04, 0.04), y = random.uniform(-0.04, 0.04);
    sum += felt.renderer->tick({x, y, random.uniform(-0.04, 0.04)}, kPeriod).force;
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_TRUE(sum.allFinite());
}

TEST_P(EveryRendererTest, AToolThatIsNotFiniteGivesNoForce) {
  Felt felt(geometry::make_sphere(0.03, 8), GetParam());
  felt.renderer->start({0.0, 0.0, 0.05});
  felt.renderer->tick({0.0, 0.0, 0.029}, kPeriod);
  EXPECT_EQ(felt.renderer->tick({0.0, NAN, 0.029}, kPeriod).force, Vector3d(Vector3d::Zero()));
  EXPECT_EQ(felt.renderer->tick({INFINITY, 0.0, 0.0}, kPeriod).force, Vector3d(Vector3d::Zero()));
  EXPECT_GT(felt.renderer->tick({0.0, 0.0, 0.029}, kPeriod).force.z(), 0.0);
}

TEST_P(EveryRendererTest, TheDamperNeverPulls) {
  const double radius = 0.03 + GetParam().radius;
  Felt felt(geometry::make_sphere(0.03, 8), GetParam(), {.damping = 5.0});
  felt.renderer->start({0.0, 0.0, 0.05});
  double most = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double z = radius + 0.002 * std::cos(0.3 * i);
    const Contact& contact = felt.renderer->tick({0.001, 0.002, z}, kPeriod);
    ASSERT_GE(contact.force.dot(contact.normal), 0.0);
    most = std::max(most, contact.force.norm() - 500.0 * contact.depth);
  }
  EXPECT_GT(most, 0.5) << "the damper resists the way in";
}

const auto kContinuous = testing::Values(
    RendererCase{RendererKind::kProxy, 0.0}, RendererCase{RendererKind::kProxy, 0.002},
    RendererCase{RendererKind::kRuspini, 0.002}, RendererCase{RendererKind::kPenalty, 0.0},
    RendererCase{RendererKind::kDistanceField, 0.0});
const auto kVoxel = testing::Values(RendererCase{RendererKind::kVoxel, 0.0});

INSTANTIATE_TEST_SUITE_P(Continuous, EveryRendererTest, kContinuous, case_name);
INSTANTIATE_TEST_SUITE_P(Voxel, EveryRendererTest, kVoxel, case_name);
INSTANTIATE_TEST_SUITE_P(Continuous, ContinuousRendererTest, kContinuous, case_name);

TEST(RendererTest, KindsHaveNames) {
  for (const RendererKind kind : kRendererKinds) {
    EXPECT_EQ(renderer_kind(name_of(kind)), kind);
  }
  EXPECT_THROW(renderer_kind("godly"), std::invalid_argument);
}

TEST(RendererTest, RefusesOptionsOutOfBounds) {
  const geometry::Mesh mesh = geometry::make_sphere(0.03, 2);
  const ContactSurface surface(mesh);
  const auto make = [&](RendererKind kind, const RendererOptions& options) {
    make_renderer(kind, mesh, surface, options);
  };
  EXPECT_THROW(make(RendererKind::kProxy, {.stiffness = 0.0}), std::invalid_argument);
  EXPECT_THROW(make(RendererKind::kProxy, {.damping = -1.0}), std::invalid_argument);
  EXPECT_THROW(make(RendererKind::kRuspini, {}), std::invalid_argument);
  EXPECT_THROW(make(RendererKind::kPenalty, {.radius = 0.01}), std::invalid_argument);
  EXPECT_THROW(make(RendererKind::kVoxel, {.friction = {0.1, 0.1}}), std::invalid_argument);
  EXPECT_THROW(make(RendererKind::kVoxel, {.resolution = 3}), std::invalid_argument);
  EXPECT_THROW(make(RendererKind::kProxy, {.crease_angle = 2.0}), std::invalid_argument);
}

TEST(ShadingTest, ATessellatedSphereFeelsRound) {
  const RendererCase point{RendererKind::kProxy, 0.0};
  Felt plain(geometry::make_sphere(0.03, 12), point);
  Felt shaded(geometry::make_sphere(0.03, 12), point, {.crease_angle = 0.5});
  plain.renderer->start({0, 0, 0.05});
  shaded.renderer->start({0, 0, 0.05});
  double off_plain = 0.0, off_shaded = 0.0;
  for (int i = 0; i <= 5000; ++i) {
    const Vector3d tool = on_loop(i / 5000.0, 0.03), out = tool.normalized();
    off_plain += (plain.renderer->tick(tool, kPeriod).normal - out).squaredNorm();
    off_shaded += (shaded.renderer->tick(tool, kPeriod).normal - out).squaredNorm();
  }
  EXPECT_LT(std::sqrt(off_shaded), 0.2 * std::sqrt(off_plain));
}

TEST(ShadingTest, ACreaseStaysACreaseAndNothingTurnsOver) {
  const RendererCase point{RendererKind::kProxy, 0.0};
  const geometry::Mesh box = make_box(Vector3d::Constant(-0.03), Vector3d::Constant(0.03));
  for (const auto& [mesh, creases] : {std::pair(box, true), std::pair(geometry::make_gear(), false),
                                      std::pair(geometry::make_rough_solid(0.1, 16, 2), false)}) {
    Felt plain(mesh, point), shaded(mesh, point, {.crease_angle = 0.8});
    RandomStream random(2, "crease");
    Vector3d tool(0.08, 0.07, 0.06);
    plain.renderer->start(tool);
    shaded.renderer->start(tool);
    int touching = 0;
    for (int i = 0; i < 5000; ++i) {
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
      tool +=
          1e-3 * Vector3d(x, y, random.uniform(-1, 1)) - 2e-3 * (tool - Vector3d(0.025, 0.01, 0.0));
      const Contact &a = plain.renderer->tick(tool, kPeriod),
                    &b = shaded.renderer->tick(tool, kPeriod);
      if (a.state != ContactState::kFree) {
        ++touching;
        ASSERT_GT(a.normal.dot(b.normal), 0.0) << i;
        ASSERT_NEAR(a.force.norm(), b.force.norm(), 1e-9);
        if (creases) {
          ASSERT_LT((a.force - b.force).norm(), 1e-9) << i;
        }
      }
    }
    EXPECT_GT(touching, 2000);
  }
}

}  // namespace
}  // namespace haptrial::contact
