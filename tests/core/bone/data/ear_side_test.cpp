#include "core/bone/data/ear_side.h"

#include <gtest/gtest.h>

#include "core/bone/data/anatomy.h"
#include "core/bone/data/temporal_bone.h"

namespace haptrial::bone::ear_side_test {
namespace {

BoneModel right_ear() { return make_temporal_bone({.seed = 2, .spacing = 1e-3}); }

TEST(EarSideTest, TheMadeEarIsARightOneAndItsMirrorImageALeftOne) {
  const BoneModel right = right_ear();
  const BoneModel left = mirrored(right);
  EXPECT_EQ(ear_side(right), EarSide::kRight);
  EXPECT_EQ(ear_side(left), EarSide::kLeft);
  const auto directions = ear_directions(right);
  ASSERT_TRUE(directions);
  EXPECT_LT(directions->outwards.x(), -0.5);
  EXPECT_GT(directions->back.y(), 0.0);
  EXPECT_GT(outside_view(right).dot(directions->outwards), 0.9);
  EXPECT_GT(outside_view(left).dot(ear_directions(left)->outwards), 0.9);
}

TEST(EarSideTest, AMirrorImageHasEveryVoxelOnTheOtherSideOfThePatient) {
  const BoneModel right = right_ear();
  const BoneModel left = mirrored(right);
  const int last = right.grid.size[0] - 1;
  for (int n = 0; n < 1000; ++n) {
    const int i = 37 * n % (last + 1);
    const int j = 53 * n % right.grid.size[1];
    const int k = 71 * n % right.grid.size[2];
    ASSERT_EQ(left.labels[left.grid.index(last - i, j, k)],
              right.labels[right.grid.index(i, j, k)]);
    const Eigen::Vector3d here = right.grid.centre(i, j, k);
    const Eigen::Vector3d there = left.grid.centre(last - i, j, k);
    ASSERT_LT((there - Eigen::Vector3d(-here.x(), here.y(), here.z())).norm(), 1e-9);
  }
  const BoneModel again = mirrored(left);
  EXPECT_EQ(again.labels, right.labels);
  EXPECT_LT((again.grid.origin - right.grid.origin).norm(), 1e-9);
}

TEST(EarSideTest, WithoutItsStructuresNobodyKnows) {
  BoneModel plain = right_ear();
  for (std::uint8_t& label : plain.labels) {
    label = label == 0 ? 0 : 1;
  }
  EXPECT_FALSE(ear_side(plain));
  EXPECT_FALSE(ear_directions(plain));
}

TEST(AnatomyNamesTest, NamesThatAreNotKnownHaveANearestOne) {
  EXPECT_TRUE(is_known_structure("Facial_Nerve"));
  EXPECT_TRUE(is_known_structure("CN VII"));
  EXPECT_FALSE(is_known_structure("facial nevre"));
  EXPECT_EQ(nearest_structure("facial nevre"), "facial nerve");
  EXPECT_EQ(nearest_structure("left_incus_body"), "incus");
  EXPECT_EQ(nearest_structure("sigmoid sinus left"), "sigmoid sinus and dura");
}

}  // namespace
}  // namespace haptrial::bone::ear_side_test
