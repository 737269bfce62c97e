#include "core/deformable/elements/dynamic_solver.h"

#include <cvode/cvode.h>
#include <gtest/gtest.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <Eigen/Core>

#include "tests/support/message_of.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

constexpr double kAlpha = 3;      // [1/s]
constexpr double kBeta = 2e-4;    // [s], for the linear law, whose K does not change
constexpr std::size_t kHeld = 9;  // the lowest layer of vertices

ElasticBody soft_block(Law law) {
  return ElasticBody(test::solid_block({2, 2, 3}, 0.01), Elasticity{{{2e3, 0.4, 1000}}, {}, law});
}

std::vector<Hold> bottom_holds() {
  std::vector<Hold> holds;
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(kHeld); ++v) {
    holds.push_back({v, Vector3d::Zero()});
  }
  return holds;
}

/// A steady push on the top layer.
Vectors top_push(const ElasticBody& body, const Vector3d& force) {
  Vectors out(body.mesh().vertices.size(), Vector3d::Zero());
  for (std::size_t v = out.size() - kHeld; v < out.size(); ++v) {
    out[v] = force / kHeld;
  }
  return out;
}

Vectors after(const ElasticBody& body, const DynamicOptions& options, const Vectors& force,
              double time) {
  DynamicSolver solver(body, bottom_holds(), options);
  while (solver.time() < time - 0.5 * options.step) {
    solver.step(force);
  }
  return solver.motion().displacement;
}

double distance(const Vectors& a, const Vectors& b) {
  double farthest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    farthest = std::max(farthest, (a[i] - b[i]).norm());
  }
  return farthest;
}

struct CvodeProblem {
  const ElasticBody& body;
  const Vectors& force;
  double alpha;
  double beta;
};

int rate(double, N_Vector y, N_Vector dy, void* self) {
  const auto& p = *static_cast<CvodeProblem*>(self);
  const std::size_t n = p.force.size() - kHeld;
  const double* x = N_VGetArrayPointer(y);
  Vectors u(p.force.size(), Vector3d::Zero());
  Vectors v(p.force.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < n; ++i) {
    u[kHeld + i] = Eigen::Map<const Vector3d>(x + 3 * i);
    v[kHeld + i] = Eigen::Map<const Vector3d>(x + 3 * (n + i));
  }
  Vectors elastic;
  Vectors viscous(u.size(), Vector3d::Zero());
  if (!std::isfinite(p.body.forces(u, elastic))) {
    return 1;
  }
  if (p.beta > 0) {
    p.body.forces(v, viscous);  // of the linear law: -K v
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t at = kHeld + i;
    Eigen::Map<Vector3d>(N_VGetArrayPointer(dy) + 3 * i) = v[at];
    Eigen::Map<Vector3d>(N_VGetArrayPointer(dy) + 3 * (n + i)) =
        (p.force[at] + elastic[at] + p.beta * viscous[at]) / p.body.masses()[at] - p.alpha * v[at];
  }
  return 0;
}

Vectors by_cvode(const ElasticBody& body, const Vectors& force, double alpha, double beta,
                 double time) {
  CvodeProblem p{body, force, alpha, beta};
  const auto n = static_cast<sunindextype>(6 * (force.size() - kHeld));
  SUNContext context = nullptr;
  SUNContext_Create(nullptr, &context);
  N_Vector y = N_VNew_Serial(n, context);
  N_VConst(0, y);
  SUNMatrix matrix = SUNDenseMatrix(n, n, context);
  SUNLinearSolver linear = SUNLinSol_Dense(y, matrix, context);
  void* cvode = CVodeCreate(CV_BDF, context);
  CVodeInit(cvode, rate, 0, y);
  CVodeSStolerances(cvode, 1e-10, 1e-12);
  CVodeSetUserData(cvode, &p);
  CVodeSetLinearSolver(cvode, linear, matrix);
  CVodeSetMaxNumSteps(cvode, 1000000);
  double reached = 0;
  EXPECT_EQ(CVode(cvode, time, y, &reached, CV_NORMAL), CV_SUCCESS);
  Vectors u(force.size(), Vector3d::Zero());
  for (std::size_t i = kHeld; i < u.size(); ++i) {
    u[i] = Eigen::Map<const Vector3d>(N_VGetArrayPointer(y) + 3 * (i - kHeld));
  }
  CVodeFree(&cvode);
  SUNLinSolFree(linear);
  SUNMatDestroy(matrix);
  N_VDestroy(y);
  SUNContext_Free(&context);
  return u;
}

