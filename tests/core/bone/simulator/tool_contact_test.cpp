#include "core/bone/simulator/tool_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "core/bone/simulator/simulator.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::bone::tool_contact_test {
namespace {

using Eigen::Vector3d;

constexpr double kStiffness = 1000.0;

Vector3d anywhere(RandomStream& random, double width) {
  const auto along = [&] { return width * (random.uniform() - 0.5); };
  const double x = along();
  const double y = along();
  return {x, y, along()};
}

/// The least distance of many points of one segment from the other one, which is exact for each.
double by_points(const Rod& first, const Rod& second) {
  constexpr int kPoints = 20000;
  const Vector3d along = second.to - second.from;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kPoints; ++i) {
    const Vector3d point = first.from + (first.to - first.from) * i / kPoints;
    const double at =
        along.isZero(0.0)
            ? 0.0
            : std::clamp((point - second.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (point - second.from - at * along).norm());
  }
  return least;
}

TEST(ToolContactTest, DistanceIsThatOfTheNearestPoints) {
  RandomStream random(1, "rods");
  for (int i = 0; i < 300; ++i) {
    Rod a{anywhere(random, 0.1), anywhere(random, 0.1), 1e-3};
    Rod b{anywhere(random, 0.1), anywhere(random, 0.1), 1e-3};
    if (i % 10 == 0) {
      a.to = a.from;
    }
    if (i % 15 == 0) {
      b.to = b.from;
    }
    if (i % 7 == 1) {
      b.to = b.from + 0.7 * (a.to - a.from);  // parallel
    }
    const RodDistance found = distance(a, b);
    EXPECT_NEAR(found.between_axes, by_points(a, b), 6e-6) << i;
    EXPECT_NEAR(found.normal.norm(), 1.0, 1e-12);
  }
}

TEST(ToolContactTest, TheNormalIsTheGradientOfTheDistance) {
  RandomStream random(2, "rods");
  constexpr double kStep = 1e-7;
  for (int i = 0; i < 100; ++i) {
    const Rod a{anywhere(random, 0.1), anywhere(random, 0.1), 1e-3};
    const Rod b{anywhere(random, 0.1), anywhere(random, 0.1), 1e-3};
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d by = kStep * Vector3d::Unit(axis);
      const double slope = (distance({a.from + by, a.to + by, 1e-3}, b).between_axes -
                            distance({a.from - by, a.to - by, 1e-3}, b).between_axes) /
                           (2.0 * kStep);
      EXPECT_NEAR(distance(a, b).normal[axis], slope, 1e-5);
    }
  }
}

