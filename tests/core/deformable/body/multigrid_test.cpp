#include "core/deformable/body/multigrid.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "core/deformable/body/lattice_levels.h"
#include "core/deformable/elements/static_solver.h"
#include "tests/support/jittered_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

/// A block's stiffness, its lowest layer held.
class MultigridTest : public testing::Test {
 protected:
  void SetUp() override {
    Vectors forces;
    body_.stiffness(Vectors(size(), Vector3d::Zero()), forces, matrix_);
    for (std::size_t v = 0; v < size(); ++v) {
      held_[v] = body_.mesh().vertices[v].z() < 1e-9;
    }
  }

  std::size_t size() const { return body_.mesh().vertices.size(); }

  Vectors random_vector(std::uint64_t seed) const {
    RandomStream random(seed, "vector");
    Vectors v(size(), Vector3d::Zero());
    for (std::size_t i = 0; i < size(); ++i) {
      for (int a = 0; a < 3; ++a) {
        v[i][a] = held_[i] != 0 ? 0 : random.uniform() - 0.5;
      }
    }
    return v;
  }

  static double dot(const Vectors& a, const Vectors& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      sum += a[i].dot(b[i]);
    }
    return sum;
  }

  ElasticBody body_{test::solid_block({7, 6, 5}, 0.01), Elasticity{{{1e4, 0.3, 1000}}}};
  BlockMatrix matrix_{body_.patches().groups(), size()};
  std::vector<std::uint8_t> held_ = std::vector<std::uint8_t>(size(), 0);
};

TEST_F(MultigridTest, IsSymmetricAndPositive) {
  Multigrid grid(body_.mesh().vertices, matrix_, held_);
  ASSERT_TRUE(grid.fits());
  ASSERT_TRUE(grid.set(matrix_));
  const Vectors a = random_vector(1);
  const Vectors b = random_vector(2);
  Vectors za, zb;
  grid.apply(a, za);
  grid.apply(b, zb);
  EXPECT_NEAR(dot(a, zb), dot(b, za), 1e-12 * std::sqrt(dot(a, za) * dot(b, zb)));
  EXPECT_GT(dot(a, za), 0);
  for (std::size_t v = 0; v < size(); ++v) {
    if (held_[v] != 0) {
      EXPECT_EQ(za[v], Vector3d::Zero());
    }
  }
}

TEST_F(MultigridTest, TheCoarseMatrixIsTheProjectedOne) {
  const auto points = lattice_points(body_.mesh().vertices, matrix_);
  ASSERT_TRUE(points);
  CoarseLattice coarse(*points, held_);
  coarse.project(matrix_);
  RandomStream random(3, "coarse");
  Vectors x(coarse.points().size());
  for (Vector3d& v : x) {
    v = {random.uniform(), random.uniform(), random.uniform()};
  }
  Vectors expected, fine(size(), Vector3d::Zero()), product(size()), got(x.size());
  coarse.add_to_fine(x, fine);
  matrix_.multiply(fine, product);
  coarse.restrict_to_coarse(product, expected);
  coarse.matrix().multiply(x, got);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_LE((got[i] - expected[i]).norm(), 1e-10 * std::sqrt(dot(expected, expected)));
  }
}

TEST_F(MultigridTest, IterationsDoNotGrowWithTheMesh) {
  for (const std::int32_t side : {8, 16}) {
    const auto mesh = test::solid_block({side, side, side}, 0.1 / side);
    LoadCase load{"push", {}, {{static_cast<std::int32_t>(mesh.vertices.size()) - 1, {1, 0, 1}}}};
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      if (mesh.vertices[v].z() < 1e-9) {
        load.holds.push_back({static_cast<std::int32_t>(v), Vector3d::Zero()});
      }
    }
    const ElasticBody body(mesh, Elasticity{{{1e5, 0.3, 1000}}, {}, Law::kLinear});
    EXPECT_LE(solve_static(body, load).linear_iterations, 16) << side;
  }
}

TEST_F(MultigridTest, AMeshThatIsNoLatticeIsToldApart) {
  const auto mesh = test::jittered_block({3, 3, 3}, 0.01, 0.05);
  const ElasticBody body(mesh, Elasticity{{{1e4, 0.3, 1000}}});
  const BlockMatrix matrix(body.patches().groups(), mesh.vertices.size());
  EXPECT_FALSE(lattice_points(mesh.vertices, matrix));
}

TEST_F(MultigridTest, AnIndefiniteMatrixIsSeenOrLeftToTheCaller) {
  Multigrid grid(body_.mesh().vertices, matrix_, held_);
  BlockMatrix negative = matrix_;
  negative.scale_and_add(-1, std::vector<double>(size(), 0.0));
  EXPECT_FALSE(grid.set(negative));
}

}  // namespace
}  // namespace haptrial::deformable
