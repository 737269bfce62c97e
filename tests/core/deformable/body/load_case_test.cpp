#include "core/deformable/body/load_case.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/message_of.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable {
namespace {

using geometry::TetMesh;

/// The bottom of a block held, its vertex 0 being a corner of it, and a push at the last vertex.
LoadCase push_on(const TetMesh& body) {
  LoadCase load{"push", {}, {}};
  for (std::size_t v = 0; v < body.vertices.size(); ++v) {
    if (body.vertices[v].z() < 1e-9) {
      load.holds.push_back({static_cast<std::int32_t>(v), {0, 0, 0}});
    }
  }
  load.forces.push_back({static_cast<std::int32_t>(body.vertices.size() - 1), {0, 0, -1}});
  return load;
}

class LoadCaseTest : public testing::Test {
 protected:
  std::string refused() const {
    return test::message_of([this] { check_load(body_, load_); });
  }
  TetMesh body_ = test::solid_block({2, 2, 2}, 0.01);
  LoadCase load_ = push_on(body_);
};

TEST_F(LoadCaseTest, AHeldBlockMayBePushed) { EXPECT_NO_THROW(check_load(body_, load_)); }

TEST_F(LoadCaseTest, ABodyThatNothingHoldsIsRefused) {
  load_.holds.clear();
  EXPECT_EQ(refused(),
            "load 'push': nothing holds the part of the body with vertex 0: 0 of its vertices are "
            "held and 3 that are not on a line are needed");
}

TEST_F(LoadCaseTest, AHingeDoesNotHold) {
  std::erase_if(load_.holds, [this](const Hold& hold) {
    return body_.vertices[static_cast<std::size_t>(hold.vertex)].x() > 1e-9;
  });
  ASSERT_EQ(load_.holds.size(), 3u);
  EXPECT_NE(refused().find("nothing holds"), std::string::npos);
}

TEST_F(LoadCaseTest, AForceOnNoVertexIsRefused) {
  load_.forces[0].vertex = 27;
  EXPECT_EQ(refused(), "load 'push': there is no vertex 27; the body has 0 to 26");
}

TEST_F(LoadCaseTest, NothingThatActsIsRefused) {
  load_.forces.clear();
  EXPECT_EQ(refused(), "load 'push' has no force and moves no vertex");
}

TEST_F(LoadCaseTest, AVertexIsHeldOnce) {
  load_.holds.push_back(load_.holds.front());
  EXPECT_EQ(refused(), "load 'push': vertex 0 is held twice");
}

TEST_F(LoadCaseTest, AForceIsFinite) {
  load_.forces[0].force.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused(), "load 'push': the force of vertex 26 is not finite");
}

class BodyCheckTest : public testing::Test {
 protected:
  std::string refused() const {
    return test::message_of([this] { check_body(body_, "block"); });
  }
  TetMesh body_ = test::solid_block({1, 1, 1}, 0.01);
};

TEST_F(BodyCheckTest, ABlockIsRight) { EXPECT_NO_THROW(check_body(body_, "block")); }

TEST_F(BodyCheckTest, AnInvertedTetrahedronIsNamed) {
  std::swap(body_.tetrahedra[2][0], body_.tetrahedra[2][1]);
  EXPECT_NE(refused().find("block: tetrahedron 2 (vertices"), std::string::npos) << refused();
  EXPECT_NE(refused().find("is inverted"), std::string::npos);
}

TEST_F(BodyCheckTest, AFlatTetrahedronIsNamed) {
  for (auto& vertex : body_.vertices) {
    vertex.z() *= 1e-7;
  }
  EXPECT_NE(refused().find("is flat"), std::string::npos) << refused();
}

TEST_F(BodyCheckTest, AVertexOfNoTetrahedronIsNamed) {
  body_.vertices.resize(body_.vertices.size() + 1);
  EXPECT_EQ(refused(), "block: no tetrahedron has the vertex 8; remove it");
}

TEST_F(BodyCheckTest, ACornerMustBeThere) {
  body_.tetrahedra[1][3] = -1;
  EXPECT_EQ(refused(), "block: tetrahedron 1 has the vertex -1; there are 0 to 7");
}

}  // namespace
}  // namespace haptrial::deformable