/// A burr of 4 mm at a place with a handle along y, and a tube along x at the origin.
std::vector<Rod> burr_at(const Vector3d& place) {
  return {{place, place, 2e-3}, {place, place + Vector3d(0.0, 0.1, 0.0), 1e-3}};
}
const Rod kTube{{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, 1.7e-3};

ToolContact apart(double damping = 0.0, double limit = 100.0) {
  ToolContact contact({kStiffness, damping, limit});
  contact.force(burr_at({0.0, 1.0, 0.0}), kTube, Vector3d::Zero(), 0.0);
  return contact;
}

TEST(ToolContactTest, PushesByDepthAndRateAlongTheNormalUpToItsLimit) {
  const std::vector<Rod> burr = burr_at({0.05, 3.2e-3, 0.0});  // 0.5 mm deep
  EXPECT_TRUE(apart().force(burr, kTube, Vector3d::Zero(), 0.0).isApprox(Vector3d(0.0, 0.5, 0.0)));
  const Vector3d closing(0.3, 0.1, 0.2);
  EXPECT_TRUE(apart(5.0).force(burr, kTube, closing, 0.0).isApprox(Vector3d(0.0, 0.75, 0.0)));
  EXPECT_TRUE(apart(5.0).force(burr, kTube, -closing, 0.0).isApprox(Vector3d(0.0, 0.25, 0.0)));
  EXPECT_EQ(apart(5.0).force(burr, kTube, -3.0 * closing, 0.0), Vector3d::Zero());  // never pulls
  EXPECT_TRUE(apart(0.0, 0.4).force(burr, kTube, closing, 0.0).isApprox(Vector3d(0.0, 0.4, 0.0)));
  EXPECT_TRUE(apart().force(burr, kTube, closing, 2e-3).isApprox(Vector3d(0.0, 0.6, 0.0)));
  EXPECT_EQ(apart().force(burr_at({0.05, 3.8e-3, 0.0}), kTube, closing, 0.0), Vector3d::Zero());
}

TEST(ToolContactTest, EachPushesTheOtherByTheSame) {
  RandomStream random(3, "rods");
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const Rod a{anywhere(random, 0.02), anywhere(random, 0.02), 1.5e-3};
    const Rod b{anywhere(random, 0.02), anywhere(random, 0.02), 2e-3};
    const Vector3d closing = anywhere(random, 0.3);
    const Rod far{{1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, 1e-3};
    ToolContact here({kStiffness, 5.0, 4.0});
    ToolContact there({kStiffness, 5.0, 4.0});
    here.force({&far, 1}, b, closing, 1e-3);
    there.force({&far, 1}, a, closing, 1e-3);
    const Vector3d on_a = here.force({&a, 1}, b, closing, 1e-3);
    const Vector3d on_b = there.force({&b, 1}, a, -closing, 1e-3);
    EXPECT_LT((on_a + on_b).norm(), 1e-9);
    met += on_a.isZero(0.0) ? 0 : 1;
  }
  EXPECT_GT(met, 300);
}

/// Work of the contact on both hands while they move along a closed path in small steps.
double work_around(double damping) {
  ToolContact contact = apart(damping);
  double work = 0.0;
  constexpr int kSteps = 20000;
  constexpr double kTick = 1e-4;
  const auto burr = [](int step) {
    const double angle = 2.0 * M_PI * step / kSteps;
    return Vector3d(0.05 + 4e-3 * std::sin(2.0 * angle), 4.5e-3 - 2.5e-3 * std::sin(angle),
                    2e-3 * std::cos(angle));
  };
  Vector3d before = Vector3d::Zero();
  for (int step = 0; step <= kSteps; ++step) {
    const Vector3d motion = burr(step + 1) - burr(step);
    const Vector3d force = contact.force(burr_at(burr(step)), kTube, -motion / kTick, 0.0);
    work += step > 0 ? 0.5 * (force + before).dot(burr(step) - burr(step - 1)) : 0.0;
    before = force;
  }
  return work;
}

TEST(ToolContactTest, AClosedPathCostsNothingWithoutDampingAndEnergyWithIt) {
  const double stored = 0.5 * kStiffness * 1.7e-3 * 1.7e-3;  // where it is deepest [J]
  EXPECT_NEAR(work_around(0.0), 0.0, 1e-4 * stored);
  EXPECT_LT(work_around(5.0), -0.02 * stored);
}

/// Kinetic energy after two masses have met in ticks of 1 ms, over that before.
double bounced(double speed, double damping, double held = 1e-3) {
  constexpr double kMass = 0.22;  // of a handle [kg]
  constexpr double kTick = 1e-3;
  ToolContact contact = apart(damping);
  Vector3d burr(0.05, 6e-3, 1e-3);
  Vector3d tube = Vector3d::Zero();
  Vector3d burr_speed(0.0, -speed, 0.0);
  Vector3d tube_speed = Vector3d::Zero();
  for (int tick = 0; tick < 4000; ++tick) {
    const Rod moved{kTube.from + tube, kTube.to + tube, kTube.radius};
    const Vector3d force = contact.force(burr_at(burr), moved, tube_speed - burr_speed, held);
    // Exact for a force that is held for the tick, as a device holds it.
    burr += kTick * (burr_speed + 0.5 * kTick * force / kMass);
    tube += kTick * (tube_speed - 0.5 * kTick * force / kMass);
    burr_speed += kTick * force / kMass;
    tube_speed -= kTick * force / kMass;
    EXPECT_LT((burr_speed + tube_speed - Vector3d(0.0, -speed, 0.0)).norm(), 1e-12);
  }
  return (burr_speed.squaredNorm() + tube_speed.squaredNorm()) / (speed * speed);
}

TEST(ToolContactTest, ToolsThatMeetLoseEnergyAlsoInTicks) {
  for (const double speed : {0.02, 0.05, 0.1, 0.2}) {
    EXPECT_LT(bounced(speed, ToolContactParameters{}.damping), 1.0) << speed;
  }
  EXPECT_NEAR(bounced(0.1, 0.0), 1.0, 0.02);  // nor does a spring alone gain much
  EXPECT_GT(bounced(0.1, 0.0, 0.0), 1.05);    // as it would by being held for a tick
}

/// Beyond the axes the force fades: nobody who presses through is let go in one step.
/// @param tool  at a height over the tube  @param reach  sum of the radii
void expect_let_go_by_degrees(const std::function<Rod(double)>& tool, double reach) {
  constexpr double kStep = 1e-4;  // [m]
  ToolContact contact = apart();
  double before = 0.0;
  for (double height = reach; height > -reach - 5.0 * kStep; height -= kStep) {
    const std::array rods{tool(height)};
    const double force = contact.force(rods, kTube, Vector3d::Zero(), 0.0).norm();
    EXPECT_LT(std::abs(force - before), 2.0 * kStiffness * kStep) << height;
    if (height > 0.0) {
      EXPECT_NEAR(force, kStiffness * (reach - height), 1e-9) << height;
    }
    before = force;
  }
  EXPECT_EQ(before, 0.0);
}

TEST(ToolContactTest, ToolsThatCrossArePushedBackAndLetGoByDegrees) {
  expect_let_go_by_degrees(
      [](double height) {
        const Vector3d place(0.05, height, 0.0);
        return Rod{place, place, 2e-3};
      },
      3.7e-3);
  expect_let_go_by_degrees(
      [](double height) {
        return Rod{{0.05, -0.05, height}, {0.05, 0.05, height}, 1e-3};
      },
      2.7e-3);
}

TEST(ToolContactTest, ToolsThatAreInEachOtherAtFirstAreNotFeltBeforeTheyWereApart) {
  ToolContact contact({kStiffness, 0.0, 4.0});
  const std::vector<Rod> deep = burr_at({0.05, 3e-3, 0.0});
  EXPECT_EQ(contact.force(deep, kTube, Vector3d::Zero(), 0.0), Vector3d::Zero());
  contact.force(burr_at({0.05, 5e-3, 0.0}), kTube, Vector3d::Zero(), 0.0);
  EXPECT_GT(contact.force(deep, kTube, Vector3d::Zero(), 0.0).norm(), 0.0);
  contact.wait();
  EXPECT_EQ(contact.force(deep, kTube, Vector3d::Zero(), 0.0), Vector3d::Zero());
}

TEST(ToolContactTest, RejectsWhatBreaksItsBound) {
  EXPECT_THROW(ToolContact({-1.0, 0.0, 4.0}), std::invalid_argument);
  EXPECT_THROW(ToolContact({1000.0, -1.0, 4.0}), std::invalid_argument);
  EXPECT_THROW(ToolContact({1000.0, 0.0, 0.0}), std::invalid_argument);
}

SimulatorParameters with_tools() {
  SimulatorParameters p;
  BurrTool burr;
  burr.burr = default_burr(BurrKind::kCutting, 4e-3);
  burr.feel = default_feel(burr.radius());
  BurrTool fissure;
  fissure.burr = default_burr(BurrKind::kCutting, {BurrForm::kCylinder, 2e-3, 8e-3, 0.0});
  fissure.feel = default_feel(1e-3);
  p.tools = {{"burr", 2.5e-3, 0.1, burr},
             {"fissure", 2.5e-3, 0.1, fissure},
             {"tube", 2.5e-3, 0.1, SuctionTool{1.5e-3}},
             {"grip", 2.5e-3, 0.1, GripTool{}}};
  p.tube.emplace();
  p.tube->feel = default_feel(p.tube->outer_radius());
  p.tube->at_tool.stiffness = kStiffness;
  return p;
}

BoneModel crumb() {
  BoneModel model;
  model.grid = {{4, 4, 4}, {1.0, 1.0, 1.0}, 1e-3};
  model.structures = {{}, {"bone", {}}};
  model.labels.assign(64, 1);
  return model;
}

/// The tool's tip above the middle of a tube along x, its handle up.
SimulatorInput above(double height, std::uint32_t functions = 0) {
  SimulatorInput input;
  input.functions = functions;
  input.tool.tip.position = {0.05, height, 0.0};
  input.tool.orientation = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), Vector3d::UnitY());
  input.tube.tool.orientation =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), Vector3d::UnitX());
  return input;
}

