#include "core/deformable/springs/spring_forces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <numeric>

#include "core/base/random.h"
#include "core/deformable/springs/force_kernel.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> shaken(const SpringBody& body, double by) {
  RandomStream random(5, "shake");
  std::vector<Vector3d> positions = body.rest;
  for (Vector3d& p : positions) {
    p += by * Vector3d(random.normal(), random.normal(), random.normal());
  }
  return positions;
}

/// Another constant for every spring.
void vary_constants(SpringBody& body) {
  RandomStream random(6, "constants");
  for (auto* list : {&body.constants.length, &body.constants.area, &body.constants.volume}) {
    for (double& k : *list) {
      k = random.uniform(0.1, 2.0);
    }
  }
}

/// A block whose tetrahedra come in a random order, some of them left out.
geometry::TetMesh scattered_block() {
  geometry::TetMesh mesh = test::solid_block({4, 3, 5}, 0.01);
  RandomStream random(7, "scatter");
  for (std::size_t i = mesh.tetrahedra.size() - 1; i > 0; --i) {
    std::swap(mesh.tetrahedra[i], mesh.tetrahedra[random.below(i + 1)]);
  }
  mesh.tetrahedra.resize(mesh.tetrahedra.size() - 37);
  std::vector<std::int32_t> number(mesh.vertices.size(), -1);
  geometry::TetMesh left;
  for (auto t : mesh.tetrahedra) {
    for (std::int32_t& v : t) {
      std::int32_t& n = number[static_cast<std::size_t>(v)];
      if (n < 0) {
        n = static_cast<std::int32_t>(left.vertices.size());
        left.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
      }
      v = n;
    }
    left.tetrahedra.push_back(t);
  }
  return left;
}

void expect_forces_of_every_spring(const geometry::TetMesh& mesh, double by) {
  SpringBody body = spring_body(mesh, 1000, {1, 1, 1});
  vary_constants(body);
  const std::vector<Vector3d> positions = shaken(body, by);
  const std::vector<Vector3d> expected = spring_forces(body, positions);
  const std::vector<Vector3d> found = SpringForces(body).forces(positions);
  double largest = 0;
  for (const Vector3d& f : expected) {
    largest = std::max(largest, f.norm());
  }
  for (std::size_t v = 0; v < found.size(); ++v) {
    EXPECT_LT((found[v] - expected[v]).norm(), 1e-13 * largest) << v;
  }
}

TEST(SpringForcesTest, AreThoseOfEverySpringOnABlock) {
  expect_forces_of_every_spring(test::solid_block({5, 4, 3}, 0.01), 1e-3);
}

TEST(SpringForcesTest, AreThoseOfEverySpringOnATornAndShuffledMesh) {
  expect_forces_of_every_spring(scattered_block(), 1e-3);
}

TEST(SpringForcesTest, AreThoseOfEverySpringWhereTheBodyIsCrushed) {
  expect_forces_of_every_spring(test::solid_block({3, 3, 3}, 0.01), 1e-2);
}

TEST(SpringForcesTest, StarsTakeAWholeBlockAndSomeOfAShuffledOne) {
  const SpringBody block = spring_body(test::solid_block({8, 2, 2}, 0.01), 1000, {1, 1, 1});
  EXPECT_EQ(pack_springs(block).singles.owned.size(), 0u);
  const SpringBody shuffled = spring_body(scattered_block(), 1000, {1, 1, 1});
  const SpringPacks packs = pack_springs(shuffled);
  EXPECT_GT(packs.stars.owned.size(), 0u);
  EXPECT_GT(packs.singles.owned.size(), 0u);
}

