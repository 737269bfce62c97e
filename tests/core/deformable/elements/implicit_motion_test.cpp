#include "core/deformable/elements/implicit_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/deformable/elements/static_solver.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable::implicit_motion_test {
namespace {

using Eigen::Vector3d;

constexpr double kSide = 0.03;  // of the block [m]
constexpr double kStep = 0.004;

/// 5 x 5 x 5 cells of soft tissue, the lowest corner at the origin.
const ElasticBody& block(double poisson = 0.45) {
  const auto made = [](double nu) {
    const geometry::TetMesh mesh = test::solid_block({5, 5, 5}, kSide / 5.0);
    Elasticity elasticity;
    elasticity.materials = {{15e3, nu, 1000.0}};
    return ElasticBody(mesh, elasticity);
  };
  static const ElasticBody firm = made(0.45), loose = made(0.3);
  return poisson > 0.4 ? firm : loose;
}

template <class At>
std::vector<std::int32_t> vertices_at(At at) {
  std::vector<std::int32_t> found;
  const auto& vertices = block().mesh().vertices;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (at(vertices[v])) {
      found.push_back(static_cast<std::int32_t>(v));
    }
  }
  return found;
}

std::vector<std::int32_t> bottom() {
  return vertices_at([](const Vector3d& p) { return p.z() < 1e-9; });
}
std::vector<std::int32_t> top() {
  return vertices_at([](const Vector3d& p) { return p.z() > kSide - 1e-9; });
}

ImplicitMotion motion_of(const ElasticBody& body, std::vector<std::int32_t> held,
                         std::vector<std::int32_t> pressed = {}, double decay = 0.0) {
  return ImplicitMotion(std::make_shared<const ImplicitBody>(
      body, ImplicitOptions{kStep, decay, std::move(held), std::move(pressed)}));
}

/// A step with all of its rounds.
void step(ImplicitMotion& motion) {
  motion.step();
  while (motion.refine()) {
  }
}

Vector3d at_rest(std::size_t v) { return block().mesh().vertices[v]; }

/// The kernel without allocations computes what the elements of statics do, in any shape.
TEST(ImplicitMotionTest, ForcesAreThoseOfTheElements) {
  RandomStream random(1, "shape");
  Vectors moved(block().masses().size()), expected;
  PaddedPoints at(moved.size()), forces(moved.size());
  for (std::size_t v = 0; v < moved.size(); ++v) {
    moved[v] = 6e-4 * Vector3d(random.normal(), random.normal(), random.normal());
    at[v] = at_rest(v) + moved[v];
  }
  ASSERT_TRUE(std::isfinite(block().forces(moved, expected)));
  EXPECT_EQ(ElementForces(block()).add(at, forces), 0u);
  double largest = 0.0;
  for (std::size_t v = 0; v < moved.size(); ++v) {
    largest = std::max(largest, expected[v].norm());
  }
  for (std::size_t v = 0; v < moved.size(); ++v) {
    EXPECT_LT((forces[v] - expected[v]).norm(), 1e-12 * largest);
  }
}

/// H is far from the stiffness of the elements, and nothing of it is left at rest: pressed by a
/// fifth and sheared, the body is where Newton's method finds it.
TEST(ImplicitMotionTest, HeldStillItIsTheEquilibriumOfItsElements) {
  for (const double poisson : {0.3, 0.45}) {
    const ElasticBody& body = block(poisson);
    LoadCase load{"pressed", {}, {}};
    std::vector<std::int32_t> held = bottom();
    for (const std::int32_t v : held) {
      load.holds.push_back({v, Vector3d::Zero()});
    }
    const Vector3d way(0.004, 0.0, -0.006);
    for (const std::int32_t v : top()) {
      load.holds.push_back({v, way});
      held.push_back(v);
    }
    ImplicitMotion motion = motion_of(body, held, {}, 10.0);
    for (int i = 1; i <= 400; ++i) {
      for (const std::int32_t v : top()) {
        const auto vertex = static_cast<std::size_t>(v);
        motion.place(vertex, at_rest(vertex) + std::min(1.0, i / 50.0) * way);
      }
      step(motion);
    }
    const StaticResult rest = solve_static(body, load);
    Vector3d force = Vector3d::Zero(), expected = Vector3d::Zero();
    for (const std::int32_t v : top()) {
      force += motion.force(static_cast<std::size_t>(v));
      expected += rest.elastic_force[static_cast<std::size_t>(v)];
    }
    EXPECT_LT((force - expected).norm(), 1e-5 * expected.norm()) << poisson;
    for (std::size_t v = 0; v < motion.vertices(); ++v) {
      EXPECT_LT((motion.position(v) - at_rest(v) - rest.displacement[v]).norm(), 1e-5 * way.norm());
    }
    EXPECT_EQ(motion.inverted(), 0u);
  }
}

