#include "core/scene/rigid_object.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/contact/renderer_kinds.h"
#include "core/geometry/mesh/procedural.h"
#include "core/scene/scene.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::scene::rigid_object_test {
namespace {

using Eigen::Vector3d;

constexpr double kRate = 1000.0;

contact::SharedBody shared(geometry::Mesh mesh) {
  return std::make_shared<const contact::FeltBody>(std::move(mesh));
}

Field placed(RigidObjectParameters p, double limit = 50.0) {
  return {"thing", std::move(p), limit, 0.0, 0.0};
}

RigidObjectParameters box_of(const Vector3d& size) {
  RigidObjectParameters p;
  p.body = shared(geometry::make_box(size));
  p.pose = {Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Vector3d(1, -2, 3).normalized())),
            {0.01, -0.02, 0.005}};
  p.gains = {700.0, 0.0};
  return p;
}

/// The last force of a scene with one solid when the tool is led from `from` to `to` in steps of a
/// tick.
Vector3d led(const Field& field, const Vector3d& from, const Vector3d& to, int ticks = 400) {
  Scene scene({field}, kRate);
  scene.switch_to(Scene::kAll);
  Vector3d force = Vector3d::Zero();
  for (int i = 0; i <= ticks; ++i) {
    force = scene.force({from + (to - from) * i / ticks, Vector3d::Zero()});
  }
  return force;
}

TEST(RigidObjectTest, AFaceOfABoxIsExact) {
  const RigidObjectParameters p = box_of({0.04, 0.03, 0.05});
  RandomStream random(3, "box");
  for (int i = 0; i < 50; ++i) {
    const Vector3d over(random.uniform(-0.018, 0.018), 0.02, random.uniform(-0.023, 0.023));
    const double depth = random.uniform(1e-4, 0.008);
    const Vector3d under(over.x(), 0.015 - depth, over.z());
    const Vector3d force = led(placed(p), p.pose.position + p.pose.orientation * over,
                               p.pose.position + p.pose.orientation * under);
    const Vector3d exact = p.pose.orientation * Vector3d(0.0, 700.0 * depth, 0.0);
    EXPECT_LT((force - exact).norm(), 1e-9);
  }
}

/// A hand that presses strokes over the edge of a box, which holds it no more from there on.
TEST(RigidObjectTest, AnEdgeLetsGoByDegrees) {
  for (const double radius : {0.0, 0.003}) {
    RigidObjectParameters p;
    p.body = shared(geometry::make_box({0.04, 0.04, 0.04}));
    p.gains = {800.0, 2.0};
    p.tool_radius = radius;
    Scene scene({placed(p, 10.0)}, kRate);
    scene.switch_to(Scene::kAll);
    constexpr double kSpeed = 0.04;  // [m/s]
    Vector3d before = Vector3d::Zero();
    double largest = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const Vector3d at(0.01 + kSpeed * i / kRate, 0.02 + radius - 0.005 * std::min(1.0, i / 200.0),
                        0.0);
      const Vector3d force = scene.force({at, {kSpeed, i < 200 ? -0.025 : 0.0, 0.0}});
      const double way = std::hypot(kSpeed, i <= 200 ? 0.025 : 0.0) / kRate;
      const double change = i == 200 ? 0.025 : 0.0;  // of the velocity [m/s]
      const double allowed = 800.0 * way + 2.0 * (change + 0.05 * way / 0.001) + 0.2;
      ASSERT_LE((force - before).norm(), allowed) << radius << ' ' << i;
      largest = std::max(largest, force.norm());
      before = force;
    }
    EXPECT_GT(largest, 3.9);
    EXPECT_EQ(before.norm(), 0.0);
  }
}

