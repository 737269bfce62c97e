#include "core/deformable/springs/spring_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/message_of.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

class SpringGridTest : public testing::Test {
 protected:
  /// Values of used nodes at a vertex.
  static double at_vertex(const SpringGrid& grid, const std::vector<double>& values,
                          std::size_t vertex) {
    double sum = 0;
    for (const NodeShare& share : grid.shares(vertex)) {
      sum += share.weight * values[static_cast<std::size_t>(share.used)];
    }
    return sum;
  }
  SpringBody body_ = spring_body(test::solid_block({6, 4, 3}, 0.01), 1000, {1, 1, 1});
};

TEST_F(SpringGridTest, AFieldThatIsTrilinearComesOutAsItIs) {
  const SpringGrid grid(body_, {4, 3, 2});
  const auto field = [](const Vector3d& p) {
    return 1 + 20 * p.x() + 5 * p.y() + 7 * p.z() + 300 * p.x() * p.y();
  };
  std::vector<double> values;
  for (std::size_t i = 0; i < grid.used().size(); ++i) {
    values.push_back(field(grid.place(i)));
  }
  for (std::size_t v = 0; v < body_.rest.size(); ++v) {
    EXPECT_NEAR(at_vertex(grid, values, v), field(body_.rest[v]), 1e-14);
  }
}

TEST_F(SpringGridTest, OneNodeIsTheSameEverywhere) {
  const SpringGrid grid(body_, {1, 1, 1});
  for (std::size_t v = 0; v < body_.rest.size(); ++v) {
    EXPECT_DOUBLE_EQ(at_vertex(grid, {2.0}, v), 2.0);
  }
}

TEST_F(SpringGridTest, NodesThatNoVertexNeedsAreLeftOut) {
  // An angle: nothing in the far corner of the box.
  geometry::TetMesh mesh = test::solid_block({6, 6, 1}, 0.01);
  geometry::TetMesh angle;
  std::vector<std::int32_t> number(mesh.vertices.size(), -1);
  for (auto t : mesh.tetrahedra) {
    const Vector3d& p = mesh.vertices[static_cast<std::size_t>(t[0])];
    if (p.x() > 0.0101 && p.y() > 0.0101) {
      continue;
    }
    for (std::int32_t& v : t) {
      auto& n = number[static_cast<std::size_t>(v)];
      if (n < 0) {
        n = static_cast<std::int32_t>(angle.vertices.size());
        angle.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
      }
      v = n;
    }
    angle.tetrahedra.push_back(t);
  }
  const SpringBody body = spring_body(angle, 1000, {1, 1, 1});
  const SpringGrid grid(body, {4, 4, 1});
  EXPECT_LT(grid.used().size(), 16u);
  EXPECT_THAT(grid.used(), testing::Not(testing::Contains(15)));
  const std::vector<double> ones(grid.used().size(), 1.0);
  for (std::size_t v = 0; v < body.rest.size(); ++v) {
    EXPECT_NEAR(at_vertex(grid, ones, v), 1.0, 1e-15);
  }
}

TEST_F(SpringGridTest, ABadGridIsRefused) {
  EXPECT_EQ(test::message_of([&] {
              SpringGrid(body_, {0, 1, 1});
            }),
            "grid of constants: 0 x 1 x 1 nodes; at least 1 along each axis");
}

}  // namespace
}  // namespace haptrial::deformable