TEST(SpringForcesTest, KeepMomentumToRounding) {
  SpringBody body = spring_body(test::solid_block({6, 5, 4}, 0.01), 1000, {1, 1, 1});
  vary_constants(body);
  const std::vector<Vector3d> positions = shaken(body, 1e-3);
  const std::vector<Vector3d> forces = SpringForces(body).forces(positions);
  Vector3d sum = Vector3d::Zero();
  Vector3d torque = Vector3d::Zero();
  double size = 0;
  for (std::size_t v = 0; v < forces.size(); ++v) {
    sum += forces[v];
    torque += positions[v].cross(forces[v]);
    size += forces[v].norm();
  }
  EXPECT_LT(sum.norm(), 1e-14 * size);
  EXPECT_LT(torque.norm(), 1e-14 * size * 0.06);
}

TEST(SpringForcesTest, RestIsWithoutForceToRounding) {
  const SpringBody body = spring_body(test::solid_block({4, 4, 4}, 0.01), 1000, {1, 1, 1});
  for (const Vector3d& f : SpringForces(body).forces(body.rest)) {
    EXPECT_LT(f.norm(), 1e-12);  // a stretch of 1 % makes about 1 N
  }
}

TEST(SpringForcesTest, GiveTheSameBitsOnEveryInstructionSet) {
  for (const geometry::TetMesh& mesh : {test::solid_block({7, 5, 3}, 0.01), scattered_block()}) {
    SpringBody body = spring_body(mesh, 1000, {1, 1, 1});
    vary_constants(body);
    const std::vector<Vector3d> positions = shaken(body, 2e-3);
    const auto expected = SpringForces(body, InstructionSet::kBaseline).forces(positions);
    for (const InstructionSet set : available_instruction_sets()) {
      const auto found = SpringForces(body, set).forces(positions);
      EXPECT_EQ(std::memcmp(found.data(), expected.data(), sizeof(Vector3d) * found.size()), 0)
          << name_of(set);
    }
  }
}

/// The kernel has code for these two alone; it would not be used if voxels were cut otherwise.
TEST(SpringForcesTest, TheInsideOfALatticeIsOfTwoKinds) {
  const geometry::TetMesh mesh = test::solid_block({12, 12, 12}, 0.01);
  const SpringPacks packs = pack_springs(spring_body(mesh, 1000, {1, 1, 1}));
  for (const std::uint64_t kind : kInLattice) {
    EXPECT_GT(6 * std::ranges::count(packs.stars.owned, kind), std::ssize(packs.stars.owned));
  }
  expect_forces_of_every_spring(mesh, 1e-3);
}

TEST(SpringForcesTest, CountInvertedTetrahedra) {
  const SpringBody body = spring_body(test::solid_block({3, 3, 3}, 0.01), 1000, {1, 1, 1});
  std::vector<Vector3d> positions = shaken(body, 6e-3);
  const std::size_t expected = inverted_tetrahedra(body, positions);
  ASSERT_GT(expected, 5u);
  for (const InstructionSet set : available_instruction_sets()) {
    const SpringForces springs(body, set);
    PaddedPoints at = springs.points();
    PaddedPoints sums(at.size());
    EXPECT_EQ(
        [&] {
          for (std::size_t v = 0; v < positions.size(); ++v) {
            at[v] = body.rest[v];
          }
          return springs.add(at, sums);
        }(),
        0u);
    for (std::size_t v = 0; v < positions.size(); ++v) {
      at[v] = positions[v];
    }
    EXPECT_EQ(springs.add(at, sums), expected) << name_of(set);
    at[0].setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_GT(springs.add(at, sums), 0u);
  }
}

TEST(SpringForcesTest, AreFiniteWhereEverythingIsInOnePoint) {
  const SpringBody body = spring_body(test::solid_block({2, 2, 2}, 0.01), 1000, {1, 1, 1});
  const std::vector<Vector3d> positions(body.rest.size(), Vector3d{0.1, 0.2, 0.3});
  for (const Vector3d& f : SpringForces(body).forces(positions)) {
    EXPECT_TRUE(f.allFinite());
  }
}

}  // namespace
}  // namespace haptrial::deformable
