#include "core/contact/plane_set.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/random.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;

class Planes {
 public:
  Vector3d direction() {
    for (;;) {
      const double x = random_.uniform(-1.0, 1.0), y = random_.uniform(-1.0, 1.0);
      const Vector3d v(x, y, random_.uniform(-1.0, 1.0));
      if (v.norm() > 0.1 && v.norm() < 1.0) {
        return v.normalized();
      }
    }
  }
  double uniform() { return random_.uniform(); }
  /// A plane through the origin or below it; some nearly parallel to the one before.
  ContactPlane next() {
    const double turned = std::pow(10.0, random_.uniform(-1.0, 0.0));
    normal_ = random_.uniform() < 0.3 ? Vector3d((normal_ + turned * direction()).normalized())
                                      : direction();
    const double below = random_.uniform() < 0.5 ? 0.0 : 0.3 * random_.uniform();
    return {normal_, -below * normal_, 0.0, slot_++, false};
  }

 private:
  RandomStream random_{3, "planes"};
  Vector3d normal_{Vector3d::UnitX()};
  std::int32_t slot_{0};
};

/// A point is the nearest one of a convex set if what pushes it there is a sum of the normals of
/// the planes that it lies on, none of which pulls: whatever way it was found.
TEST(PlaneSetTest, ThePointIsTheNearestThatAllPlanesAllow) {
  constexpr double kTolerance = 1e-10, kRounded = 1e-9;
  Planes planes;
  int corners = 0, unsolved = 0, pulling = 0;
  for (int i = 0; i < 20000; ++i) {
    PlaneSet set;
    const int count = 1 + i % 9;
    for (int k = 0; k < count; ++k) {
      set.add(planes.next());
    }
    const Vector3d wish = planes.uniform() * planes.direction();
    const PlaneSolution s = set.solve(Vector3d::Zero(), wish, kTolerance);
    unsolved += !s.solved;
    corners += s.count == 3;
    for (int k = 0; k < count; ++k) {
      ASSERT_GE(set[k].height(s.move), -kRounded) << i << ", plane " << k;
    }
    if (!s.solved) {
      continue;
    }
    Vector3d pushed = Vector3d::Zero();
    for (int k = 0; k < s.count; ++k) {
      pulling += s.push[k] < -kRounded;
      ASSERT_NEAR(set[s.active[k]].height(s.move), 0.0, kRounded) << i;
      pushed += s.push[k] * set[s.active[k]].normal;
    }
    ASSERT_LT((pushed - s.residual).norm(), 1e-6 * (1.0 + pushed.norm())) << i;
    ASSERT_LT((s.move - wish - s.residual).norm(), 1e-12) << i;
  }
  EXPECT_GT(corners, 3000);
  // Cases in which no three of the planes that meet in the proxy are far from parallel.
  EXPECT_LT(pulling, 40);
  EXPECT_EQ(unsolved, 0);
}

}  // namespace
}  // namespace haptrial::contact
