#include "core/deformable/elements/static_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/support/jittered_block.h"
#include "tests/support/message_of.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using geometry::TetMesh;

/// The bottom of a block held, and a force spread over its top.
LoadCase pushed_top(const TetMesh& mesh, const Vector3d& force) {
  LoadCase load{"push", {}, {}};
  double top = 0;
  for (const Vector3d& x : mesh.vertices) {
    top = std::max(top, x.z());
  }
  std::vector<std::int32_t> above;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    if (mesh.vertices[v].z() < 1e-9) {
      load.holds.push_back({vertex, Vector3d::Zero()});
    }
    if (mesh.vertices[v].z() > top - 1e-9) {
      above.push_back(vertex);
    }
  }
  for (const std::int32_t v : above) {
    load.forces.push_back({v, force / static_cast<double>(above.size())});
  }
  return load;
}

double farthest_apart(const Vectors& a, const Vectors& b) {
  double farthest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    farthest = std::max(farthest, (a[i] - b[i]).norm());
  }
  return farthest;
}

class StaticSolverTest : public testing::Test {
 protected:
  ElasticBody body(Law law, double poisson = 0.3) const {
    return ElasticBody(mesh_, Elasticity{{{1e4, poisson, 1000}}, {}, law});
  }
  TetMesh mesh_ = test::solid_block({3, 3, 4}, 0.01);
};

TEST_F(StaticSolverTest, BothSolversAgree) {
  for (const Law law : {Law::kLinear, Law::kCorotational, Law::kNeoHookean}) {
    for (const double poisson : {0.3, 0.499}) {
      const ElasticBody b = body(law, poisson);
      const LoadCase load = pushed_top(mesh_, {0.2, 0.1, -0.3});
      const StaticResult one =
          solve_static(b, load, {.tolerance = 1e-10, .solver = LinearSolver::kConjugateGradients});
      const StaticResult two =
          solve_static(b, load, {.tolerance = 1e-10, .solver = LinearSolver::kCholesky});
      EXPECT_LE(farthest_apart(one.displacement, two.displacement), 1e-10) << name_of(law);
      EXPECT_LE(one.residual, 1e-10);
    }
  }
}

TEST_F(StaticSolverTest, ReactionsBalanceTheLoad) {
  const Vector3d force(0.2, 0.1, -0.3);
  const StaticResult result = solve_static(body(Law::kNeoHookean), pushed_top(mesh_, force));
  Vector3d reaction = Vector3d::Zero();
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
    if (mesh_.vertices[v].z() < 1e-9) {
      reaction -= result.elastic_force[v];
    }
  }
  EXPECT_LE((reaction + force).norm(), 1e-8);
}

TEST_F(StaticSolverTest, ASmallLoadMovesEveryLawTheSame) {
  const LoadCase load = pushed_top(mesh_, {2e-6, 1e-6, -3e-6});
  const StaticResult linear = solve_static(body(Law::kLinear), load);
  for (const Law law : {Law::kCorotational, Law::kNeoHookean}) {
    const StaticResult result = solve_static(body(law), load);
    EXPECT_LE(farthest_apart(result.displacement, linear.displacement), 1e-12);
    EXPECT_GT(farthest_apart(linear.displacement, Vectors(mesh_.vertices.size(), Vector3d::Zero())),
              5e-8);
  }
}

TEST_F(StaticSolverTest, AHalfTurnOfTheTopIsReached) {
  // The top turns by 120 degrees; moved at once it would invert tetrahedra.
  LoadCase load{"twist", {}, {}};
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2.0944, Vector3d::UnitZ()).toRotationMatrix() - Eigen::Matrix3d::Identity();
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
    const Vector3d x = mesh_.vertices[v] - Vector3d(0.015, 0.015, 0);
    const auto vertex = static_cast<std::int32_t>(v);
    if (x.z() < 1e-9) {
      load.holds.push_back({vertex, Vector3d::Zero()});
    }
    if (x.z() > 0.04 - 1e-9) {
      load.holds.push_back({vertex, turn * x});
    }
  }
  const ElasticBody b = body(Law::kNeoHookean);
  const StaticResult result = solve_static(b, load);
  EXPECT_LE(result.residual, 1e-8);
  EXPECT_GT(result.load_steps, 1);
  EXPECT_EQ(b.inverted(result.displacement), -1);
}

TEST_F(StaticSolverTest, ALoadThatTearsTheMeshIsNamed) {
  const ElasticBody b = body(Law::kNeoHookean);
  LoadCase load = pushed_top(mesh_, {0, 0, 0});
  load.name = "pull";
  load.forces = {{static_cast<std::int32_t>(mesh_.vertices.size() - 1), {300, 200, 400}}};
  const std::string message = test::message_of([&] { solve_static(b, load); });
  EXPECT_TRUE(
      message.starts_with("load 'pull' tears or inverts the body: there is no balance "
                          "beyond"))
      << message;
  EXPECT_NE(message.find("tetrahedron"), std::string::npos) << message;
}

TEST_F(StaticSolverTest, ALoadThatInvertsByTheLinearLawIsNamed) {
  const std::string message = test::message_of([&] {
    solve_static(body(Law::kLinear), pushed_top(mesh_, {0, 0, -100}));
  });
  EXPECT_TRUE(message.starts_with("load 'push' inverts tetrahedron")) << message;
}

TEST_F(StaticSolverTest, WhatNothingHoldsIsRefused) {
  LoadCase load = pushed_top(mesh_, {0, 0, -1});
  load.holds.clear();
  EXPECT_NE(test::message_of([&] { solve_static(body(Law::kLinear), load); }).find("nothing holds"),
            std::string::npos);
}

TEST_F(StaticSolverTest, AHardPartMovesLess) {
  // Source: Morris 2006, §5.3.6: 50 and 1,000 kPa; the load is absorbed by the soft part.
  Elasticity elasticity{{{5e4, 0.45, 1000}, {1e6, 0.45, 1000}}, {}, Law::kLinear};
  for (const auto& t : mesh_.tetrahedra) {
    double middle = 0;
    for (const std::int32_t v : t) {
      middle += mesh_.vertices[static_cast<std::size_t>(v)].z() / 4;
    }
    elasticity.material_of.push_back(middle < 0.02 ? 1 : 0);
  }
  const StaticResult result =
      solve_static(ElasticBody(mesh_, elasticity), pushed_top(mesh_, {1, 0, 0}));
  double hard = 0;
  double soft = 0;
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
    const double moved = result.displacement[v].norm();
    (mesh_.vertices[v].z() < 0.0201 ? hard : soft) =
        std::max(moved, mesh_.vertices[v].z() < 0.0201 ? hard : soft);
  }
  EXPECT_GT(soft, 10 * hard);
}

TEST_F(StaticSolverTest, ASolverServesManyLoads) {
  const ElasticBody b = body(Law::kNeoHookean);
  StaticSolver solver(b);
  const LoadCase first = pushed_top(mesh_, {0.2, 0, 0});
  const LoadCase second = pushed_top(mesh_, {0, 0.2, 0});
  const Vectors alone = solve_static(b, first).displacement;
  solver.solve(second);
  EXPECT_EQ(farthest_apart(solver.solve(first).displacement, alone), 0);
}

}  // namespace
}  // namespace haptrial::deformable
