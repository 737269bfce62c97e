// The proxy never passes through a triangle: its whole way is checked against every triangle
// without rounding. HAPTRIAL_CONTACT_STEPS sets the number of steps (10^8: a night).

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iomanip>
#include <limits>
#include <span>
#include <string>

#include "core/base/random.h"
#include "core/contact/proxy.h"
#include "core/geometry/mesh/procedural.h"
#include "tests/core/contact/exact_crossing.h"
#include "tests/core/contact/hard_meshes.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;
using geometry::Mesh;

double steps_wanted() {
  const char* named = std::getenv("HAPTRIAL_CONTACT_STEPS");
  return named != nullptr ? std::atof(named) : 6e5;
}

/// A long run says what is behind it.
void say_how_far(const HardMesh& hard, std::int64_t steps) {
  static double behind = 0.0;
  behind += static_cast<double>(steps);
  if (std::getenv("HAPTRIAL_CONTACT_STEPS") != nullptr) {
    std::printf("%.0f steps, %s\n", behind, hard.name.c_str());
    std::fflush(stdout);
  }
}

Mesh scaled(Mesh mesh, double scale, const Vector3d& by) {
  for (Vector3d& v : mesh.vertices) {
    v = scale * v + by;
  }
  return mesh;
}

/// A hand that tries to get through: jumps, walks with steps of every size, aims at corners, edges
/// and faces, and steps as small as the proxy's own tolerances.
class WildHand {
 public:
  WildHand(const Mesh& mesh, double size, const Vector3d& middle, std::uint64_t seed)
      : mesh_(mesh), size_(size), middle_(middle), random_(seed, "wild hand"), at_(middle) {}

  Vector3d next(const Vector3d& proxy) {
    const double kind = random_.uniform();
    if (kind < 0.15) {
      at_ = middle_ + size_ * cube(0.8);
    } else if (kind < 0.45) {
      at_ += size_ * std::pow(10.0, random_.uniform(-14.0, 0.0)) * cube(1.0);
    } else if (kind < 0.7) {
      // The way goes through a point of the surface, exactly as far as rounding allows.
      const Vector3d target = on_surface();
      const double beyond = random_.below(2) == 0 ? 1.0 : random_.uniform(0.5, 3.0);
      at_ = target + beyond * (target - proxy);
    } else if (kind < 0.8) {
      const double skin = Skin::of(at_.cwiseAbs().maxCoeff()).thickness;
      at_ = proxy + skin * std::pow(2.0, static_cast<double>(random_.below(7)) - 3.0) * axis();
    } else if (kind < 0.9) {
      at_ = on_surface();
    } else {
      at_ = proxy + 0.3 * (middle_ + size_ * cube(0.3) - proxy);
    }
    if (!((at_ - middle_).cwiseAbs().maxCoeff() < 2.0 * size_)) {
      at_ = middle_ + size_ * cube(0.8);
    }
    return at_;
  }

 private:
  Vector3d cube(double reach) {
    const double x = random_.uniform(-reach, reach), y = random_.uniform(-reach, reach);
    return {x, y, random_.uniform(-reach, reach)};
  }
  Vector3d axis() {
    Vector3d a = Vector3d::Zero();
    a[static_cast<int>(random_.below(3))] = random_.below(2) == 0 ? 1.0 : -1.0;
    return random_.below(2) == 0 ? a : Vector3d(cube(1.0));
  }
  Vector3d on_surface() {
    const geometry::Triangle& t = mesh_.triangles[random_.below(mesh_.triangles.size())];
    const Vector3d &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
    switch (random_.below(4)) {
      case 0:
        return a;
      case 1:
        return (a + b) / 2.0;
      case 2:
        return a + random_.uniform() * (b - a);
      default:
        return (a + b + c) / 3.0;
    }
  }

  const Mesh& mesh_;
  double size_;
  Vector3d middle_;
  RandomStream random_;
  Vector3d at_;
};

struct Place {
  double scale;
  Vector3d by;
};

/// Least distance from the corners of a way to the surface.
double least_distance(const ContactSurface& surface, std::span<const Vector3d> way) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vector3d& corner : way) {
    least = std::min(least, surface.bvh().closest(corner).distance_squared);
  }
  return std::sqrt(least);
}

