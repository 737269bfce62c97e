#include "core/deformable/springs/spring_tangent.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;

/// So many vertices that conjugate gradients are taken where they may be.
class SpringTangentTest : public testing::Test {
 protected:
  void SetUp() override {
    for (std::size_t v = 0; v < body_.rest.size(); ++v) {
      if (body_.rest[v].z() < 1e-9) {
        holds_.push_back({static_cast<std::int32_t>(v), Vector3d::Zero()});
      }
    }
    RandomStream random(7, "force");
    for (Vector3d& f : force_) {
      f = {random.normal(), random.normal(), random.normal()};
    }
    for (const Hold& hold : holds_) {
      force_[static_cast<std::size_t>(hold.vertex)].setZero();
    }
  }
  Vectors squeezed(double share) const {
    Vectors x = body_.rest;
    for (Vector3d& p : x) {
      p.z() *= share;
    }
    return x;
  }
  SpringBody body_ = spring_body(test::solid_block({12, 12, 12}, 0.01), 1000, {0.02, 0.01, 0.05});
  std::vector<Hold> holds_;
  Vectors force_ = Vectors(body_.rest.size());
};

TEST_F(SpringTangentTest, AtRestItSolvesAsCholmodDoes) {
  SpringTangent tangent(body_, held_flags(body_.rest.size(), holds_));
  ASSERT_TRUE(tangent.set(body_.rest));
  Vectors found;
  ASSERT_TRUE(tangent.solve(force_, 1e-9, found));
  EXPECT_TRUE(tangent.seems_definite());
  EXPECT_TRUE(tangent.is_definite());
  const auto expected = small_displacements(body_, holds_, body_.rest, force_);
  ASSERT_TRUE(expected);
  double largest = 0, apart = 0;
  for (std::size_t v = 0; v < found.size(); ++v) {
    largest = std::max(largest, (*expected)[v].norm());
    apart = std::max(apart, ((*expected)[v] - found[v]).norm());
  }
  EXPECT_LT(apart, 1e-8 * largest);
}

// The body is squeezed so far that CHOLMOD finds the Hessian indefinite: not definite, and
// downhill.
TEST_F(SpringTangentTest, ASqueezedBodyIsSeenToBeIndefinite) {
  const Vectors x = squeezed(0.7);
  ASSERT_FALSE(small_displacements(body_, holds_, x, force_));
  SpringTangent tangent(body_, held_flags(body_.rest.size(), holds_));
  ASSERT_TRUE(tangent.set(x));
  EXPECT_FALSE(tangent.is_definite());
  Vectors direction;
  ASSERT_TRUE(tangent.solve(force_, 1e-9, direction));
  double work = 0;
  for (std::size_t v = 0; v < direction.size(); ++v) {
    work += force_[v].dot(direction[v]);
  }
  EXPECT_GT(work, 0);
}

// For squeezes between the two CHOLMOD and the tangent agree.
TEST_F(SpringTangentTest, ItIsDefiniteWhereCholmodSaysSo) {
  for (const double share : {0.95, 0.85}) {
    SpringTangent tangent(body_, held_flags(body_.rest.size(), holds_));
    ASSERT_TRUE(tangent.set(squeezed(share)));
    EXPECT_EQ(tangent.is_definite(),
              small_displacements(body_, holds_, squeezed(share), force_).has_value())
        << share;
  }
}

}  // namespace
}  // namespace haptrial::deformable
