// A rigid tool with six degrees of freedom rests where the energy of springs and contacts is least:
// against exact cases, and against energies that are computed here.

#include "core/contact/rigid_tool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/contact/contact_surface.h"
#include "core/contact/field_renderers.h"
#include "core/geometry/mesh/procedural.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::contact::rigid_tool_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Felt = CoupledTool::Felt;

constexpr double kDt = 1e-3;  // [s]

/// A body whose distance is known without a mesh.
class ExactBody final : public BodyDistance {
 public:
  using Function = std::function<SurfacePoint(const Vector3d&)>;
  explicit ExactBody(Function function) : function_(std::move(function)) {}
  SurfacePoint operator()(const Vector3d& point, std::int32_t) const noexcept override {
    return function_(point);
  }

 private:
  Function function_;
};

SurfacePoint above_plane(const Vector3d& point, const Vector3d& normal) {
  const double distance = point.dot(normal);
  return {distance, point - distance * normal, normal, -1};
}

ExactBody ground() {
  return ExactBody([](const Vector3d& p) { return above_plane(p, Vector3d::UnitZ()); });
}

/// A groove whose sides rise at 45 degrees from the y axis.
ExactBody groove() {
  return ExactBody([](const Vector3d& p) {
    const double half = std::numbers::sqrt2 / 2.0;
    const SurfacePoint left = above_plane(p, Vector3d(half, 0.0, half));
    const SurfacePoint right = above_plane(p, Vector3d(-half, 0.0, half));
    return left.distance < right.distance ? left : right;
  });
}

/// A slot along y with upright walls, as wide as `width`, in ground at z = 0.
ExactBody slot(double width) {
  return ExactBody([width](const Vector3d& p) {
    const double half = 0.5 * width;
    const double side = p.x() < 0.0 ? -1.0 : 1.0;
    const Vector3d rim(side * half, p.y(), 0.0);
    if (std::abs(p.x()) >= half && p.z() <= 0.0) {  // in the solid: out by the nearer way
      return std::abs(p.x()) - half < -p.z() ? SurfacePoint{half - std::abs(p.x()),
                                                            {side * half, p.y(), p.z()},
                                                            -side * Vector3d::UnitX(),
                                                            -1}
                                             : above_plane(p, Vector3d::UnitZ());
    }
    if (p.z() <= 0.0) {
      return SurfacePoint{
          half - std::abs(p.x()), {side * half, p.y(), p.z()}, -side * Vector3d::UnitX(), -1};
    }
    if (std::abs(p.x()) >= half) {
      return above_plane(p, Vector3d::UnitZ());
    }
    const Vector3d away = p - rim;
    return SurfacePoint{away.norm(), rim, away.normalized(), -1};
  });
}

Isometry3d pose(const Vector3d& at, double angle = 0.0, const Vector3d& axis = Vector3d::UnitY()) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  pose.translation() = at;
  return pose;
}

/// Leads the hand from the one pose to the other in 1 s, and waits for 1 s.
Felt lead(RigidTool& tool, const BodyDistance& body, const Isometry3d& from, const Isometry3d& to) {
  Felt felt;
  tool.begin(from);
  const AngleAxisd turn(to.linear() * from.linear().transpose());
  for (int i = 1; i <= 2000; ++i) {
    const double share = std::min(1.0, 1e-3 * i);
    Isometry3d hand = from;
    hand.linear() = AngleAxisd(share * turn.angle(), turn.axis()) * from.linear();
    hand.translation() = from.translation() + share * (to.translation() - from.translation());
    felt = tool.tick(body, hand, kDt);
  }
  return felt;
}

const Vector3d kBox(0.04, 0.03, 0.02);  // sides of the box that is the tool [m]

std::vector<Vector3d> box_points() { return points_on(geometry::make_box(kBox), 5e-3); }

TEST(PointsOnTest, AreAsCloseAsAskedAndEachOnce) {
  const std::vector<Vector3d> points = box_points();
  for (const Vector3d& p : points) {
    EXPECT_NEAR(0.0, (p.cwiseAbs() - 0.5 * kBox).maxCoeff(), 1e-12);
    double nearest = 1.0;
    for (const Vector3d& q : points) {
      nearest = &p == &q ? nearest : std::min(nearest, (p - q).norm());
    }
    EXPECT_GT(nearest, 1e-4);
    EXPECT_LT(nearest, 5.1e-3);
  }
  EXPECT_EQ(8, std::ranges::count_if(points, [](const Vector3d& p) {
              return (p.cwiseAbs() - 0.5 * kBox).cwiseAbs().maxCoeff() < 1e-12;
            }));
}

TEST(RigidToolTest, NothingIsFeltInTheAir) {
  RigidTool tool(box_points(), {});
  const Isometry3d hand = pose({0.0, 0.0, 0.05}, 0.4);
  const Felt felt = lead(tool, ground(), pose({0.1, 0.0, 0.1}), hand);
  EXPECT_EQ(Vector3d::Zero(), felt.force);
  EXPECT_EQ(Vector3d::Zero(), felt.torque);
  EXPECT_EQ(0, felt.touching);
}