/// One mesh, proxy and hand; fails at the first crossing.
void try_to_get_through(const HardMesh& hard, const Place& place, double radius, double friction,
                        std::int64_t steps, std::uint64_t seed) {
  const Mesh mesh = scaled(hard.mesh, place.scale, place.by);
  SCOPED_TRACE(hard.name + ", scale " + std::to_string(place.scale) + ", radius " +
               std::to_string(radius) + ", seed " + std::to_string(seed));
  const ContactSurface surface(mesh, 1);
  const ExactCrossing crossing(mesh);
  Proxy proxy(surface, {.radius = radius * place.scale, .friction = {1.2 * friction, friction}});
  WildHand hand(mesh, place.scale, place.by, seed);
  proxy.start(place.by + Vector3d(1.3, 1.1, 1.2) * place.scale);
  for (std::int64_t i = 0; i < steps; ++i) {
    const Vector3d before = proxy.state().position;
    const Vector3d tool = hand.next(before);
    const ProxyState& state = proxy.follow(tool);
    const auto way = proxy.way();
    ASSERT_TRUE(way.front() == before && way.back() == state.position) << "step " << i;
    for (std::size_t k = 1; k < way.size(); ++k) {
      ASSERT_EQ(crossing(way[k - 1], way[k]), -1)
          << "step " << i << ", part " << k << " of " << way.size() << std::setprecision(17) << ": "
          << way[k - 1].transpose() << " to " << way[k].transpose();
    }
    ASSERT_TRUE(radius == 0.0 || least_distance(surface, way) > 0.999 * radius * place.scale)
        << "step " << i << ": the sphere cuts the surface";
    const double slack = 16.0 * Skin::of(surface.magnitude()).thickness;
    ASSERT_LE((state.position - tool).norm(), (before - tool).norm() + slack)
        << "step " << i << ", farther by "
        << (state.position - tool).norm() - (before - tool).norm() << " in " << way.size()
        << " parts, first to " << (way[std::min<std::size_t>(1, way.size() - 1)] - tool).norm();
    if (hard.closed && i % 1000 == 0) {
      ASSERT_FALSE(holds(mesh, state.position)) << "step " << i;
    }
  }
  say_how_far(hard, steps);
}

const Place kPlaces[] = {{1.0, {0, 0, 0}},
                         {1e-6, {0, 0, 0}},
                         {1e6, {0, 0, 0}},
                         {1.0, {1000.0, -2000.0, 500.0}},
                         {0.1, {0.01, 0.02, 0.03}}};

TEST(NeverThroughTest, PointOnHardMeshesAtEveryScale) {
  const std::vector<HardMesh> meshes = hard_meshes();
  const auto runs = static_cast<double>(meshes.size() * std::size(kPlaces) * 2);
  std::uint64_t seed = 1;
  for (const HardMesh& hard : meshes) {
    for (const Place& place : kPlaces) {
      for (const double friction : {0.0, 0.4}) {
        try_to_get_through(hard, place, 0.0, friction,
                           static_cast<std::int64_t>(0.5 * steps_wanted() / runs), seed++);
        if (HasFatalFailure()) {
          return;
        }
      }
    }
  }
}

TEST(NeverThroughTest, SphereOnHardMeshes) {
  const std::vector<HardMesh> meshes = hard_meshes();
  const auto runs = static_cast<double>(meshes.size() * std::size(kPlaces) * 2);
  std::uint64_t seed = 1000;
  for (const HardMesh& hard : meshes) {
    for (const Place& place : kPlaces) {
      for (const double radius : {0.03, 0.3}) {
        try_to_get_through(hard, place, radius, 0.0,
                           static_cast<std::int64_t>(0.2 * steps_wanted() / runs), seed++);
        if (HasFatalFailure()) {
          return;
        }
      }
    }
  }
}

