#include "core/deformable/springs/spring_motion.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "core/base/random.h"
#include "core/deformable/springs/spring_hessian.h"
#include "core/deformable/springs/spring_tangent.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/message_of.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

SpringBody small_body() {
  return spring_body(test::solid_block({2, 2, 3}, 0.01), 1000, {0.02, 0.01, 0.05});
}

void push_all(SpringMotion& motion, double speed) {
  RandomStream random(4, "push");
  for (std::size_t v = 0; v < motion.vertices(); ++v) {
    motion.set_velocity(v, speed * Vector3d(random.normal(), random.normal(), random.normal()));
  }
}

double energy(const SpringBody& body, const SpringMotion& motion) {
  return spring_energy(body, motion.positions()) + motion.kinetic_energy();
}

/// The largest eigenvalue of M⁻¹ K at rest, dense.
double largest_eigenvalue(const SpringBody& body) {
  SpringHessian hessian(body);
  hessian.assemble(body, body.rest);
  const auto n = static_cast<Eigen::Index>(body.rest.size());
  Eigen::MatrixXd dense(3 * n, 3 * n);
  for (Eigen::Index column = 0; column < 3 * n; ++column) {
    std::vector<Vector3d> unit(body.rest.size(), Vector3d::Zero());
    unit[static_cast<std::size_t>(column / 3)][column % 3] = 1;
    Vectors forces(unit.size());
    hessian.matrix().multiply(unit, forces);
    for (Eigen::Index row = 0; row < 3 * n; ++row) {
      const auto v = static_cast<std::size_t>(row / 3);
      dense(row, column) =
          forces[v][row % 3] /
          std::sqrt(body.masses[v] * body.masses[static_cast<std::size_t>(column / 3)]);
    }
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues().maxCoeff();
}

TEST(SpringMotionTest, TheStableStepIsJustBelowThatOfTheLargestEigenvalue) {
  const SpringBody body = small_body();
  const double exact = 2 / std::sqrt(largest_eigenvalue(body));
  EXPECT_LT(stable_step(body), exact);
  EXPECT_GT(stable_step(body), 0.99 * exact);
}

TEST(SpringMotionTest, JustBelowTheStableStepSmallMotionsStaySmall) {
  const SpringBody body = small_body();
  SpringMotion motion(body, {0.9999 * stable_step(body)});
  push_all(motion, 1e-6);
  motion.step();
  const double first = energy(body, motion);
  for (int i = 0; i < 100'000; ++i) {
    motion.step();
  }
  EXPECT_LT(energy(body, motion), 100 * first);  // of the fastest vibration Verlet's own is larger
  EXPECT_EQ(motion.inverted_steps(), 0u);
}

TEST(SpringMotionTest, ATenthBeyondTheStableStepTheyGrow) {
  const SpringBody body = small_body();
  SpringMotion motion(body, {1.1 * stable_step(body), 0.0, true});
  push_all(motion, 1e-6);
  double speed = motion.activity().max_speed;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      motion.step();
    }
    EXPECT_GT(motion.activity().max_speed, 3 * speed) << i;
    speed = motion.activity().max_speed;
  }
  for (int i = 0; i < 1000; ++i) {
    motion.step();
  }
  EXPECT_GT(motion.inverted_steps(), 0u);
  EXPECT_FALSE(motion.activity().max_speed < 1e3);  // also where it is not a number any more
}

TEST(SpringMotionTest, AStepBeyondTheStableOneIsRefused) {
  const SpringBody body = small_body();
  const double most = stable_step(body);
  EXPECT_NO_THROW(SpringMotion(body, {most}));
  const std::string message = test::message_of([&] { SpringMotion(body, {1.001 * most}); });
  EXPECT_NE(message.find("is unstable for this body; at most"), std::string::npos) << message;
}

TEST(SpringMotionTest, BadSettingsAreRefused) {
  const SpringBody body = small_body();
  EXPECT_EQ(test::message_of([&] { SpringMotion(body, {0.0}); }),
            "springs: the step is 0 s; above 0 is allowed");
  EXPECT_EQ(test::message_of([&] {
              SpringMotion(body, {1e-5, -1.0});
            }),
            "springs: the damping is -1 N·s/m; at least 0 is allowed");
  const std::vector<std::int32_t> held{36};
  EXPECT_EQ(test::message_of([&] { SpringMotion(body, {1e-5}, held); }),
            "springs: the held vertex 36 is not one of 0 to 35");
}

