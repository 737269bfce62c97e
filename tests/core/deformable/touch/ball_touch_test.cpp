#include "core/deformable/touch/ball_touch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/deformable/elements/static_solver.h"
#include "core/deformable/touch/prepared.h"
#include "core/deformable/touch/touch_cost.h"
#include "tests/core/deformable/touch/soft_block.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::deformable::ball_touch_test {
namespace {

using Eigen::Vector3d;
using test::half_space;
using test::soft_block;
using test::soft_tissue;

constexpr double kTop = 0.012;  // of the soft block [m]
constexpr double kTick = 0.001;

SharedCompliance soft_body() {
  static const auto body = std::make_shared<const Compliance>(soft_block(), soft_tissue());
  return body;
}

TouchOptions ball(double radius, double stiffness = 1e6, contact::Friction friction = {}) {
  return {radius, stiffness, friction};
}

/// Presses slowly straight down onto `over` to a depth. @returns the last contact
contact::Contact press_to(BallTouch& touch, const Vector3d& over, double depth, int ticks = 50) {
  touch.start(over + Vector3d(0.0, 0.001, 0.0));
  contact::Contact last;
  for (int i = 1; i <= ticks; ++i) {
    last = touch.tick(over - Vector3d(0.0, depth * i / ticks, 0.0), kTick);
  }
  return last;
}

Vector3d sum_of(std::span<const VertexForce> forces) {
  Vector3d sum = Vector3d::Zero();
  for (const VertexForce& each : forces) {
    sum += each.force.cast<double>();
  }
  return sum;
}

LoadCase load_of(const HapticMesh& mesh, std::span<const VertexForce> forces) {
  LoadCase load;
  load.name = "touch";
  for (std::size_t v = 0; v < mesh.held.size(); ++v) {
    if (mesh.held[v] != 0) {
      load.holds.push_back({static_cast<std::int32_t>(v), Vector3d::Zero()});
    }
  }
  for (const VertexForce& each : forces) {
    load.forces.push_back({each.vertex, each.force.cast<double>()});
  }
  return load;
}

/// A ball that is pressed deeply into a block of a tissue, as another touch adopts it.
class AdoptedTouchTest : public testing::Test {
 protected:
  static SharedCompliance block_of(double young) {
    Tissue tissue = soft_tissue();
    tissue.young = young;
    static const SharedHapticMesh mesh = soft_block(6);
    return std::make_shared<const Compliance>(mesh, tissue);
  }
  static constexpr double kDepth = 0.006;
  const Vector3d over_{0.0013, kTop + 0.006, 0.0007};
  const Vector3d tool_{over_ - Vector3d(0.0, kDepth, 0.0)};
  const SharedCompliance soft_{block_of(20e3)};
};

TEST_F(AdoptedTouchTest, ATouchOfTheSameBodyGoesOn) {
  BallTouch first(soft_, ball(0.006, 5000.0, {0.5, 0.4}));
  BallTouch next(soft_, ball(0.006, 5000.0, {0.5, 0.4}));
  press_to(first, over_, kDepth, 200);
  next.adopt(first, tool_);
  for (int i = 0; i < 100; ++i) {
    const Vector3d tool = tool_ + Vector3d(1e-5 * i, 1e-6 * i, 0.0);
    const Vector3d felt = first.tick(tool, kTick).force;
    ASSERT_GT(felt.y(), 1.0) << i;
    ASSERT_LT((next.tick(tool, kTick).force - felt).norm(), 1e-9) << i;
  }
}

TEST_F(AdoptedTouchTest, ATouchOfAFirmerTissueIsAtOnceWhatASlowPressFeels) {
  const SharedCompliance firm = block_of(26e3);
  BallTouch first(soft_, ball(0.006, 5000.0));
  BallTouch next(firm, ball(0.006, 5000.0));
  BallTouch slow(firm, ball(0.006, 5000.0));
  press_to(first, over_, kDepth, 200);
  const Vector3d expected = press_to(slow, over_, kDepth, 200).force;
  next.adopt(first, tool_);
  for (int i = 0; i < 20; ++i) {
    ASSERT_LT((next.tick(tool_, kTick).force - expected).norm(), 0.01 * expected.norm()) << i;
  }
}

TEST_F(AdoptedTouchTest, ATouchFromAnotherPlaceStarts) {
  BallTouch first(soft_, ball(0.006, 5000.0));
  BallTouch next(soft_, ball(0.006, 5000.0));
  press_to(first, over_, kDepth, 200);
  const Vector3d away = over_ + Vector3d(0.0, 0.001, 0.0);
  next.adopt(first, away);
  EXPECT_EQ(next.tick(away, kTick).force.norm(), 0.0);
}

TEST(BallTouchTest, WhatIsFeltIsWhatTheBodyGets) {
  BallTouch touch(soft_body(), ball(0.006, 5000.0, {0.5, 0.4}));
  Vector3d hand(0.001, kTop + 0.006, -0.002);
  touch.start(hand);
  for (int i = 0; i < 600; ++i) {
    hand += Vector3d(i < 300 ? 0.0 : 2e-5, i < 300 ? -1e-5 : 0.0, i < 450 ? 0.0 : -1e-5);
    const contact::Contact& felt = touch.tick(hand, kTick);
    EXPECT_LT((felt.force + sum_of(touch.forces())).norm(), 1e-6 * felt.force.norm() + 1e-12) << i;
  }
  EXPECT_EQ(touch.counts().unsettled, 0u);
  EXPECT_EQ(touch.counts().crowded, 0u);
  EXPECT_GT(touch.counts().contact, 550u);
}

/// The forces of the touch go into the elements' own statics. There the surface must lie on the
/// ball where it is pressed and nowhere inside of it: then the stiffness felt is the elements'.
TEST(BallTouchTest, TheElementsUnderItsForcesTouchTheBallAndNothingMore) {
  for (const double radius : {0.005, 0.008, 0.012}) {
    BallTouch touch(soft_body(), ball(radius));
    const Vector3d over(0.0013, kTop + radius, 0.0007);
    const contact::Contact felt = press_to(touch, over, 0.0015);
    const HapticMesh& mesh = soft_body()->mesh();
    const ElasticBody body(mesh.tets, elasticity_of(mesh, soft_tissue()));
    const StaticResult rest = solve_static(body, load_of(mesh, touch.forces()));
    double least = 1.0;
    for (const Face& face : mesh.felt) {
      std::array<Vector3d, 3> corner;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto at = static_cast<std::size_t>(face[k]);
        corner[k] = mesh.tets.vertices[at] + rest.displacement[at];
      }
      constexpr int kSteps = 12;
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; i + j <= kSteps; ++j) {
          const Vector3d p =
              (i * corner[0] + j * corner[1] + (kSteps - i - j) * corner[2]) / kSteps;
          least = std::min(least, (p - felt.proxy).norm() - radius);
        }
      }
    }
    // Between samples, a fifth of the radius apart at most, a ball is in by half of their distance
    // squared over 4 radii: a twentieth of the depth, 1.5 mm.
    EXPECT_GT(least, -9e-5) << radius;
    EXPECT_LT(least, 1e-6) << radius;
    EXPECT_EQ(touch.counts().inverted, 0u);
  }
}