/// Newton: forces on a body that nothing holds give it their sum, however far a step's descent is
/// from its end.
TEST(ImplicitMotionTest, AFreeBodyGetsTheMomentumOfTheForces) {
  ImplicitMotion motion = motion_of(block(), {});
  const Vector3d force(0.05, 0.0, 0.02);
  for (const std::int32_t v : top()) {
    motion.set_force(static_cast<std::size_t>(v), force / static_cast<double>(top().size()));
  }
  constexpr int kSteps = 30;
  for (int i = 0; i < kSteps; ++i) {
    step(motion);
  }
  EXPECT_LT((motion.momentum() - kSteps * kStep * force).norm(),
            1e-5 * (kSteps * kStep * force).norm());
}

/// The law of a falling body with drag, which moves as one: v = v0 exp(-2 a t), by backward Euler.
TEST(ImplicitMotionTest, AFreeMotionDiesDownAsItsDecaySays) {
  constexpr double kDecay = 10.0;
  ImplicitMotion motion = motion_of(block(), {}, {}, kDecay);
  for (std::size_t v = 0; v < motion.vertices(); ++v) {
    motion.set_velocity(v, {0.1, 0.0, 0.0});
  }
  for (int i = 0; i < 50; ++i) {
    step(motion);
  }
  const double expected = 0.1 * std::pow(1.0 + 2.0 * kDecay * kStep, -50);
  EXPECT_NEAR(motion.velocity(0).x(), expected, 1e-4 * expected);
}

/// Left alone after a blow that sets it swinging a body comes to rest. Two rounds take less out of
/// a swing than the step says, so that it swings farther than it should, but not without a bound.
TEST(ImplicitMotionTest, LeftAloneItComesToRest) {
  ImplicitMotion motion = motion_of(block(), bottom());
  for (std::size_t v = 0; v < motion.vertices(); ++v) {
    motion.set_velocity(v, at_rest(v).z() / kSide * Vector3d(0.2, 0.1, -0.1));
  }
  const auto energy = [&] {
    Vectors moved = motion.positions();
    double sum = 0.0;
    for (std::size_t v = 0; v < moved.size(); ++v) {
      moved[v] -= at_rest(v);
      sum += 0.5 * block().masses()[v] * motion.velocity(v).squaredNorm();
    }
    return sum + block().energy(moved);
  };
  const double given = energy();
  for (int i = 0; i < 300; ++i) {
    step(motion);
    EXPECT_LE(energy(), 2.0 * given) << i;
  }
  EXPECT_LT(energy(), 0.01 * given);
}

/// A push moves the body by H⁻¹, which mobility() tells beforehand and which is symmetric.
TEST(ImplicitMotionTest, APushMovesWhatMobilityTells) {
  ImplicitMotion motion = motion_of(block(), bottom(), top());
  const auto pushed = static_cast<std::size_t>(top()[7]),
             other = static_cast<std::size_t>(top()[9]);
  motion.push(pushed, {0.0, 0.0, -0.01});
  motion.finish_pushes();
  for (std::size_t v = 0; v < motion.vertices(); ++v) {
    EXPECT_NEAR(motion.position(v).z() - at_rest(v).z(), -0.01 * motion.mobility(v, pushed), 1e-15);
  }
  EXPECT_NEAR(motion.mobility(other, pushed), motion.mobility(pushed, other),
              1e-5 * motion.mobility(pushed, pushed));
  EXPECT_EQ(motion.mobility(0, pushed), 0.0) << "it is held";
}

TEST(ImplicitMotionTest, AStepDoesNotAllocate) {
  ImplicitMotion motion = motion_of(block(), bottom(), top());
  const auto pushed = static_cast<std::size_t>(top()[7]);
  const test::AllocationGuard guard;
  for (int i = 0; i < 2; ++i) {
    step(motion);
    motion.push(pushed, {0.0, 0.0, -0.01});
    motion.finish_pushes();
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(ImplicitMotionTest, WhatIsNotAllowedIsRefused) {
  EXPECT_THROW(ImplicitBody(block(), {.step = 0.0}), InputError);
  EXPECT_THROW(ImplicitBody(block(), {.decay = -1.0}), InputError);
  EXPECT_THROW(ImplicitBody(block(), {.held = {100000}}), InputError);
}

}  // namespace
}  // namespace haptrial::deformable::implicit_motion_test
