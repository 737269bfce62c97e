#include "core/contact/moving_objects.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/contact/make_renderer.h"
#include "core/geometry/mesh/procedural.h"
#include "tests/core/contact/hard_meshes.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

TEST(MovingObjectsTest, AMovedObjectFeelsAsInItsOwnFrame) {
  const geometry::Mesh mesh = geometry::make_gear();
  const ContactSurface surface(mesh);
  MovingObjects still, moving;
  const RendererOptions options{.friction = {0.4, 0.3}};
  still.add(make_renderer(RendererKind::kProxy, mesh, surface, options));
  moving.add(make_renderer(RendererKind::kProxy, mesh, surface, options));
  still.start({0.045, 0.0, 0.03});
  moving.start({0.045, 0.0, 0.03});
  double most = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d tool(0.045 * std::cos(2e-3 * i), 0.045 * std::sin(2e-3 * i),
                        0.009 + 0.002 * std::cos(0.01 * i) + (i == 0 ? 0.021 : 0.0));
    const ObjectPose pose{
        Eigen::Quaterniond(Eigen::AngleAxisd(1e-3 * i, Vector3d(1, 2, -1).normalized())),
        Vector3d(1e-5 * i, 0.02 * std::sin(0.01 * i), 0.1)};
    moving.move(0, pose);
    const Vector3d force = still.tick(tool, 0.001);
    const Vector3d elsewhere = moving.tick(pose.orientation * tool + pose.position, 0.001);
    ASSERT_LT((elsewhere - pose.orientation * force).norm(), 1e-8) << i;
    most = std::max(most, force.norm());
  }
  EXPECT_GT(most, 0.3);
}

TEST(MovingObjectsTest, AThinPlateThatIsMovedThroughTheToolTakesItAlong) {
  const geometry::Mesh plate = make_box({-0.05, -0.05, 0}, Vector3d(0.05, 0.05, 1e-5));
  const ContactSurface surface(plate);
  MovingObjects objects;
  objects.add(make_renderer(RendererKind::kProxy, plate, surface, {}));
  objects.start({0.01, 0.02, 0.001});
  EXPECT_EQ(objects.tick({0.01, 0.02, 0.001}, 0.001), Vector3d(Vector3d::Zero()));
  objects.move(0, {Eigen::Quaterniond::Identity(), {0, 0, 0.03}});  // 3 cm in one tick
  const Vector3d force = objects.tick({0.01, 0.02, 0.001}, 0.001);
  EXPECT_LT((force - 500.0 * Vector3d(0, 0, 0.02901)).norm(), 1e-9);
  EXPECT_NEAR(objects.contact(0).proxy.z(), 0.03001, 1e-12);
}

/// A ball that may spin but is not turned: what a collision gives it is counted.
struct FreeBody {
  double mass;
  Vector3d position, velocity;
  Vector3d spin{Vector3d::Zero()};  // about its own centre [N·m·s]

  void push(const Vector3d& force, const Vector3d& at, double period) {
    spin += period * (at - position).cross(force);
    velocity += period / mass * force;
    position += period * velocity;
  }
  Vector3d momentum() const { return mass * velocity; }
  Vector3d angular() const { return position.cross(mass * velocity) + spin; }
};

TEST(MovingObjectsTest, ACollisionConservesMomentum) {
  const geometry::Mesh mesh = geometry::make_sphere(0.03, 20);
  const ContactSurface surface(mesh);
  for (const Friction friction : {Friction{}, Friction{0.5, 0.4}}) {
    MovingObjects objects;
    objects.add(make_renderer(RendererKind::kProxy, mesh, surface, {.friction = friction}));
    FreeBody tool{0.1, {0.01, 0.005, 0.04}, {0.02, 0.0, -0.3}};
    FreeBody body{0.4, {0.0, 0.0, 0.0}, {0.0, 0.05, 0.1}};
    const Vector3d momentum = tool.momentum() + body.momentum();
    const Vector3d angular = tool.angular() + body.angular();
    const auto energy = [&] {
      return 0.5 * tool.mass * tool.velocity.squaredNorm() +
             0.5 * body.mass * body.velocity.squaredNorm();
    };
    const double before = energy(), period = 1e-4;
    objects.start(tool.position);
    double impulse = 0.0;
    for (int i = 0; i < 3000; ++i) {
      objects.move(0, {Eigen::Quaterniond::Identity(), body.position});
      const Vector3d force = objects.tick(tool.position, period);
      impulse += period * force.norm();
      tool.push(force, tool.position, period);
      body.push(-force, objects.contact(0).proxy, period);
      ASSERT_LT((tool.momentum() + body.momentum() - momentum).norm(), 1e-13) << i;
      ASSERT_LT((tool.angular() + body.angular() - angular).norm(), 1e-13) << i;
    }
    EXPECT_GT(impulse, 0.02);
    EXPECT_EQ(objects.contact(0).state, ContactState::kFree) << "they part again";
    if (friction.static_friction == 0.0) {
      EXPECT_NEAR(energy(), before, 0.02 * before);
    } else {
      EXPECT_LT(energy(), before);
    }
  }
}

TEST(MovingObjectsTest, ForcesOfObjectsAddAndNothingAllocates) {
  const geometry::Mesh box = make_box(Vector3d::Constant(-0.05), Vector3d::Constant(0.05));
  const ContactSurface surface(box);
  MovingObjects objects;
  objects.add(make_renderer(RendererKind::kProxy, box, surface, {}));
  objects.add(make_renderer(RendererKind::kProxy, box, surface, {.stiffness = 300.0}),
              {Eigen::Quaterniond::Identity(), {0.1, 0.0, 0.1}});
  const test::AllocationGuard guard;
  objects.start({0.03, 0.0, 0.06});
  // A floor and a wall: the tool is 1 mm below the one and 2 mm behind the other.
  objects.tick({0.045, 0.0, 0.055}, 0.001);
  const Vector3d force = objects.tick({0.052 - 0.01, 0.0, 0.049}, 0.001);
  EXPECT_LT((force - Vector3d(0, 0, 0.5)).norm(), 1e-9);
  const Vector3d both = objects.tick({0.0495, 0.0, 0.049}, 0.001);
  EXPECT_LT((both - Vector3d(0, 0, 0.5)).norm(), 1e-9);
  objects.tick({0.0495, 0.0, 0.051}, 0.001);
  const Vector3d corner = objects.tick({0.052, 0.0, 0.051}, 0.001);
  EXPECT_LT((corner - Vector3d(-0.6, 0, 0)).norm(), 1e-9);
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::contact
