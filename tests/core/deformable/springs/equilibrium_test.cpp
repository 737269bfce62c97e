#include "core/deformable/springs/equilibrium.h"

#include <gtest/gtest.h>
#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <cmath>

#include "core/deformable/springs/spring_motion.h"
#include "core/deformable/springs/spring_tangent.h"
#include "tests/support/message_of.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable::equilibrium_test {
namespace {

using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

/// A block that is held at its bottom and pushed aside and down at its top.
struct Case {
  SpringBody body;
  LoadCase load{"push", {}, {}};
};

Case pushed_block(const std::array<std::int32_t, 3>& cubes, const Vector3d& push) {
  Case c{spring_body(test::solid_block(cubes, 0.01), 1000, {0.02, 0.01, 0.05}), {}};
  c.load.name = "push";
  for (std::size_t v = 0; v < c.body.rest.size(); ++v) {
    const double z = c.body.rest[v].z();
    if (z < 1e-9) {
      c.load.holds.push_back({static_cast<std::int32_t>(v), {0, 0, 0}});
    }
    if (z > 0.01 * cubes[2] - 1e-9) {
      c.load.forces.push_back({static_cast<std::int32_t>(v), push});
    }
  }
  return c;
}

double largest_way(const Positions& a, const Positions& b) {
  double largest = 0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    largest = std::max(largest, (a[v] - b[v]).norm());
  }
  return largest;
}

TEST(EquilibriumTest, BalancesTheLoadWithLittleLeft) {
  const Case c = pushed_block({3, 3, 4}, {0.02, 0, -0.03});
  const Equilibrium found = equilibrium(c.body, c.load);
  ASSERT_EQ(found.outcome, Settling::kSettled);
  EXPECT_LT(found.residual, 1e-10);
  EXPECT_GT(largest_way(found.positions, c.body.rest), 1e-3);
  EXPECT_EQ(found.inverted, 0u);
}

TEST(EquilibriumTest, IsWhereTheDampedMotionComesToRest) {
  const Case c = pushed_block({3, 3, 4}, {0.02, 0, -0.03});
  const Equilibrium found = equilibrium(c.body, c.load);
  ASSERT_EQ(found.outcome, Settling::kSettled);
  const std::vector<std::int32_t> held = held_vertices(c.load);
  SpringMotion motion(c.body, {0.9 * stable_step(c.body, held), 0.01}, held);
  apply(c.load, c.body, motion);
  for (double quiet_since = 0.0; motion.time() - quiet_since < 0.01;) {
    ASSERT_LT(motion.time(), 40.0);
    motion.step();
    quiet_since = motion.activity().below({1e-8, 1e-9, 1e-5, 1e-6}) ? quiet_since : motion.time();
  }
  EXPECT_LT(largest_way(motion.positions(), found.positions),
            1e-6 * largest_way(motion.positions(), c.body.rest));
}

TEST(EquilibriumTest, HeldVerticesMayBeMoved) {
  Case c = pushed_block({2, 2, 4}, {0, 0, 0});
  c.load.forces.clear();
  for (std::size_t v = 0; v < c.body.rest.size(); ++v) {
    if (c.body.rest[v].z() > 0.04 - 1e-9) {
      c.load.holds.push_back({static_cast<std::int32_t>(v), {0.002, 0, -0.006}});
    }
  }
  const Equilibrium found = equilibrium(c.body, c.load);
  ASSERT_EQ(found.outcome, Settling::kSettled);
  const std::size_t top = c.body.rest.size() - 1;
  EXPECT_EQ(found.positions[top], c.body.rest[top] + Vector3d(0.002, 0, -0.006));
}

// SUNDIALS KINSOL solves f(x) = 0 for the same springs, with its own differences for a Jacobian.
struct Kinsol {
  const Case* c;
  std::vector<std::size_t> free;
  Positions at(N_Vector u) const {
    Positions x = c->body.rest;
    for (std::size_t i = 0; i < free.size(); ++i) {
      for (Eigen::Index a = 0; a < 3; ++a) {
        x[free[i]][a] += kLength * NV_Ith_S(u, static_cast<sunindextype>(3 * i) + a);
      }
    }
    return x;
  }
  static int residual(N_Vector u, N_Vector r, void* data) {
    const Kinsol& self = *static_cast<Kinsol*>(data);
    Positions forces = spring_forces(self.c->body, self.at(u));
    for (const NodalForce& nodal : self.c->load.forces) {
      forces[static_cast<std::size_t>(nodal.vertex)] += nodal.force;
    }
    for (std::size_t i = 0; i < self.free.size(); ++i) {
      for (Eigen::Index a = 0; a < 3; ++a) {
        NV_Ith_S(r, static_cast<sunindextype>(3 * i) + a) = forces[self.free[i]][a] / kForce;
      }
    }
    return 0;
  }
  static constexpr double kLength = 1e-3;  // one unit of the unknowns [m]
  static constexpr double kForce = 1e-2;   // one unit of the equations [N]
};

