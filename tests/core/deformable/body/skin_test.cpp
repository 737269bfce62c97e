#include "core/deformable/body/skin.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/random.h"
#include "core/deformable/body/mesh_parts.h"
#include "core/geometry/volume/tetrahedralize.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/message_of.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

class SkinTest : public testing::Test {
 protected:
  SkinTest() {
    const geometry::TetMesh body = test::solid_block({5, 4, 3}, 0.01);
    rest_.assign(body.vertices.begin(), body.vertices.end());
    surface_ = mesh_parts(body.tetrahedra).surface;
    RandomStream random(8, "skin");
    for (int i = 0; i < 500; ++i) {
      skin_.push_back({random.uniform(-0.005, 0.055), random.uniform(-0.005, 0.045),
                       random.uniform(-0.005, 0.035)});
    }
    skin_.push_back(rest_.front());  // on a vertex of the body
    skin_.push_back(rest_.back() + Vector3d(1e-170, 0, 0));
  }
  Positions moved(const Eigen::Isometry3d& by, const Positions& points) const {
    Positions result;
    for (const Vector3d& p : points) {
      result.push_back(by * p);
    }
    return result;
  }
  Positions rest_, skin_;
  std::vector<Face> surface_;
};

double largest_way(const Positions& a, const Positions& b) {
  double largest = 0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    largest = std::max(largest, (a[v] - b[v]).norm());
  }
  return largest;
}

TEST_F(SkinTest, AtRestItIsTheRestSurface) {
  Skin skin(rest_, surface_, skin_);
  Positions found(skin_.size());
  skin.update(rest_, found);
  EXPECT_LT(largest_way(found, skin_), 1e-16);
  EXPECT_EQ(skin.lost_frames(), 0u);
}

TEST_F(SkinTest, ItTurnsAndMovesWithTheBody) {
  for (const int neighbours : {1, 5, 17}) {
    Skin skin(rest_, surface_, skin_, neighbours);
    Positions found(skin_.size());
    RandomStream random(9, "turn");
    for (int i = 0; i < 20; ++i) {
      Eigen::Isometry3d by = Eigen::Isometry3d::Identity();
      const Vector3d axis(random.normal(), random.normal(), random.normal());
      by.rotate(Eigen::AngleAxisd(random.uniform(0, 6), axis.normalized()));
      by.pretranslate(Vector3d(random.normal(), random.normal(), random.normal()));
      skin.update(moved(by, rest_), found);
      EXPECT_LT(largest_way(found, moved(by, skin_)), 1e-14);  // metres away from the origin
    }
  }
}

TEST_F(SkinTest, AVertexOnOneOfTheBodyFollowsThatAlone) {
  Skin skin(rest_, surface_, skin_);
  Positions found(skin_.size());
  Positions bent = rest_;
  for (Vector3d& p : bent) {
    p.z() += 2 * p.x() * p.x() + 0.1 * p.y();
  }
  skin.update(bent, found);
  EXPECT_LT((found[500] - bent.front()).norm(), 1e-17);
  EXPECT_LT((found[501] - bent.back()).norm(), 1e-17);
}

TEST_F(SkinTest, WeightsFallWithTheSquareOfTheDistance) {
  // Two neighbours along one edge of the body: at a third of it, weights 4 : 1.
  const Positions third{Vector3d(0.01 / 3, 0, 0)};
  Skin skin(rest_, surface_, third, 2);
  Positions found(1);
  Positions pushed = rest_;
  for (Vector3d& p : pushed) {
    if (p.isApprox(Vector3d(0.01, 0, 0), 1e-9)) {
      p.x() += 1e-7;  // as little as leaves frames alone
    }
  }
  skin.update(pushed, found);
  EXPECT_NEAR(found[0].x() - third[0].x(), 0.2 * 1e-7, 1e-11);
}

TEST_F(SkinTest, AnUpdateDoesNotAllocate) {
  Skin skin(rest_, surface_, skin_);
  Positions found(skin_.size());
  const test::AllocationGuard guard;
  skin.update(rest_, found);
  EXPECT_EQ(guard.count(), 0u);
}

TEST_F(SkinTest, ACrushedBodyLeavesNumbers) {
  Skin skin(rest_, surface_, skin_);
  Positions found(skin_.size());
  skin.update(Positions(rest_.size(), Vector3d(0.1, 0.2, 0.3)), found);
  EXPECT_GT(skin.lost_frames(), 0u);
  for (const Vector3d& p : found) {
    EXPECT_TRUE(p.allFinite());
  }
}

// A spike whose tip has the normal along one of its edges: that edge gives no direction.
TEST(VertexFramesTest, AnEdgeAlongTheNormalIsNotChosen) {
  // Vertex 0 in the middle of a roof; its first neighbour, 1, lies right above it.
  const Positions rest{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-0.5, 0.9, 0}, {-0.5, -0.9, 0}};
  const std::vector<Face> surface{{0, 2, 3}, {0, 3, 4}, {0, 4, 2}, {0, 1, 2}, {0, 2, 1}};
  const VertexFrames frames(rest, surface);
  ASSERT_EQ(frames.vertices()[0], 0);
  const VertexFrames::Frame& frame = frames.frames()[0];
  EXPECT_NEAR(frame.x[2], 1, 1e-12);
  EXPECT_NEAR(std::hypot(frame.y[0], frame.y[1]), 1, 1e-12);
  EXPECT_NEAR(frame.y[0], 1, 1e-12);  // towards vertex 2
}

TEST(VertexFramesTest, AVertexWhereNormalsCancelHasNoFrame) {
  const Positions rest{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Face> both_sides{{0, 1, 2}, {0, 2, 1}};
  EXPECT_TRUE(VertexFrames(rest, both_sides).vertices().empty());
  const Positions skin{{0, 0, 0}};
  EXPECT_EQ(test::message_of([&] { Skin(rest, both_sides, skin); }),
            "skin: the body's surface has no vertex with a normal");
}

TEST_F(SkinTest, BadInputIsRefused) {
  EXPECT_EQ(test::message_of([&] { Skin(rest_, surface_, skin_, 0); }),
            "skin: 0 neighbours; at least 1 is allowed");
  skin_[3].x() = std::nan("");
  EXPECT_EQ(test::message_of([&] { Skin(rest_, surface_, skin_); }),
            "skin: vertex 3 is not finite");
}

}  // namespace
}  // namespace haptrial::deformable