TEST(RigidObjectTest, ASphereOfTrianglesFeelsLikeTheFieldOfASphere) {
  RigidObjectParameters p;
  p.body = shared(geometry::make_sphere(0.025, 40));
  p.gains = {700.0, 0.0};
  const Field smooth{"ball", SurfaceParameters{Sphere{{0, 0, 0}, 0.025}, false, {700.0, 0.0}}, 50.0,
                     0.0, 0.0};
  // The middle of a facet with edges e lies e² / 6R lower; e is 0.7 to 0.83 mm here.
  const double lower = std::pow(0.025 * 1.1072 / 40.0 * 1.2, 2) / (6.0 * 0.025);
  RandomStream random(4, "sphere");
  for (int i = 0; i < 50; ++i) {
    const Vector3d way = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    const Vector3d from = 0.03 * way, to = 0.022 * way;
    const Vector3d off = led(placed(p), from, to) - led(smooth, from, to);
    EXPECT_LT(std::abs(off.dot(way)), 700.0 * lower);
    EXPECT_LT(off.norm(), 700.0 * 0.003 * 0.02);  // facets lean by up to e / 2R
  }
}

/// The same body in millimetres, or twice as large, with the scale that makes up for it.
TEST(RigidObjectTest, TheScaleChangesLengthsAndNoForce) {
  const RigidObjectParameters metres = box_of({0.04, 0.03, 0.05});
  RigidObjectParameters other = metres;
  other.gains.damping = 3.0;
  RigidObjectParameters same = other;
  same.body = shared(geometry::make_box({40.0, 30.0, 50.0}));
  same.scale = 0.001;
  other.friction = same.friction = {0.5, 0.4};
  other.tool_radius = same.tool_radius = 0.002;
  const Vector3d from = metres.pose.position + Vector3d(0.0, 0.04, 0.03);
  const Vector3d to = metres.pose.position + Vector3d(0.01, 0.0, 0.002);
  EXPECT_LT((led(placed(other), from, to) - led(placed(same), from, to)).norm(), 1e-6);
  EXPECT_GT(led(placed(other), from, to).norm(), 0.5);
}

TEST(RigidObjectTest, AHandInsideIsPushedOutByTheNearestFace) {
  const RigidObjectParameters p = box_of({0.04, 0.03, 0.05});
  const Vector3d inside = p.pose.position + p.pose.orientation * Vector3d(0.017, 0.002, 0.001);
  const Vector3d force = led(placed(p), inside, inside, 3);
  EXPECT_LT((force - p.pose.orientation * Vector3d(700.0 * 0.003, 0.0, 0.0)).norm(), 1e-6);
}

/// A new trial's scene: the proxy stays where it was, so that friction that sticks goes on.
TEST(RigidObjectTest, ANewSceneGoesOnWhereTheProxyWas) {
  RigidObjectParameters p = box_of({0.04, 0.03, 0.05});
  p.friction = {2.0, 2.0};
  const Field field = placed(p);
  const auto at = [&](const Vector3d& local) {
    return PointState{p.pose.position + p.pose.orientation * local, Vector3d::Zero()};
  };
  Scene first({field}, kRate);
  first.switch_to(Scene::kAll);
  first.force(at({0.0, 0.02, 0.0}));
  first.force(at({0.0, 0.012, 0.0}));
  const Vector3d stuck = first.force(at({0.002, 0.012, 0.0}));
  EXPECT_LT((p.pose.orientation.conjugate() * stuck).x(), -1.0);  // held back
  Scene second({field}, kRate);
  second.start_from(first);
  const Vector3d goes_on = second.force(at({0.002, 0.012, 0.0}));
  EXPECT_LT((goes_on - stuck).norm(), 1e-3 * stuck.norm());
}

/// The next interval has the same object: its damper takes no way in that the hand did not make.
TEST(RigidObjectTest, AHandThatRestsIsNotKickedByANewScene) {
  for (const double damping : {2.0, 5.0, 20.0, 80.0}) {
    RigidObjectParameters p = box_of({0.04, 0.03, 0.05});
    p.gains.damping = damping;
    const PointState rests{p.pose.position + p.pose.orientation * Vector3d(0.0, 0.0112, 0.0),
                           Vector3d::Zero()};
    Scene first({placed(p)}, kRate);
    first.switch_to(Scene::kAll);
    const Vector3d spring = 700.0 * 0.0038 * (p.pose.orientation * Vector3d::UnitY());
    Scene second({placed(p)}, kRate);
    for (int i = 0; i < 100; ++i) {
      EXPECT_LT((first.force(rests) - spring).norm(), 1e-6) << damping << " N·s/m, tick " << i;
    }
    second.start_from(first);
    for (int i = 0; i < 20; ++i) {
      EXPECT_LT((second.force(rests) - spring).norm(), 1e-6) << damping << " N·s/m, tick " << i;
    }
  }
}

