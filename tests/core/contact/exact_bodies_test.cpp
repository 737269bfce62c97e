// Bodies whose answer is known: rooms and boxes with plane faces to 1e-9 N, ridges, and the
// sphere's convergence with tessellation.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/base/random.h"
#include "core/contact/proxy.h"
#include "core/geometry/mesh/procedural.h"
#include "tests/core/contact/hard_meshes.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;
using geometry::Mesh;

constexpr double kStiffness = 1000.0;  // [N/m]
constexpr double kExact = 1e-9;        // [N]

Mesh turned(Mesh mesh, const Eigen::Quaterniond& by) {
  for (Vector3d& v : mesh.vertices) {
    v = by * v;
  }
  return mesh;
}

Vector3d random_in(RandomStream& random, double reach) {
  const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach);
  return {x, y, random.uniform(-reach, reach)};
}

/// Force of a proxy in a room: k (p - g) with p the point of the room nearest to the tool.
class RoomTest : public testing::TestWithParam<double> {};

TEST_P(RoomTest, WallsEdgesAndCornersAreExact) {
  const double radius = GetParam();
  const Vector3d half(0.05, 0.04, 0.06);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Vector3d(0.3, -0.5, 0.8).normalized()));
  const ContactSurface surface(turned(make_box(-half, half), turn));
  Proxy proxy(surface, {.radius = radius});
  proxy.start(Vector3d::Zero());
  RandomStream random(3, "room");
  int corners = 0, edges = 0;
  double worst = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d tool = random_in(random, 0.1);  // jumps of up to the room's size
    const ProxyState& state = proxy.follow(turn * tool);
    ASSERT_TRUE(state.settled) << i;
    const Vector3d inner = half - Vector3d::Constant(radius);
    const Vector3d exact = tool.cwiseMax(-inner).cwiseMin(inner);
    worst = std::max(worst, kStiffness * (state.position - turn * exact).norm());
    corners += state.planes == 3;
    edges += state.planes == 2;
  }
  EXPECT_LT(worst, kExact);
  EXPECT_GT(corners, 1000);
  EXPECT_GT(edges, 1000);
}

INSTANTIATE_TEST_SUITE_P(PointAndSphere, RoomTest, testing::Values(0.0, 0.004));

TEST(ExactBodiesTest, ASphereRoundEdgesAndCornersOfABox) {
  // A tool outside of the box, nearer than the radius: the proxy is straight above the nearest
  // point of the box.
  const double half = 0.05, radius = 0.01;
  const ContactSurface surface(make_box(Vector3d::Constant(-half), Vector3d::Constant(half)));
  Proxy proxy(surface, {.radius = radius});
  RandomStream random(4, "box");
  Vector3d tool(0.056, 0.056, 0.056);
  proxy.start(tool);
  int touching = 0, first_time = 0;
  for (int i = 0; i < 60000; ++i) {
    const Vector3d next = tool + random_in(random, 0.001);
    const Vector3d nearest = next.cwiseMax(-half).cwiseMin(half);
    const double distance = (next - nearest).norm();
    if (distance < 0.15 * radius || distance > 1.5 * radius) {
      continue;
    }
    tool = next;
    const ProxyState& state = proxy.follow(tool);
    const Vector3d exact =
        distance < radius ? Vector3d(nearest + radius / distance * (tool - nearest)) : tool;
    first_time += state.settled;
    for (int again = 0; again < 20 && !proxy.state().settled; ++again) {
      proxy.follow(tool);
    }
    const double error = kStiffness * (proxy.state().position - exact).norm();
    ASSERT_LT(error, kExact) << i << ", tool " << tool.transpose() << ", distance " << distance;
    touching += distance < radius;
  }
  EXPECT_GT(touching, 5000);
  EXPECT_GT(first_time, 0.99 * touching);
}

TEST(ExactBodiesTest, APointOnABoxSlidesOffItsEdge) {
  const double half = 0.05, depth = 0.002;
  const ContactSurface surface(make_box(Vector3d::Constant(-half), Vector3d::Constant(half)));
  Proxy proxy(surface, {});
  proxy.start({0.0, 0.0, 0.06});
  for (double x = 0.0; x < 0.06; x += 7e-5) {
    const Vector3d tool(x, 0.3 * x, half - depth);
    const ProxyState& state = proxy.follow(tool);
    const Vector3d force = kStiffness * (state.position - tool);
    const double pushed = x < half ? kStiffness * depth : 0.0;
    ASSERT_LT((force - Vector3d(0.0, 0.0, pushed)).norm(), kExact) << x;
  }
}

/// A plate along x and y with a ridge of the height h across it, its flanks at the angle a.
Mesh make_ridge(double h, double a) {
  const double w = h / std::tan(a);
  Mesh mesh;
  for (const double y : {-0.05, 0.05}) {
    for (const Vector3d& v : {Vector3d(-0.1, y, 0), Vector3d(-w, y, 0), Vector3d(0, y, h),
                              Vector3d(w, y, 0), Vector3d(0.1, y, 0)}) {
      mesh.vertices.push_back(v);
    }
  }
  for (std::int32_t i = 0; i < 4; ++i) {
    mesh.triangles.push_back({i, i + 1, i + 6});
    mesh.triangles.push_back({i, i + 6, i + 5});
  }
  return mesh;
}