TEST(ToolContactTest, ATubeMeetsBurrsShaftsAndTubesWhateverTheirShape) {
  const SimulatorParameters p = with_tools();
  const double tube = p.tube->outer_radius();
  const std::vector<double> reach{tube + 2e-3, tube + 4e-3, tube + 1.5e-3};  // of the tip
  Simulator simulator(crumb(), p);
  simulator.begin(0);
  for (std::size_t tool = 0; tool < reach.size(); ++tool) {
    simulator.tick(above(0.02));
    EXPECT_EQ(simulator.tick(above(reach[tool] + 1e-5)).pushed, Vector3d::Zero()) << tool;
    const Vector3d pushed = simulator.tick(above(reach[tool] - 1e-3)).pushed;
    EXPECT_LT((pushed - Vector3d(0.0, kStiffness * 1e-3, 0.0)).norm(), 1e-3) << tool;
    simulator.tick(above(0.02));
    SimulatorInput beside = above(-0.05);  // its shaft passes the tube
    beside.tool.tip.position.z() = tube + (tool == 1 ? 1e-3 : tool == 2 ? 1.5e-3 : 2e-3) - 5e-4;
    EXPECT_NEAR(simulator.tick(beside).pushed.z(), kStiffness * 5e-4, 1e-6) << tool;
    simulator.tick(above(0.02, bit(Function::kNextTool)));
  }
  EXPECT_EQ(simulator.tick(above(0.0)).pushed, Vector3d::Zero());  // a grip
}

