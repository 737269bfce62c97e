#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/contact/proxy.h"
#include "core/geometry/mesh/procedural.h"
#include "tests/core/contact/hard_meshes.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

constexpr double kSpring = 1000.0;  // [N/m]

/// A force divided by the normal of the plane z = 0.
struct OnPlane {
  double normal, along, across;
};

OnPlane force_on_plane(const ProxyState& state, const Vector3d& tool) {
  const Vector3d force = kSpring * (state.position - tool);
  return {force.z(), force.x(), force.y()};
}

TEST(FrictionTest, IsCoulombsOnAPlane) {
  // Sticks with k x up to mu_s F_n; slips with exactly mu_d F_n against the motion; sticks again
  // when the motion turns, over 2 mu_d d (+ the rest up to mu_s).
  const ContactSurface surface(make_box({-0.1, -0.1, -0.02}, Vector3d(0.1, 0.1, 0.0)));
  const Friction friction{0.6, 0.4};
  Proxy proxy(surface, {.friction = friction});
  proxy.start({0, 0, 0.01});
  const double depth = 0.002, step = 1e-5;
  proxy.follow({0, 0, -depth});
  int slips = 0;
  double x = 0.0;
  for (; x < 0.02; x += step) {
    const Vector3d tool(x, 0.0, -depth);
    const ProxyState& state = proxy.follow(tool);
    const OnPlane force = force_on_plane(state, tool);
    ASSERT_NEAR(force.normal, kSpring * depth, 1e-9);
    ASSERT_NEAR(force.across, 0.0, 1e-9);
    if (slips == 0 && state.state == ContactState::kStick) {
      ASSERT_NEAR(force.along, -kSpring * x, 1e-9);
      ASSERT_LE(x, friction.static_friction * depth + 1e-12);
    } else {
      ++slips;
      ASSERT_EQ(state.state, ContactState::kSlip) << x;
      ASSERT_NEAR(force.along, -friction.dynamic_friction * force.normal, 1e-9);
      ASSERT_GT(x, friction.static_friction * depth);
    }
  }
  EXPECT_GT(slips, 1000);
  x -= step;
  const double held = proxy.state().position.x();
  for (double back = 0.0; back < (0.4 + 0.6) * depth - 2e-5; back += step) {
    ASSERT_EQ(proxy.follow({x - back, 0.0, -depth}).state, ContactState::kStick) << back;
    ASSERT_NEAR(proxy.state().position.x(), held, 1e-12);
  }
  for (int i = 0; i < 100; ++i) {
    proxy.follow({x - 0.01 - i * step, 0.0, -depth});
  }
  EXPECT_EQ(proxy.state().state, ContactState::kSlip);
  EXPECT_LT(proxy.state().position.x(), held);
}

TEST(FrictionTest, AGrooveHoldsByTheSumOfItsSides) {
  // A V of two faces at 45 degrees: each carries F / sqrt(2), so along it mu F sqrt(2) holds.
  geometry::Mesh mesh;
  mesh.vertices = {{-0.1, -0.1, 0.1}, {0.1, -0.1, 0.1}, {-0.1, 0.0, 0.0},
                   {0.1, 0.0, 0.0},   {-0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}};
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}};
  const ContactSurface surface(mesh);
  Proxy proxy(surface, {.friction = {0.5, 0.5}});
  proxy.start({0, 0, 0.05});
  const double depth = 0.002;
  proxy.follow({0, 0, -depth});
  for (double x = 0.0; x < 0.01; x += 1e-5) {
    const Vector3d tool(x, 0.0, -depth);
    const ProxyState& state = proxy.follow(tool);
    const OnPlane force = force_on_plane(state, tool);
    ASSERT_NEAR(force.normal, kSpring * depth, 1e-9);
    ASSERT_NEAR(force.along, -std::min(kSpring * x, 0.5 * std::sqrt(2.0) * kSpring * depth), 1e-8)
        << x;
  }
}

TEST(FrictionTest, TheConeIsNeverExceeded) {
  const Friction friction{0.45, 0.3};
  for (const auto& mesh : {geometry::make_rough_solid(0.1, 24, 3), geometry::make_gear()}) {
    const ContactSurface surface(mesh);
    for (const double radius : {0.0, 0.001}) {
      Proxy proxy(surface, {.radius = radius, .friction = friction});
      RandomStream random(8, "cone");
      Vector3d tool(0.06, 0.02, 0.03);
      proxy.start(tool);
      int touching = 0, one_face = 0;
      for (int i = 0; i < 20000; ++i) {
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        tool +=
            3e-4 * Vector3d(x, y, random.uniform(-1, 1)) - 2e-3 * (tool - Vector3d(0.03, 0.0, 0.0));
        const ProxyState& state = proxy.follow(tool);
        if (state.state == ContactState::kFree) {
          continue;
        }
        ++touching;
        const double most = state.state == ContactState::kStick ? friction.static_friction
                                                                : friction.dynamic_friction;
        ASSERT_LE(kSpring * state.dragged.norm(),
                  most * kSpring * state.pressure * (1.0 + 1e-12) + 1e-9)
            << i;
        if (state.planes == 1 && state.settled) {
          // The whole force, seen from the surface alone.
          const Vector3d force = kSpring * (state.position - tool);
          const double normal = force.dot(state.normals[0]);
          ASSERT_LE((force - normal * state.normals[0]).norm(),
                    friction.static_friction * normal + 1e-9)
              << i;
          ++one_face;
        }
      }
      EXPECT_GT(touching, 5000);
      EXPECT_GT(one_face, 1000);
    }
  }
}

}  // namespace
}  // namespace haptrial::contact