constexpr double kFine = 0.00035;  // cells in the middle of the thick layer [m]

/// A layer that is thick beside what presses it, on a plate.
SharedCompliance thick_layer(double poisson) {
  static const auto make = [](double nu) {
    return std::make_shared<const Compliance>(half_space(kFine), Tissue{20e3, nu, 1000.0, {}});
  };
  static const SharedCompliance soft = make(0.3);
  static const SharedCompliance stiff = make(0.45);
  return poisson < 0.4 ? soft : stiff;
}

/// How much a plate below a layer of thickness H takes off Boussinesq's 1 / r, times H
/// (Dimitriadis et al. 2002, Biophys. J. 82, 2798, bonded layer).
double plate(double nu) { return (1.2876 - 1.4678 * nu + 1.3442 * nu * nu) / (1.0 - nu); }

/// Hertz 1882: a rigid ball on a half space, F = 4/3 E* sqrt(R) d^1.5; on a layer it is stiffer by
/// 1 + 2 a x / pi + (2 a x / pi)², x = sqrt(R d) / H, a = plate() (Dimitriadis, second order).
/// @returns what is felt over that
double over_hertz(double poisson, double radius, double depth) {
  const double thickness = thick_layer(poisson)->mesh().box.sizes().y();
  BallTouch touch(thick_layer(poisson), ball(radius));
  const double felt = press_to(touch, {0.0, radius, 0.0}, depth).force.y();
  EXPECT_EQ(touch.counts().inverted, 0u);
  const double modulus = 20e3 / (1.0 - poisson * poisson);
  const double hertz = 4.0 / 3.0 * modulus * std::sqrt(radius) * std::pow(depth, 1.5);
  const double x = 2.0 / std::numbers::pi * plate(poisson) * std::sqrt(radius * depth) / thickness;
  const double ratio = felt / (hertz * (1.0 + x + x * x));
  std::printf("nu %.2f, radius %.0f mm, depth %.2f mm: %.4f N, over Hertz on a layer %.3f\n",
              poisson, 1e3 * radius, 1e3 * depth, felt, ratio);
  return ratio;
}