TEST(RigidToolTest, AFaceOnAPlaneIsSpringsInARow) {
  RigidTool tool(box_points(), {});
  const double pressed = 3e-3;
  const Felt felt = lead(tool, ground(), pose({0.0, 0.0, 0.02}), pose({0.0, 0.0, 0.01 - pressed}));
  const Coupling c;
  const double all = c.contact_stiffness * felt.touching;
  ASSERT_GT(felt.touching, 30);
  EXPECT_NEAR(pressed / (1.0 / c.stiffness + 1.0 / all), felt.force.z(), 1e-9);
  EXPECT_NEAR(0.0, felt.force.head<2>().norm(), 1e-9);
  EXPECT_NEAR(0.0, felt.torque.norm(), 1e-9);
}

/// A hard edge about y lets the box turn about it: the torque of the turn is the lever's.
TEST(RigidToolTest, AnEdgeOnAPlaneGivesTheTorqueOfItsLever) {
  Coupling stiff;
  stiff.contact_stiffness = 1e7;
  stiff.turning_stiffness = 2.0;
  RigidTool tool(box_points(), stiff);
  const Felt felt = lead(tool, ground(), pose({0.0, 0.0, 0.04}, 0.3), pose({0.0, 0.0, 0.012}, 0.3));
  const Vector3d edge = tool.pose() * Vector3d(0.5 * kBox.x(), 0.0, -0.5 * kBox.z());
  EXPECT_NEAR(0.0, edge.z(), 1e-6);
  EXPECT_GT(felt.force.z(), 1.0);
  EXPECT_NEAR((edge - tool.pose().translation()).cross(felt.force).y(), felt.torque.y(),
              1e-3 * felt.torque.norm());
}

/// A square corner fills a square groove: the box can neither turn nor leave the bottom, so that
/// the hand feels the spring from there to where it would have the edge.
TEST(RigidToolTest, ACornerThatFillsAGrooveIsHeldWhole) {
  Coupling stiff;
  stiff.contact_stiffness = 1e6;
  RigidTool tool(box_points(), stiff);
  const double eighth = std::numbers::pi / 4.0;
  const Vector3d edge_T(0.5 * kBox.x(), 0.0, -0.5 * kBox.z());
  const Vector3d lever = AngleAxisd(eighth, Vector3d::UnitY()) * edge_T;
  const Vector3d aside(0.001, 0.0, -0.004);  // of the edge, in the hand
  const Felt felt = lead(tool, groove(), pose(Vector3d(0.001, 0.0, 0.01) - lever, eighth),
                         pose(aside - lever, eighth));
  EXPECT_NEAR(0.0, (tool.pose() * edge_T).norm(), 5e-6);
  EXPECT_NEAR(eighth, AngleAxisd(tool.pose().linear()).angle(), 1e-4);
  EXPECT_NEAR(0.0, (-stiff.stiffness * aside - felt.force).norm(), 5e-3);
}

/// A peg of width w that is L deep in a slot of width W turns until
///
///     w cos α + L sin α = W
///
/// and holds the hand's turn beyond that by the coupling's spring. Its points are 1 mm apart, so
/// that the rim may be as much as a twentieth of L nearer to where they touch.
TEST(RigidToolTest, APegInASlotTurnsAsFarAsItsPlay) {
  const double w = 0.01, wide = 0.0104, deep = 0.02;
  Coupling stiff;
  stiff.contact_stiffness = 1e6;
  RigidTool tool(points_on(geometry::make_box({w, 0.01, 0.06}), 1e-3), stiff);
  const Vector3d at(0.0, 0.0, 0.03 - deep);
  const double turn = 0.15;
  const Felt felt = lead(tool, slot(wide), pose(at), pose(at, turn));
  double play = 0.0;
  for (int i = 0; i < 50; ++i) {  // Newton's method
    play -= (w * std::cos(play) + deep * std::sin(play) - wide) /
            (deep * std::cos(play) - w * std::sin(play));
  }
  const AngleAxisd turned(tool.pose().linear());
  EXPECT_NEAR(play, turned.angle(), play / 20.0);
  EXPECT_NEAR(-stiff.turning_stiffness * (turn - turned.angle()), felt.torque.y(), 1e-9);
}

/// The energy of springs and contacts, by the formula alone.
double energy(const std::vector<Vector3d>& points, const BodyDistance& body, const Coupling& c,
              const Isometry3d& tool, const Isometry3d& hand) {
  const AngleAxisd turn(tool.linear() * hand.linear().transpose());
  double sum = 0.5 * c.stiffness * (tool.translation() - hand.translation()).squaredNorm() +
               0.5 * c.turning_stiffness * turn.angle() * turn.angle();
  for (const Vector3d& point : points) {
    const double depth = std::max(0.0, -body(tool * point, -1).distance);
    sum += 0.5 * c.contact_stiffness * depth * depth;
  }
  return sum;
}