TEST(NeverThroughTest, PointAndSphereOnScannedMeshes) {
  const std::vector<HardMesh> meshes = scanned_meshes();
  if (meshes.empty()) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds the scanned meshes";
  }
  std::uint64_t seed = 2000;
  const auto runs = static_cast<double>(meshes.size() * 3);
  for (const HardMesh& hard : meshes) {
    for (const double radius : {0.0, 0.0, 0.01}) {
      try_to_get_through(hard, kPlaces[seed % std::size(kPlaces)], radius, 0.0,
                         static_cast<std::int64_t>(0.3 * steps_wanted() / runs), seed);
      ++seed;
      if (HasFatalFailure()) {
        return;
      }
    }
  }
}

TEST(NeverThroughTest, ExactlyThroughAnEdgeOrACorner) {
  // Straight at points that two or more triangles share, from places where the middle is exact.
  for (const Mesh& mesh :
       {make_box(Vector3d::Constant(-0.5), Vector3d::Constant(0.5)),
        with_slivers(make_box(Vector3d::Constant(-0.5), Vector3d::Constant(0.5)), 30, 9)}) {
    const ContactSurface surface(mesh, 1);
    Proxy proxy(surface, {});
    int aimed = 0;
    for (const geometry::Triangle& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) {
        const Vector3d &a = mesh.vertices[t[k]], &b = mesh.vertices[t[(k + 1) % 3]];
        for (const Vector3d& target : {Vector3d((a + b) / 2.0), a}) {
          proxy.start(2.0 * target);
          proxy.follow(Vector3d::Zero());
          ASSERT_FALSE(holds(mesh, proxy.state().position)) << target.transpose();
          ASSERT_NE(proxy.state().state, ContactState::kFree);
          ++aimed;
        }
      }
    }
    EXPECT_GE(aimed, 72);
  }
}

TEST(NeverThroughTest, ASkinThatGrowsWithThePathLetsNothingThrough) {
  // The proxy lies in the plane of a side, just below it, and the tool far up in that plane.
  const Mesh mesh = make_box(Vector3d::Constant(-0.5), Vector3d::Constant(0.5));
  const ContactSurface surface(mesh, 1);
  const ExactCrossing crossing(mesh);
  for (const double far : {0.9, 2.0, 30.0, 1e4}) {
    for (const double below : {1e-13, 1.7053e-13, 1e-12, 1e-9}) {
      Proxy proxy(surface, {});
      proxy.start({-0.5, 0.0, -0.5 - below});
      for (int i = 0; i < 3; ++i) {
        proxy.follow({-0.5, -0.2 * far, far});
        const auto way = proxy.way();
        for (std::size_t k = 1; k < way.size(); ++k) {
          ASSERT_EQ(crossing(way[k - 1], way[k]), -1) << far << ", " << below;
        }
      }
    }
  }
}

TEST(NeverThroughTest, ASphereThatRollsOverManyEdgesATickNeverCutsThem) {
  // The proxy's ways round edges are blocked by the next faces all the time; a discovery on a way
  // that it does not take must not be believed afterwards.
  for (const int frequency : {30, 71}) {
    const ContactSurface surface(geometry::make_sphere(0.03, frequency));
    const double radius = 0.001;
    Proxy proxy(surface, {.radius = radius});
    proxy.start({0, 0, 0.04});
    for (int i = 0; i < 20000; ++i) {
      const double a = i * 5e-5 / 0.03;
      proxy.follow(0.03 * Vector3d(0.8 * std::sin(a), 0.6 * std::sin(a), std::cos(a)));
      ASSERT_GE(least_distance(surface, proxy.way()), radius) << i;
    }
  }
}

TEST(NeverThroughTest, ASphereDoesNotEnterACrackNarrowerThanItself) {
  const Mesh whole = make_box(Vector3d::Constant(-0.5), Vector3d::Constant(0.5));
  for (const double gap : {1e-6, 1e-3}) {
    const Mesh mesh = with_crack(whole, gap);
    const ContactSurface surface(mesh, 1);
    Proxy proxy(surface, {.radius = 0.01});
    WildHand hand(mesh, 1.0, Vector3d::Zero(), 77);
    proxy.start({1.0, 1.0, 1.0});
    for (int i = 0; i < 5000; ++i) {
      proxy.follow(hand.next(proxy.state().position));
      ASSERT_FALSE(holds(whole, proxy.state().position)) << i;
    }
  }
}

}  // namespace
}  // namespace haptrial::contact