TEST(BallTouchTest, ASmallBallOnAThickLayerFollowsHertz) {
  for (const double poisson : {0.3, 0.45}) {
    for (const double depth : {0.0003, 0.0004, 0.0005}) {
      EXPECT_NEAR(over_hertz(poisson, 0.005, depth), 1.0, poisson > 0.4 ? 0.05 : 0.08) << depth;
    }
  }
}

/// Hertz takes slopes as small. The same contact under a ball eight times as large, where they are:
/// what the tissue's Poisson's ratio made is gone, and what the cells make is left.
TEST(BallTouchTest, WhereSlopesAreSmallHertzHoldsForEveryPoissonsRatio) {
  for (const double depth : {0.0000375, 0.00005}) {
    const double soft = over_hertz(0.3, 0.040, depth);
    const double stiff = over_hertz(0.45, 0.040, depth);
    EXPECT_NEAR(soft, 1.0, 0.06);
    EXPECT_NEAR(stiff, 1.0, 0.06);
    EXPECT_NEAR(soft, stiff, 0.01);
  }
}

/// Boussinesq 1885: a small load's displacement along it at a distance r, F (1 - nu²) / (pi E r).
/// Load and displacement are spread over 3 x 3 vertices, 1 : 2 : 1 either way, which adds
/// (fine / r)² / 2.
TEST(BallTouchTest, AwayFromASmallLoadTheSurfaceFollowsBoussinesq) {
  for (const double poisson : {0.3, 0.45}) {
    const Compliance& body = *thick_layer(poisson);
    const auto at = [&](int i, int k) {
      for (std::size_t p = 0; p < body.touched(); ++p) {
        const auto place = static_cast<std::int32_t>(p);
        if ((body.rest(place) - kFine * Vector3d(i, 0.0, k)).norm() < 1e-9) {
          return place;
        }
      }
      return -1;
    };
    const auto spread = [](int i, int k) {
      return (2.0 - std::abs(i)) * (2.0 - std::abs(k)) / 16.0;
    };
    const auto u = [&](int away) {
      double sum = 0.0;
      for (int a = 0; a < 81; ++a) {
        const int i = a % 3 - 1, k = a / 3 % 3 - 1, x = a / 9 % 3 - 1, z = a / 27 - 1;
        const double both = spread(i, k) * spread(x, z);
        sum += both * body.response(at(away + i, k), at(x, z), {0.0F, -1.0F, 0.0F}).y();
      }
      return -sum;
    };
    const double scale = (1.0 - poisson * poisson) / (std::numbers::pi * 20e3);
    for (const int away : {3, 4}) {
      const double r = away * kFine;
      const double spread_over = 1.0 + 0.5 / (away * away);
      const double exact = scale * (spread_over / r - plate(poisson) / body.mesh().box.sizes().y());
      std::printf("nu %.2f, %.2f mm away: ratio %.3f\n", poisson, 1e3 * r, u(away) / exact);
      EXPECT_NEAR(u(away) / exact, 1.0, 0.05) << poisson << " " << r;
    }
  }
}

/// Work of the force, held over each tick, on closed paths of a hand, with the damping of the
/// bound.
TEST(BallTouchTest, AClosedPathGivesNoEnergy) {
  for (const double mu : {0.0, 0.5}) {
    const double spring = 2000.0;
    BallTouch touch(soft_body(), ball(0.007, spring, {mu, 0.8 * mu}));
    const double stiffest = stiffest_touch(*soft_body(), 0.007);
    const double k = (mu > 0.0 ? 2.0 : 1.0) / (1.0 / spring + 1.0 / stiffest);
    const double damping = 0.5 * k * kTick;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      RandomStream random(seed, "path");
      const Vector3d start(0.0, kTop + 0.0075, 0.0);
      std::array<double, 6> amplitude{}, phase{};
      for (std::size_t i = 0; i < 6; ++i) {
        amplitude[i] = random.uniform();
        phase[i] = 2.0 * std::numbers::pi * random.uniform();
      }
      constexpr int kTicks = 1000;
      const auto at = [&](int i) {
        const double t = 2.0 * std::numbers::pi * i / kTicks;
        const double down = 0.5 - 0.5 * std::cos(t);
        return Vector3d(start +
                        Vector3d(0.006 * amplitude[0] * std::sin(2.0 * t + phase[0]) * down,
                                 -0.0025 * down * (1.0 + 0.2 * std::sin(5.0 * t + phase[1])),
                                 0.006 * amplitude[1] * std::sin(3.0 * t + phase[2]) * down));
      };
      touch.start(at(0));
      double work = 0.0;
      Vector3d held = Vector3d::Zero();
      for (int i = 1; i <= kTicks; ++i) {
        const Vector3d way = at(i) - at(i - 1);
        work += held.dot(way) - damping * way.squaredNorm() / kTick;
        held = touch.tick(at(i), kTick).force;
      }
      EXPECT_EQ(touch.counts().inverted, 0u);
      EXPECT_LT(work, 0.0) << mu << " " << seed;
      EXPECT_EQ(held.norm(), 0.0) << "the path is closed";
    }
  }
}