TEST(ExactBodiesTest, ARidgeIsCrossedWhereTheExactGodObjectCrossesIt) {
  // Figure 65 of the source: the proxy climbs until the tool's foot on the flank is the crest, at
  // x = (h + d) tan(a).
  for (const double degrees : {30.0, 45.0, 60.0, 75.0, 85.0}) {
    for (const double h : {0.0005, 0.002}) {
      for (const double d : {0.0002, 0.001, 0.003}) {
        const double a = degrees * M_PI / 180.0, exact = (h + d) * std::tan(a);
        const ContactSurface surface(make_ridge(h, a));
        Proxy proxy(surface, {});
        proxy.start({-0.05, 0.001, 0.01});
        double crossed = NAN;
        for (double x = -0.05; x < 0.09 && std::isnan(crossed); x += 1e-5) {
          if (proxy.follow({x, 0.001, -d}).position.x() > 1e-9) {
            crossed = x;
          }
        }
        EXPECT_NEAR(crossed, exact, 1.1e-5) << degrees << " degrees, h " << h << ", d " << d;
      }
    }
  }
}

TEST(ExactBodiesTest, ASawToothFloorIsFeltWithoutSticking) {
  // Vertices where ridges meet valleys at every angle: a proxy that stops short of a descent is
  // stuck. It must end where no small move along the surface comes nearer to the tool.
  const Mesh mesh = geometry::make_rough_solid(0.1, 20, 7);
  const ContactSurface surface(mesh);
  Proxy proxy(surface, {});
  Proxy probe(surface, {});
  RandomStream random(5, "rough");
  int stuck = 0, touching = 0;
  Vector3d tool(0.08, 0.08, 0.08);
  proxy.start(tool);
  for (int i = 0; i < 3000; ++i) {
    tool += random_in(random, 0.002) - 0.02 * tool;
    proxy.follow(tool);
    for (int again = 0; again < 20 && !proxy.state().settled; ++again) {
      proxy.follow(tool);
    }
    if (proxy.state().state == ContactState::kFree) {
      continue;
    }
    ++touching;
    const Vector3d rest = proxy.state().position;
    const double distance = (rest - tool).norm();
    for (int k = 0; k < 20; ++k) {
      // A little way along some direction, and from there towards the tool again.
      probe.start(rest);
      probe.follow(rest + random_in(random, 1e-6));
      for (int again = 0; again < 5; ++again) {
        probe.follow(tool);
      }
      if ((probe.state().position - tool).norm() < distance - 1e-5) {
        ++stuck;
        break;
      }
    }
  }
  EXPECT_GT(touching, 1000);
  EXPECT_LE(stuck, touching / 200) << "of " << touching;
}

/// Root mean square error of the force on a tessellated sphere, tool 1 mm deep on a circle at
/// 50 mm/s; and that of the tessellation itself: of the force to the nearest point of the mesh.
struct SphereError {
  double proxy, tessellation;  // [N]
  double size;                 // of the proxy's force alone, without its direction [N]
};

SphereError sphere_error(int frequency, double tool_radius) {
  const double stiffness = 500.0, radius = 0.03, depth = 0.001;
  const ContactSurface surface(geometry::make_sphere(radius, frequency));
  Proxy proxy(surface, {.radius = tool_radius});
  proxy.start({0, 0, 0.05});
  double proxy_square = 0.0, mesh_square = 0.0, size_square = 0.0;
  constexpr int kTicks = 3770;
  for (int i = -200; i < kTicks; ++i) {
    const double a = i * 0.001 * 0.05 / radius;
    const Vector3d out(0.8 * std::sin(a), 0.6 * std::sin(a), std::cos(a));
    const Vector3d tool = (radius + tool_radius - depth) * out;
    const ProxyState& state = proxy.follow(tool);
    if (i < 0) {
      continue;
    }
    const Vector3d exact = stiffness * depth * out;
    const Vector3d force = stiffness * (state.position - tool);
    proxy_square += (force - exact).squaredNorm();
    size_square += std::pow(force.norm() - exact.norm(), 2);
    mesh_square += (stiffness * (surface.bvh().closest((radius - depth) * out).point -
                                 (radius - depth) * out) -
                    exact)
                       .squaredNorm();
  }
  return {std::sqrt(proxy_square / kTicks), std::sqrt(mesh_square / kTicks),
          std::sqrt(size_square / kTicks)};
}

