// SUNDIALS' KINSOL finds the displacements at which forces balance by a method of its own.

#include <gtest/gtest.h>
#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <Eigen/Core>

#include "core/deformable/elements/static_solver.h"
#include "tests/support/jittered_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

struct KinsolProblem {
  const ElasticBody& body;
  const LoadCase& load;
  std::vector<std::int32_t> place;  // of a vertex among the free ones; -1: held
  Vectors force;
  double scale;  // of a force [N]: the unknowns are in units of one

  Vectors displacement(const double* y) const {
    Vectors u(place.size(), Vector3d::Zero());
    for (const Hold& hold : load.holds) {
      u[static_cast<std::size_t>(hold.vertex)] = share * hold.displacement;
    }
    for (std::size_t v = 0; v < u.size(); ++v) {
      if (place[v] >= 0) {
        u[v] = kLength * Eigen::Map<const Vector3d>(y + 3 * place[v]);
      }
    }
    return u;
  }

  static constexpr double kLength = 0.01;  // [m]
  double share{1};
};

int unbalanced(N_Vector y, N_Vector out, void* self) {
  const auto& p = *static_cast<KinsolProblem*>(self);
  Vectors forces;
  if (!std::isfinite(p.body.forces(p.displacement(N_VGetArrayPointer(y)), forces))) {
    return 1;  // KINSOL tries a shorter step
  }
  for (std::size_t v = 0; v < forces.size(); ++v) {
    if (p.place[v] < 0) {
      continue;
    }
    Eigen::Map<Vector3d>(N_VGetArrayPointer(out) + 3 * p.place[v]) =
        (forces[v] + p.share * p.force[v]) / p.scale;
  }
  return 0;
}

Vectors by_kinsol(const ElasticBody& body, const LoadCase& load) {
  const std::size_t n = body.mesh().vertices.size();
  KinsolProblem p{body, load, std::vector<std::int32_t>(n, 0), Vectors(n, Vector3d::Zero()), 1};
  for (const Hold& hold : load.holds) {
    p.place[static_cast<std::size_t>(hold.vertex)] = -1;
  }
  std::int32_t free = 0;
  for (std::int32_t& place : p.place) {
    if (place >= 0) {
      place = free++;
    }
  }
  for (const NodalForce& f : load.forces) {
    p.force[static_cast<std::size_t>(f.vertex)] += f.force;
  }
  SUNContext context = nullptr;
  SUNContext_Create(nullptr, &context);
  N_Vector y = N_VNew_Serial(3 * free, context);
  N_Vector ones = N_VNew_Serial(3 * free, context);
  N_VConst(0, y);
  N_VConst(1, ones);
  SUNMatrix matrix = SUNDenseMatrix(3 * free, 3 * free, context);
  SUNLinearSolver linear = SUNLinSol_Dense(y, matrix, context);
  void* kinsol = KINCreate(context);
  EXPECT_EQ(KINInit(kinsol, unbalanced, y), KIN_SUCCESS);
  KINSetUserData(kinsol, &p);
  KINSetFuncNormTol(kinsol, 1e-12);
  KINSetScaledStepTol(kinsol, 1e-14);
  KINSetNumMaxIters(kinsol, 200);
  KINSetMaxSetupCalls(kinsol, 1);
  KINSetLinearSolver(kinsol, linear, matrix);
  constexpr int kSteps = 4;
  for (int i = 1; i <= kSteps; ++i) {
    p.share = static_cast<double>(i) / kSteps;
    EXPECT_GE(KINSol(kinsol, y, KIN_LINESEARCH, ones, ones), 0) << i;
  }
  Vectors u = p.displacement(N_VGetArrayPointer(y));
  KINFree(&kinsol);
  SUNLinSolFree(linear);
  SUNMatDestroy(matrix);
  N_VDestroy(y);
  N_VDestroy(ones);
  SUNContext_Free(&context);
  return u;
}

class KinsolTest : public testing::TestWithParam<Law> {};

TEST_P(KinsolTest, StaticsAgreeToOneHundredMillionth) {
  const geometry::TetMesh mesh = test::jittered_block({3, 2, 3}, 0.01, 0.1);
  const ElasticBody body(mesh, Elasticity{{{1e4, 0.45, 1000}}, {}, GetParam()});
  LoadCase load{"bend", {}, {}};
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    if (v < 12) {
      load.holds.push_back({vertex, {0, 0, 0.0005}});
    }
    if (v + 12 >= mesh.vertices.size()) {
      load.forces.push_back({vertex, {0.04, 0.01, -0.02}});
    }
  }
  const StaticResult ours = solve_static(body, load, {.tolerance = 1e-12});
  const Vectors theirs = by_kinsol(body, load);
  double largest = 0;
  double apart = 0;
  for (std::size_t v = 0; v < theirs.size(); ++v) {
    largest = std::max(largest, theirs[v].norm());
    apart = std::max(apart, (theirs[v] - ours.displacement[v]).norm());
  }
  EXPECT_GT(largest, 0.002);  // a large deformation
  EXPECT_LE(apart, 1e-8 * largest);
}

INSTANTIATE_TEST_SUITE_P(Laws, KinsolTest,
                         testing::Values(Law::kLinear, Law::kCorotational, Law::kNeoHookean));

}  // namespace
}  // namespace haptrial::deformable