TEST(RigidObjectTest, RidgesLieBelowTheMesh) {
  const RigidObjectParameters p = box_of({0.04, 0.03, 0.05});
  const Vector3d x = p.pose.orientation * Vector3d::UnitX();
  const GratingParameters grating{"thing", x, 0.0004, 0.004};
  Scene scene({placed(p), {"ridges", grating, 10.0, 0.0, 0.0}}, kRate);
  scene.switch_to(Scene::kAll);
  const double depth = 0.003;
  double least = 1e9, most = 0.0;
  for (int i = 0; i <= 3000; ++i) {  // down, then along
    const double y = i < 1000 ? 0.02 - (0.005 + depth) * i / 1000.0 : 0.015 - depth;
    const double along = i < 1000 ? 0.0 : 0.012 * (i - 1000) / 2000.0;
    const Vector3d hand = p.pose.position + p.pose.orientation * Vector3d(along, y, 0.0);
    const Vector3d force = scene.force({hand, Vector3d::Zero()});
    if (i >= 1000) {
      const double normal = (p.pose.orientation.conjugate() * force).y();
      least = std::min(least, normal);
      most = std::max(most, normal);
    }
  }
  EXPECT_NEAR(most, 700.0 * depth, 0.01);  // on a ridge
  EXPECT_NEAR(least, 700.0 * (depth - 0.0008), 0.01);
}

/// A hand that goes into a face at 0.1 m/s: k d and b v with the share of each.
TEST(RigidObjectTest, StiffnessAndDampingGiveWayByTheirOwnShares) {
  RigidObjectParameters p = box_of({0.04, 0.03, 0.05});
  p.gains.damping = 20.0;
  p.resolution = 128;
  const Vector3d out = p.pose.orientation * Vector3d::UnitY();
  for (const contact::RendererKind kind :
       {contact::RendererKind::kProxy, contact::RendererKind::kPenalty,
        contact::RendererKind::kVoxel, contact::RendererKind::kDistanceField}) {
    p.renderer = kind;
    for (const control::GainShares& shares :
         {control::GainShares{1.0, 1.0}, control::GainShares{1.0, 0.05},
          control::GainShares{0.4, 0.02}}) {
      Scene scene({placed(p)}, kRate);
      scene.switch_to(Scene::kAll);
      Vector3d force = Vector3d::Zero();
      for (int i = 0; i <= 60; ++i) {  // 1 mm above the face to 5 mm below it
        const double y = 0.016 - 1e-4 * i;
        force = scene.force({p.pose.position + y * out, -0.1 * out}, shares);
      }
      const double exact = shares.stiffness * 700.0 * 0.005 + shares.damping * 20.0 * 0.1;
      EXPECT_NEAR(force.dot(out), exact, 0.02 * exact)
          << contact::name_of(kind) << ", shares " << shares.stiffness << " and " << shares.damping;
    }
  }
}

TEST(RigidObjectTest, ATickAllocatesNothing) {
  RigidObjectParameters p;
  p.body = shared(geometry::make_rough_solid(0.05, 20, 1));
  p.friction = {0.4, 0.3};
  p.crease_angle = 0.5;
  Scene scene({placed(p)}, kRate);
  const haptrial::test::AllocationGuard guard;
  scene.switch_to(Scene::kAll);
  for (int i = 0; i < 5000; ++i) {
    const double a = 0.01 * i;
    scene.force(
        {0.018 * Vector3d(std::cos(a), std::sin(a), 0.3 * std::sin(0.7 * a)), Vector3d::Zero()});
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(RigidObjectTest, ABodyThatIsNotThereIsNotFelt) {
  EXPECT_EQ(led(placed(RigidObjectParameters{}), Vector3d::Zero(), Vector3d::Ones()),
            Vector3d::Zero());
}

}  // namespace
}  // namespace haptrial::scene::rigid_object_test
