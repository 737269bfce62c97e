#include "core/scene/deformable_object.h"

#include <gtest/gtest.h>

#include "core/deformable/touch/prepared.h"
#include "core/scene/needed_damping.h"
#include "core/scene/scene.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::scene::yielding_test {
namespace {

using Eigen::Vector3d;

constexpr double kTop = 0.01;  // of the block [m]

Field soft_block(const contact::ObjectPose& pose = {}) {
  deformable::FeltSides sides;
  sides.felt = {deformable::BodySide::kTop};
  DeformableObjectParameters p;
  p.mesh = std::make_shared<const deformable::HapticMesh>(
      deformable::felt_block({0.04, 0.02, 0.04}, 8, sides, "block"));
  p.tissue = {15e3, 0.45, 1000.0, {}};
  p.tool.radius = 0.006;
  p.pose = pose;
  p.body = deformable::prepared(p.mesh, p.tissue);
  Field field;
  field.name = "block";
  field.fade_in = 0.0;
  field.kind = p;
  return field;
}

/// The force of a hand that goes down to a depth below the resting surface of a block.
Vector3d pressed(Scene& scene, const contact::ObjectPose& pose, double depth) {
  scene.switch_to(Scene::kAll);
  Vector3d force = Vector3d::Zero();
  for (int i = 0; i <= 100; ++i) {
    PointState hand;
    hand.position =
        pose.orientation * Vector3d(0.001, kTop + 0.006 - depth * i / 100.0, 0.002) + pose.position;
    force = scene.force(hand);
  }
  return force;
}

TEST(DeformableObjectTest, ABlockThatIsTurnedAndMovedIsFeltTurnedAndMoved) {
  const contact::ObjectPose turned{
      Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, -1.0).normalized())),
      {0.02, -0.03, 0.01}};
  Scene first({soft_block()}, 1000.0);
  Scene second({soft_block(turned)}, 1000.0);
  const Vector3d force = pressed(first, {}, 0.002);
  EXPECT_GT(force.y(), 0.1);
  EXPECT_TRUE(first.state(0).contact);
  EXPECT_NEAR(first.state(0).depth, 0.002, 2e-5);
  EXPECT_LT((turned.orientation * force - pressed(second, turned, 0.002)).norm(),
            1e-3 * force.norm());
}

/// The next interval of a trial begins at the place that the hand had on the last tick.
TEST(DeformableObjectTest, AHandThatRestsDeepInABlockFeelsTheSameWhenTheNextSceneBegins) {
  Scene first({soft_block()}, 1000.0);
  const Vector3d force = pressed(first, {}, 0.006);
  ASSERT_GT(force.y(), 0.5);
  Scene next({soft_block()}, 1000.0);
  next.start_from(first);
  next.switch_to(Scene::kAll);
  PointState hand;
  hand.position = {0.001, kTop, 0.002};
  for (int i = 0; i < 10; ++i) {
    EXPECT_LT((next.force(hand) - force).norm(), 0.01 * force.norm()) << i;
  }
}

TEST(DeformableObjectTest, ItIsNoStifferThanItsBoundAndATickDoesNotAllocate) {
  const Field field = soft_block();
  Scene scene({field}, 1000.0);
  const StiffnessBound bound = scene::stiffness_bound({field}, 0);
  EXPECT_TRUE(bound.passive);
  EXPECT_LT(bound.stiffness, 1000.0) << "not the spring alone";
  scene.switch_to(Scene::kAll);
  double before = 0.0;
  const haptrial::test::AllocationGuard guard;
  for (int i = 0; i <= 300; ++i) {
    PointState hand;
    hand.position = {0.0, kTop + 0.0062 - 1e-5 * i, 0.0};
    const double force = scene.force(hand).y();
    EXPECT_LE(force - before, 1e-5 * bound.stiffness * 1.001) << i;
    before = force;
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(DeformableObjectTest, ABodyThatIsNotPreparedIsNotFelt) {
  Field field = soft_block();
  std::get<DeformableObjectParameters>(field.kind).body = nullptr;
  Scene scene({field}, 1000.0);
  EXPECT_EQ(pressed(scene, {}, 0.002).norm(), 0.0);
}

}  // namespace
}  // namespace haptrial::scene::yielding_test