/// A pass may begin with the hand there.
TEST(BallTouchTest, ABallWhoseCentreIsOnTheSurfaceIsFeltFromTheFirstTick) {
  const auto first_force = [](double depth) {
    BallTouch touch(soft_body(), ball(0.006, 5000.0));
    const Vector3d tool(0.0, kTop - depth, 0.0);
    touch.start(tool);
    return touch.tick(tool, kTick).force;
  };
  const Vector3d inside = first_force(1e-5);
  EXPECT_GT(inside.y(), 1.0);
  EXPECT_LT((first_force(0.0) - inside).norm(), 0.05 * inside.norm());
}

/// A ball deep in a block of few cells, whose places are found anew now and then.
TEST(BallTouchTest, AStrokeMakesNoBlows) {
  constexpr double kSpring = 540.0;
  const auto body = std::make_shared<const Compliance>(soft_block(8), soft_tissue());
  BallTouch touch(body, {0.0, kSpring, {}});
  double largest = 0.0;
  for (const double depth : {0.004, 0.006, 0.008}) {
    Vector3d tool(0.0003, kTop + 0.008, 0.0);
    touch.start(tool);
    Vector3d before = Vector3d::Zero();
    for (int i = 0; i < 4000; ++i) {
      const double pressed = std::min(1.0, i / 1000.0);
      const Vector3d next(0.0003, kTop + 0.008 - (0.008 + depth) * pressed,
                          0.014 * std::sin(2.0 * std::numbers::pi * 1e-3 * i) * pressed);
      const Vector3d force = touch.tick(next, kTick).force;
      const double allowed = kSpring * (next - tool).norm() + kFastestAtRest * kTick;
      ASSERT_LE((force - before).norm(), allowed + 1e-9) << i;
      largest = std::max(largest, force.norm());
      before = force;
      tool = next;
    }
    const Vector3d away = tool + Vector3d(0.0, 0.05, 0.0);
    touch.tick(away, kTick);
    for (int i = 0; i < 200; ++i) {
      before = touch.tick(away, kTick).force;
    }
    EXPECT_EQ(before.norm(), 0.0) << "the rest of a lost contact goes";
  }
  EXPECT_GT(largest, 1.0);
}

TEST(BallTouchTest, FrictionHoldsUpToItsBoundAndThenSlips) {
  const double mu = 0.4;
  BallTouch touch(soft_body(), ball(0.007, 3000.0, {mu, 0.3}));
  const Vector3d down(0.0, kTop + 0.0055, 0.0);
  press_to(touch, down, 0.0005, 200);
  bool stuck = false;
  for (int i = 1; i <= 3000; ++i) {
    const Vector3d hand = down + Vector3d(1e-6 * i, -0.0005, 0.0);
    const contact::Contact& felt = touch.tick(hand, kTick);
    const double normal = felt.force.dot(felt.normal);
    const double across = (felt.force - normal * felt.normal).norm();
    EXPECT_LT(across, mu * normal * 1.05);
    if (felt.state == contact::ContactState::kStick) {
      stuck = stuck || i > 100;
    } else {
      EXPECT_TRUE(stuck);
      EXPECT_NEAR(across / normal, 0.3, 0.03);
      return;
    }
  }
  FAIL() << "never slipped";
}