TEST(ExactBodiesTest, SecondOrderConvergenceOnTheSphere) {
  // The force's direction is that of a face, wrong by the first order; its size is wrong by the
  // second. The nearest point of the mesh says what a tessellation can give.
  for (const double tool_radius : {0.0, 0.001}) {
    SphereError before{};
    for (const int frequency : {12, 24, 48}) {
      const SphereError error = sphere_error(frequency, tool_radius);
      if (tool_radius == 0.0) {
        EXPECT_LT(error.proxy, 1.2 * error.tessellation) << frequency;
      }
      if (frequency > 12) {
        EXPECT_GT(before.proxy / error.proxy, 1.8) << frequency << ", radius " << tool_radius;
        EXPECT_GT(before.size / error.size, 3.5) << frequency << ", radius " << tool_radius;
      }
      before = error;
    }
  }
  const SphereError fine = sphere_error(71, 0.0);  // 100,820 triangles
  EXPECT_LT(fine.proxy, 1.2 * 0.0026);
  std::printf("100,820 triangles: %.5f N, nearest point %.5f N, size alone %.2e N\n", fine.proxy,
              fine.tessellation, fine.size);
}

/// At the middle of a fan more triangles are near than a list should have, however short it is.
TEST(ExactBodiesTest, AFanOfManyTrianglesIsAPlane) {
  constexpr int kTriangles = 200;
  geometry::Mesh fan{{{0, 0, 0}}, {}};
  for (int i = 0; i < kTriangles; ++i) {
    const double a = 2.0 * M_PI * i / kTriangles;
    fan.vertices.push_back({0.5 * std::cos(a), 0.5 * std::sin(a), 0.0});
    fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % kTriangles});
  }
  const ContactSurface surface(fan, 1);
  for (const double radius : {0.0, 0.03}) {
    Proxy proxy(surface, {.radius = radius, .most_work = 100'000});
    proxy.start({0.1, 0.0, 0.2});
    RandomStream random(8, "fan");
    for (int i = 0; i < 5000; ++i) {
      const Vector3d tool(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), -0.05);
      const ProxyState& state = proxy.follow(tool);
      ASSERT_TRUE(state.settled) << "radius " << radius << ", step " << i;
      ASSERT_LT((state.position - Vector3d(tool.x(), tool.y(), radius)).norm(), 1e-11) << i;
    }
  }
}

/// If there is one nearest place, a proxy that may do one step a tick comes to it, only later.
TEST(ProxyTest, WorkThatIsLeftIsDoneOnTheNextTicks) {
  const ContactSurface surface(geometry::make_sphere(0.03, 20));
  for (const double radius : {0.0, 0.002}) {
    Proxy all(surface, {.radius = radius, .most_work = 1'000'000});
    Proxy little(surface, {.radius = radius, .most_work = 1});
    RandomStream random(9, "work");
    all.start({0.0, 0.0, 0.05});
    little.start({0.0, 0.0, 0.05});
    Vector3d tool(0.0, 0.0, 0.028);
    int late = 0;
    for (int i = 0; i < 200; ++i) {
      tool = 0.028 * (tool + 0.0005 * random_in(random, 1.0)).normalized();
      all.follow(tool);
      ASSERT_TRUE(all.state().settled) << i;
      double before = 1.0;
      for (int tick = 0; tick == 0 || !little.state().settled; ++tick) {
        ASSERT_LT(tick, 100) << i;
        late += tick > 0;
        const double apart = (little.follow(tool).position - tool).norm();
        ASSERT_LE(apart, before * (1.0 + 1e-12)) << "each tick brings it nearer, " << i;
        before = apart;
      }
      ASSERT_LT((all.state().position - little.state().position).norm(), 1e-9) << i;
    }
    EXPECT_GT(late, 50);
  }
}

TEST(ProxyTest, FollowDoesNotAllocate) {
  const ContactSurface surface(geometry::make_sphere(0.03, 20));
  for (const double radius : {0.0, 0.002}) {
    Proxy proxy(surface, {.radius = radius, .friction = {0.5, 0.3}});
    RandomStream random(6, "alloc");
    const test::AllocationGuard guard;
    proxy.start({0, 0, 0.05});
    for (int i = 0; i < 2000; ++i) {
      proxy.follow(random_in(random, 0.04));
    }
    EXPECT_EQ(guard.count(), 0u);
  }
}

TEST(ProxyTest, RefusesOptionsOutOfBounds) {
  const ContactSurface surface(geometry::make_sphere(0.03, 2));
  EXPECT_THROW(Proxy(surface, {.radius = -1.0}), std::invalid_argument);
  EXPECT_THROW(Proxy(surface, {.radius = NAN}), std::invalid_argument);
  EXPECT_THROW(Proxy(surface, {.friction = {0.2, 0.3}}), std::invalid_argument);
  EXPECT_THROW(Proxy(surface, {.friction = {0.2, -0.3}}), std::invalid_argument);
  EXPECT_THROW(Proxy(surface, {.most_steps = 0}), std::invalid_argument);
  EXPECT_THROW(Proxy(surface, {.most_work = 0}), std::invalid_argument);
}

TEST(ProxyTest, AToolThatIsNotFiniteChangesNothing) {
  const ContactSurface surface(geometry::make_sphere(0.03, 4));
  Proxy proxy(surface, {});
  proxy.start({0, 0, 0.05});
  const Vector3d at = proxy.follow({0, 0, 0.02}).position;
  EXPECT_EQ(proxy.follow({0, NAN, 0.02}).position, at);
  EXPECT_EQ(proxy.follow({INFINITY, 0, 0}).position, at);
}

}  // namespace
}  // namespace haptrial::contact