TEST(RigidToolTest, RestsWhereTheEnergyIsLeast) {
  const std::vector<Vector3d> points = box_points();
  const Coupling c;
  const ExactBody body = groove();
  RigidTool tool(points, c);
  const Isometry3d hand = pose({0.002, 0.001, 0.006}, 0.5, {0.3, 1.0, 0.2});
  ASSERT_GT(lead(tool, body, pose({0.0, 0.0, 0.05}), hand).touching, 2);
  const double least = energy(points, body, c, tool.pose(), hand);
  for (int axis = 0; axis < 6; ++axis) {
    for (const double step : {-1e-4, 1e-4}) {
      Isometry3d other = tool.pose();
      if (axis < 3) {
        other.translation()[axis] += step;
      } else {
        other.linear() = AngleAxisd(20.0 * step, Vector3d::Unit(axis - 3)) * other.linear();
      }
      EXPECT_LT(least, energy(points, body, c, other, hand)) << axis << " " << step;
    }
  }
}

/// A pose on a closed way over a body at z = 0, below it most of the time.
Isometry3d on_a_loop(double phase) {
  const double t = 2.0 * std::numbers::pi * phase;
  return pose({0.01 * std::sin(t), 0.008 * std::sin(2.0 * t), 0.008 - 0.006 * (1.0 - std::cos(t))},
              0.3 * std::sin(t) + 0.2 * std::sin(3.0 * t), {std::cos(t), 1.0, 0.4});
}

/// Energy that the hand is given on three ways around, and the most that it gave in between [J].
std::pair<double, double> energy_of_loops(RigidTool& tool, const BodyDistance& body) {
  constexpr int kTicks = 4000;
  double given = 0.0, least = 0.0;
  Isometry3d before = on_a_loop(0.0);
  tool.begin(before);
  Felt felt;
  for (int i = 1; i <= 3 * kTicks; ++i) {
    const Isometry3d hand = on_a_loop(static_cast<double>(i) / kTicks);
    const Felt now = tool.tick(body, hand, kDt);
    const AngleAxisd turn(hand.linear() * before.linear().transpose());
    given += 0.5 * (felt.force + now.force).dot(hand.translation() - before.translation()) +
             0.5 * (felt.torque + now.torque).dot(turn.angle() * turn.axis());
    least = std::min(least, given);
    before = hand;
    felt = now;
  }
  return {given, least};
}

TEST(RigidToolTest, AClosedWayGivesNoEnergy) {
  for (const double friction : {0.0, 0.3}) {
    Coupling coupling;
    coupling.friction = friction;
    RigidTool tool(box_points(), coupling);
    const auto [given, least] = energy_of_loops(tool, groove());
    EXPECT_LT(least, -5e-4) << "the hand did press";
    EXPECT_LT(given, 1e-3 * -least) << friction;
  }
}

TEST(RigidToolTest, MeshAndGridAgreeWithTheExactBody) {
  const geometry::Mesh block = geometry::make_box({0.2, 0.2, 0.1});
  const ContactSurface surface(block);
  const SignedDistance mesh(block, surface);
  const SampledDistance grid(block, surface, 64);
  const auto lifted = [](const BodyDistance& body) {  // the block's upper face to z = 0
    return ExactBody([&body](const Vector3d& p) {
      SurfacePoint point = body(p + Vector3d(0.0, 0.0, 0.05), -1);
      return point;
    });
  };
  const Isometry3d from = pose({0.0, 0.0, 0.04}), to = pose({0.01, 0.0, 0.008}, 0.2);
  const auto felt = [&](const BodyDistance& body) {
    RigidTool tool(box_points(), {});
    return lead(tool, body, from, to);
  };
  const Felt exact = felt(ground());
  EXPECT_GT(exact.force.norm(), 1.0);
  EXPECT_NEAR(0.0, (felt(lifted(mesh)).force - exact.force).norm(), 1e-9);
  EXPECT_NEAR(0.0, (felt(lifted(grid)).force - exact.force).norm(), 1e-2);
  EXPECT_NEAR(0.0, (felt(lifted(grid)).torque - exact.torque).norm(), 1e-3);
}

TEST(RigidToolTest, AHandThatIsNotFiniteFeelsNothing) {
  RigidTool tool(box_points(), {});
  lead(tool, ground(), pose({0.0, 0.0, 0.02}), pose({0.0, 0.0, 0.008}));
  Isometry3d hand = pose({0.0, 0.0, 0.008});
  hand.translation().x() = std::nan("");
  EXPECT_EQ(Vector3d::Zero(), tool.tick(ground(), hand, kDt).force);
  EXPECT_TRUE(tool.pose().matrix().allFinite());
}

TEST(RigidToolTest, ATickDoesNotAllocate) {
  const geometry::Mesh torus = geometry::make_torus(0.05, 0.02, 60, 40);
  const ContactSurface surface(torus);
  const SignedDistance body(torus, surface);
  RigidTool tool(box_points(), {});
  tool.begin(on_a_loop(0.0));
  int touched = 0;
  const test::AllocationGuard guard;
  for (int i = 0; i < 500; ++i) {
    touched += tool.tick(body, on_a_loop(0.002 * i), kDt).touching;
  }
  EXPECT_EQ(0u, guard.count());
  EXPECT_GT(touched, 0);
}

}  // namespace
}  // namespace haptrial::contact::rigid_tool_test