// A free body keeps its momenta to rounding and its energy within bounds.
TEST(SpringMotionTest, MomentaAndEnergyAreKept) {
  constexpr int kSteps = 200'000;
  const SpringBody body = small_body();
  SpringMotion motion(body, {0.3 * stable_step(body)});
  push_all(motion, 0.02);
  motion.step();
  const Vector3d momentum = motion.momentum();
  const Vector3d angular = motion.angular_momentum();
  double early[2] = {1e300, 0};
  double late[2] = {1e300, 0};
  for (int i = 0; i < kSteps; ++i) {
    motion.step();
    if (i % 50 != 0) {
      continue;
    }
    const double now = energy(body, motion);
    double* range = i < kSteps / 2 ? early : late;
    range[0] = std::min(range[0], now);
    range[1] = std::max(range[1], now);
  }
  EXPECT_EQ(motion.inverted_steps(), 0u);
  EXPECT_LT((motion.momentum() - momentum).norm(), 1e-12 * momentum.norm());
  EXPECT_LT((motion.angular_momentum() - angular).norm(), 1e-11 * angular.norm());
  EXPECT_LT(late[1] - early[0], 0.1 * early[0]);
  EXPECT_LT(late[1], early[1] * 1.01);
  EXPECT_GT(late[0], early[0] * 0.99);
}

// The same motion by what the source prints: momentum comes from nowhere.
TEST(SpringMotionTest, ThePrintedFormsLeakMomentum) {
  const SpringBody body = small_body();
  const double h = 0.3 * stable_step(body);
  RandomStream random(4, "push");
  std::vector<Vector3d> x = body.rest;
  std::vector<Vector3d> v(x.size());
  for (Vector3d& velocity : v) {
    velocity = 0.02 * Vector3d(random.normal(), random.normal(), random.normal());
  }
  const auto momentum = [&] {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < v.size(); ++i) {
      sum += body.masses[i] * v[i];
    }
    return sum;
  };
  const Vector3d before = momentum();
  for (int step = 0; step < 1000; ++step) {
    const std::vector<Vector3d> f = spring_forces(body, x, ForceForm::kPrinted);
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i] += h / body.masses[i] * f[i];
      x[i] += h * v[i];
    }
  }
  EXPECT_GT((momentum() - before).norm(), 1e-3 * before.norm());
}

TEST(SpringMotionTest, AStepDoesNotAllocate) {
  const SpringBody body = small_body();
  const std::vector<std::int32_t> held{0, 1, 2};
  SpringMotion motion(body, {0.5 * stable_step(body), 0.01}, held);
  const test::AllocationGuard guard;
  motion.set_force(7, {0, 0, 1e-3});
  motion.place(0, body.rest[0] + Vector3d(1e-4, 0, 0));
  for (int i = 0; i < 10; ++i) {
    motion.step();
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(SpringMotionTest, HeldVerticesStayAndDampedOnesComeToRest) {
  const SpringBody body = small_body();
  const std::vector<std::int32_t> held{0, 3};
  SpringMotion motion(body, {0.5 * stable_step(body), 0.05}, held);
  push_all(motion, 0.1);
  for (int i = 0; i < 20'000; ++i) {
    motion.step();
  }
  EXPECT_EQ(motion.position(0), body.rest[0]);
  EXPECT_EQ(motion.position(3), body.rest[3]);
  EXPECT_LT(motion.activity().max_speed, 1e-6);
}

// One mass between held ones is an oscillator, whose Verlet frequency and decay are known.
TEST(SpringMotionTest, OneFreeVertexSwingsAsVerletsMethodSays) {
  const SpringBody body = spring_body(test::solid_block({2, 2, 2}, 0.01), 1000, {0.02, 0.01, 0.05});
  const std::size_t middle = 13;
  std::vector<std::int32_t> held;
  for (std::int32_t v = 0; v < 27; ++v) {
    if (v != 13) {
      held.push_back(v);
    }
  }
  SpringHessian hessian(body);
  hessian.assemble(body, body.rest);
  const double k = *hessian.matrix().block(hessian.matrix().row_start(middle));
  const double h = 0.5 * stable_step(body, held);
  const double c = 0.2 * std::sqrt(k * body.masses[middle]);
  SpringMotion motion(body, {h, c}, held);
  constexpr double kSmall = 1e-9;
  motion.place(middle, body.rest[middle] + Vector3d(kSmall, 0, 0));
  // The recurrence (m + ch/2) u₊ = (2m - kh²) u - (m - ch/2) u₋ with u₋ = u at first.
  const double m = body.masses[middle];
  double before = kSmall;
  double now = kSmall;
  for (int i = 0; i < 50; ++i) {
    motion.step();
    const double next = ((2 * m - k * h * h) * now - (m - c * h / 2) * before) / (m + c * h / 2);
    before = now;
    now = next;
    EXPECT_NEAR((motion.position(middle) - body.rest[middle]).x(), now, 1e-5 * kSmall) << i;
  }
}

TEST(SpringMotionTest, InvertedTetrahedraAreCounted) {
  const SpringBody body = small_body();
  SpringMotion motion(body, {0.1 * stable_step(body)});
  motion.step();
  EXPECT_EQ(motion.inverted(), 0u);
  motion.place(0, body.rest[0] + Vector3d(0.03, 0.03, 0.03));
  motion.step();
  EXPECT_GT(motion.inverted(), 0u);
  EXPECT_EQ(motion.inverted_steps(), 1u);
}

}  // namespace
}  // namespace haptrial::deformable
