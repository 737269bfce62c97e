// The force over depth that a preview shows is that of the drill to the bit, and nearly that of the
// law for a ball in flat bone.

#include "protocols/bone_drilling/burr_forces.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

#include "core/base/file_text.h"
#include "core/bone/drill/drill.h"

namespace haptrial::protocols::burr_forces_test {
namespace {

/// Without its bones, which the forces do not need.
BoneDefinition shipped(const std::string& name) {
  const auto file = std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "experiments" / name;
  return parse_bone_definition(file_text(file), name);
}

TEST(BurrForcesTest, AreThoseOfTheDrillToTheBit) {
  const BoneDefinition d = shipped("burr_shapes.toml");
  const std::vector<BurrForce> burrs = burr_forces(d);
  ASSERT_FALSE(burrs.empty());
  for (const BurrForce& burr : burrs) {
    const bone::BurrShape shape(burr.burr.burr.dimensions());
    const double spacing = d.spacing.value_or(0.5e-3);
    const bone::BoneModel model = flat_bone_for(spacing, shape.reach());
    const bone::BoneVolume volume(model);
    bone::Drill drill(bone::for_bone(burr.burr.burr, spacing), model.structures);
    double most = 0.0;
    for (std::size_t i = 0; i < burr.depths.size(); ++i) {
      drill.begin_tick();
      const bone::Contact contact = drill.touch(
          volume, {0.0, 0.0, shape.half_length() - burr.depths[i]}, Eigen::Quaterniond::Identity());
      const Eigen::Vector3d force =
          contact ? bone::bone_force(contact, burr.burr.feel, burr.burr.burr, 0.0)
                  : Eigen::Vector3d(Eigen::Vector3d::Zero());
      ASSERT_EQ(force, burr.forces[i]) << burr.tool << " " << burr.depths[i];
      most = std::max(most, force.norm());
    }
    EXPECT_GT(most, 0.5) << burr.tool;
  }
}

TEST(BurrForcesTest, ABallFollowsTheVolumeOfItsCap) {
  const BoneDefinition d = shipped("first_drilling.toml");
  int balls = 0;
  for (const BurrForce& burr : burr_forces(d)) {
    if (!bone::BurrShape(burr.burr.burr.dimensions()).is_ball()) {
      continue;
    }
    ++balls;
    const double r = burr.burr.radius();
    for (std::size_t i = burr.depths.size() / 3; i < burr.depths.size(); ++i) {
      const double h = burr.depths[i];
      const double law = bone::magnitude(std::numbers::pi * h * h * (r - h / 3.0), burr.burr.feel);
      EXPECT_NEAR(law, burr.forces[i].z(), 0.15 * law + 0.1) << burr.tool << " " << h;
    }
  }
  EXPECT_GT(balls, 0);
}

}  // namespace
}  // namespace haptrial::protocols::burr_forces_test