TEST(ToolContactTest, ANewToolOrOneThatComesBackIsNotFeltBeforeItWasApart) {
  Simulator simulator(crumb(), with_tools());
  simulator.begin(0);
  simulator.tick(above(0.02));
  EXPECT_GT(simulator.tick(above(3e-3)).pushed.norm(), 0.0);
  EXPECT_EQ(simulator.tick(above(3e-3, bit(Function::kCameraMove))).pushed, Vector3d::Zero());
  EXPECT_EQ(simulator.tick(above(3e-3)).pushed, Vector3d::Zero());
  simulator.tick(above(0.02));
  EXPECT_GT(simulator.tick(above(3e-3)).pushed.norm(), 0.0);
  EXPECT_EQ(simulator.tick(above(3e-3, bit(Function::kNextTool))).pushed, Vector3d::Zero());
}

TEST(ToolContactTest, ByDefaultToolsPassThroughEachOther) {
  SimulatorParameters p = with_tools();
  p.tube->at_tool = {};
  Simulator simulator(crumb(), p);
  simulator.begin(0);
  simulator.tick(above(0.02));
  EXPECT_EQ(simulator.tick(above(1e-3)).pushed, Vector3d::Zero());
}

TEST(ToolContactTest, ATickDoesNotAllocate) {
  Simulator simulator(crumb(), with_tools());
  simulator.begin(0);
  simulator.tick(above(0.02));
  double felt = 0.0;
  const test::AllocationGuard guard;
  for (int i = 0; i < 2000; ++i) {
    const double height = 8e-3 - 6e-3 * std::pow(std::sin(M_PI * i / 250.0), 2);
    felt +=
        simulator.tick(above(height, i % 500 == 0 ? bit(Function::kNextTool) : 0)).pushed.norm();
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(felt, 0.0);
}

}  // namespace
}  // namespace haptrial::bone::tool_contact_test