class DynamicSolverTest : public testing::TestWithParam<Law> {};

TEST_P(DynamicSolverTest, TheMidpointConvergesToCvodeWithTheSquareOfTheStep) {
  const ElasticBody body = soft_block(GetParam());
  const Vectors force = top_push(body, {0.04, 0.01, -0.06});
  const double beta = GetParam() == Law::kLinear ? kBeta : 0;
  constexpr double kTime = 0.06;
  const Vectors truth = by_cvode(body, force, kAlpha, beta, kTime);
  double largest = 0;
  for (const Vector3d& u : truth) {
    largest = std::max(largest, u.norm());
  }
  EXPECT_GT(largest, 0.002);
  DynamicOptions options{.step = 5e-4, .mass_damping = kAlpha, .stiffness_damping = beta};
  const double coarse = distance(after(body, options, force, kTime), truth);
  options.step = 2.5e-4;
  const double fine = distance(after(body, options, force, kTime), truth);
  EXPECT_LE(fine, 0.005 * largest);
  EXPECT_GT(coarse / fine, 3.3);
  EXPECT_LT(coarse / fine, 4.8);
}

INSTANTIATE_TEST_SUITE_P(Laws, DynamicSolverTest,
                         testing::Values(Law::kLinear, Law::kCorotational, Law::kNeoHookean));

TEST(DynamicEnergyTest, TheMidpointKeepsTheEnergyOfALinearBody) {
  const ElasticBody body = soft_block(Law::kLinear);
  DynamicSolver solver(body, bottom_holds(), {.step = 2e-3, .tolerance = 1e-12});
  Motion start = solver.motion();
  for (std::size_t v = 0; v < start.velocity.size(); ++v) {
    start.velocity[v] = Vector3d(0.2, 0, 0.1) * body.mesh().vertices[v].z() / 0.03;
  }
  solver.set_motion(start);
  const double before = solver.energy();
  const Vectors none(start.velocity.size(), Vector3d::Zero());
  for (int i = 0; i < 2000; ++i) {
    solver.step(none);
  }
  EXPECT_NEAR(solver.energy() / before, 1, 1e-9);
}

TEST(DynamicEnergyTest, TheMidpointHoldsTheEnergyOfANeoHookeanBodyWithinBounds) {
  const ElasticBody body = soft_block(Law::kNeoHookean);
  DynamicSolver solver(body, bottom_holds(), {.step = 5e-4});
  Motion start = solver.motion();
  for (std::size_t v = 0; v < start.velocity.size(); ++v) {
    start.velocity[v] = Vector3d(0.3, 0, 0.1) * body.mesh().vertices[v].z() / 0.03;
  }
  solver.set_motion(start);
  const double before = solver.energy();
  const Vectors none(start.velocity.size(), Vector3d::Zero());
  double low = before, high = before;
  for (int i = 0; i < 1000; ++i) {
    solver.step(none);
    low = std::min(low, solver.energy());
    high = std::max(high, solver.energy());
  }
  EXPECT_GT(low, 0.99 * before);
  EXPECT_LT(high, 1.01 * before);
}

TEST(DynamicOptionsTest, WhatCannotBeIsRefused) {
  const ElasticBody body = soft_block(Law::kLinear);
  const auto refusal = [&](const DynamicOptions& options) {
    return test::message_of([&] { DynamicSolver(body, bottom_holds(), options); });
  };
  EXPECT_EQ(refusal({.step = 0}), "the time step is 0; allowed: above 0 s");
  EXPECT_EQ(refusal({.mass_damping = -1}), "the mass damping is -1; allowed: 0 or more");
  EXPECT_NE(test::message_of([&] { DynamicSolver(body, {}, {}); }).find("nothing holds"),
            std::string::npos);
}

}  // namespace
}  // namespace haptrial::deformable