Positions by_kinsol(const Case& c) {
  Kinsol problem{&c, {}};
  std::vector<bool> held(c.body.rest.size(), false);
  for (const Hold& hold : c.load.holds) {
    held[static_cast<std::size_t>(hold.vertex)] = true;
  }
  for (std::size_t v = 0; v < held.size(); ++v) {
    if (!held[v]) {
      problem.free.push_back(v);
    }
  }
  const auto n = static_cast<sunindextype>(3 * problem.free.size());
  SUNContext context = nullptr;
  SUNContext_Create(nullptr, &context);
  N_Vector u = N_VNew_Serial(n, context);
  N_Vector one = N_VNew_Serial(n, context);
  N_VConst(0.0, u);
  N_VConst(1.0, one);
  SUNMatrix matrix = SUNDenseMatrix(n, n, context);
  SUNLinearSolver solver = SUNLinSol_Dense(u, matrix, context);
  void* memory = KINCreate(context);
  EXPECT_EQ(KINInit(memory, Kinsol::residual, u), KIN_SUCCESS);
  KINSetUserData(memory, &problem);
  KINSetLinearSolver(memory, solver, matrix);
  KINSetFuncNormTol(memory, 1e-12);
  KINSetScaledStepTol(memory, 1e-14);
  KINSetMaxNewtonStep(memory, 1e3);
  KINSetMaxSetupCalls(memory, 1);  // a new Jacobian at every step
  EXPECT_GE(KINSol(memory, u, KIN_LINESEARCH, one, one), 0);
  Positions found = problem.at(u);
  KINFree(&memory);
  SUNLinSolFree(solver);
  SUNMatDestroy(matrix);
  N_VDestroy(u);
  N_VDestroy(one);
  SUNContext_Free(&context);
  return found;
}

TEST(EquilibriumTest, KinsolFindsTheSame) {
  const Case c = pushed_block({2, 2, 3}, {0.02, 0.005, -0.03});
  const Equilibrium found = equilibrium(c.body, c.load, {1e-13, 200});
  ASSERT_EQ(found.outcome, Settling::kSettled);
  const double displacement = largest_way(found.positions, c.body.rest);
  ASSERT_GT(displacement, 1e-3);
  EXPECT_LT(largest_way(found.positions, by_kinsol(c)), 1e-8 * displacement);
}

// Straight down on a slender column: the straight state is a saddle beyond the buckling load, and
// minima lie aside.
TEST(EquilibriumTest, AColumnBeyondItsBucklingLoadLeavesTheStraightShape) {
  const auto aside = [](double push) {
    const Case c = pushed_block({1, 1, 10}, {0, 0, -push});
    const Equilibrium found = equilibrium(c.body, c.load);
    EXPECT_EQ(found.outcome, Settling::kSettled)
        << push << " " << found.iterations << " " << found.residual;
    double most = 0;
    for (std::size_t v = 0; v < c.body.rest.size(); ++v) {
      most = std::max(most, (found.positions[v] - c.body.rest[v]).head<2>().norm());
    }
    return most;
  };
  EXPECT_LT(aside(0.01), 0.002);
  EXPECT_GT(aside(0.1), 0.03);
}

// So many vertices that conjugate gradients are taken where they may be.
TEST(EquilibriumTest, ALargeBodyRestsWhereItsForcesAreBalanced) {
  const Case c = pushed_block({13, 13, 13}, {0.02, 0.005, -0.03});
  const Equilibrium found = equilibrium(c.body, c.load);
  ASSERT_EQ(found.outcome, Settling::kSettled);
  EXPECT_GT(largest_way(found.positions, c.body.rest), 1e-3);
  SpringBody body = c.body;
  std::vector<Vector3d> left = spring_forces(body, found.positions);
  for (const NodalForce& nodal : c.load.forces) {
    left[static_cast<std::size_t>(nodal.vertex)] += nodal.force;
  }
  for (const Hold& hold : c.load.holds) {
    left[static_cast<std::size_t>(hold.vertex)].setZero();
  }
  for (const Vector3d& force : left) {
    ASSERT_LT(force.norm(), 1e-11);
  }
}

TEST(EquilibriumTest, TooFewIterationsAreNotInTime) {
  const Case c = pushed_block({3, 3, 4}, {0.02, 0, -0.03});
  EXPECT_EQ(equilibrium(c.body, c.load, {1e-10, 1}).outcome, Settling::kNotInTime);
}

TEST(EquilibriumTest, ABodyThatNothingHoldsIsRefused) {
  Case c = pushed_block({2, 2, 2}, {0, 0, -0.01});
  c.load.holds.clear();
  EXPECT_NE(test::message_of([&] { equilibrium(c.body, c.load); }).find("nothing holds"),
            std::string::npos);
}

}  // namespace
}  // namespace haptrial::deformable::equilibrium_test