/// A tool that goes deeper than the elements can follow: it is counted, and the force stays.
TEST(BallTouchTest, NoTetrahedronIsTurnedInsideOutSilently) {
  BallTouch touch(soft_body(), ball(0.002));
  double most = 0.0;
  double first = 0.0;
  const Vector3d over(0.0, kTop + 0.002, 0.0);
  touch.start(over);
  for (int i = 1; i <= 800; ++i) {
    const double force = touch.tick(over - Vector3d(0.0, 1e-5 * i, 0.0), kTick).force.norm();
    most = std::max(most, force);
    first = touch.counts().inverted == 0 ? force : first;
  }
  EXPECT_GT(touch.counts().inverted, 0u);
  EXPECT_GT(first, 0.05);
  EXPECT_LT(most, 1.3 * first);
}

/// Cells that are small beside the ball: it lies on more of them than are computed, which is told.
TEST(BallTouchTest, ACostIsMeasuredAndACrowdedContactTold) {
  const TouchCost cost = measured_cost(soft_body(), ball(0.005));
  EXPECT_GT(cost.median, 0.0);
  EXPECT_LE(cost.median, cost.most);
  EXPECT_FALSE(cost.crowded);
  FeltSides sides;
  sides.felt = {BodySide::kTop};
  const auto fine = std::make_shared<const HapticMesh>(
      felt_block({0.006, 0.003, 0.006}, 10, sides, "fine block"));
  EXPECT_TRUE(
      measured_cost(std::make_shared<const Compliance>(fine, soft_tissue()), ball(0.005)).crowded);
}

TEST(BallTouchTest, ATickDoesNotAllocate) {
  BallTouch touch(soft_body(), ball(0.007, 5000.0, {0.5, 0.4}));
  touch.start({0.0, kTop + 0.008, 0.0});
  const test::AllocationGuard guard;
  for (int i = 0; i < 500; ++i) {
    touch.tick({1e-5 * i, kTop + 0.008 - 1e-5 * i, 0.0}, kTick);
  }
  EXPECT_EQ(guard.count(), 0);
  EXPECT_GT(touch.counts().contact, 300u);
}

/// The recorded tool gives the same body to the bit.
TEST(BallTouchTest, TheSameToolGivesTheSameForcesToTheBit) {
  const auto again = std::make_shared<const Compliance>(soft_block(), soft_tissue());
  BallTouch first(soft_body(), ball(0.007, 5000.0, {0.5, 0.4}));
  BallTouch second(again, ball(0.007, 5000.0, {0.5, 0.4}));
  first.start({0.0, kTop + 0.008, 0.0});
  second.start({0.0, kTop + 0.008, 0.0});
  for (int i = 0; i < 400; ++i) {
    const Vector3d tool(2e-5 * i, kTop + 0.008 - 1e-5 * i, 1e-5 * std::sin(0.1 * i));
    EXPECT_EQ(first.tick(tool, kTick).force, second.tick(tool, kTick).force) << i;
    ASSERT_EQ(first.forces().size(), second.forces().size());
    for (std::size_t k = 0; k < first.forces().size(); ++k) {
      EXPECT_EQ(first.forces()[k].vertex, second.forces()[k].vertex);
      EXPECT_EQ(first.forces()[k].force, second.forces()[k].force);
    }
  }
}

TEST(BallTouchTest, AToolThatIsNotFiniteFeelsNothing) {
  BallTouch touch(soft_body(), ball(0.007));
  press_to(touch, {0.0, kTop + 0.007, 0.0}, 0.001);
  EXPECT_EQ(touch.tick({std::nan(""), 0.0, 0.0}, kTick).force.norm(), 0.0);
  EXPECT_TRUE(touch.forces().empty());
  EXPECT_GT(touch.tick({0.0, kTop + 0.006, 0.0}, kTick).force.y(), 0.0);
}

/// A hard inclusion is felt over it more than beside it, and more the nearer it lies.
TEST(BallTouchTest, AnInclusionIsFeltWhereItLies) {
  double last = 1.0;
  for (const double depth : {0.006, 0.003, 0.001}) {
    Tissue tissue = soft_tissue();
    tissue.inclusions = {{"lump", {0.01, kTop - depth - 0.005, 0.01}, 0.005, 300e3}};
    const auto body = std::make_shared<const Compliance>(soft_block(), tissue);
    BallTouch touch(body, ball(0.005));
    const double over = press_to(touch, {0.01, kTop + 0.005, 0.01}, 0.001).force.y();
    const double beside = press_to(touch, {-0.01, kTop + 0.005, -0.01}, 0.001).force.y();
    EXPECT_GT(over / beside, last) << depth;
    last = over / beside;
  }
  EXPECT_GT(last, 1.5);
}

}  // namespace
}  // namespace haptrial::deformable::ball_touch_test
