#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/bone/drill/feel.h"
#include "tests/support/bone_press.h"
#include "tests/support/solid_bone.h"

namespace haptrial::bone {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using test::press;
using test::PressingHand;
using test::Restlessness;

struct Scene {
  const char* name;
  BoneModel model;
  double above;  // where the burr's lowest point starts [m]
};

std::vector<Scene> scenes() {
  const auto bone = [](auto&& inside) { return test::solid_bone(48, 0.5e-3, inside); };
  std::vector<Scene> all;
  all.push_back({"flat", test::flat_bone(48, 0.5e-3), 0.0});
  all.push_back(
      {"thin, 1 mm", bone([](const Vector3d& p) { return p.z() < 0 && p.z() > -1e-3; }), 0.0});
  all.push_back({"edge", bone([](const Vector3d& p) { return p.z() < -std::abs(p.x()); }), 0.0});
  all.push_back({"groove", bone([](const Vector3d& p) { return p.z() < std::abs(p.x()); }), 2e-3});
  return all;
}

/// The default force of a burr over a bone, the drill off.
class Feeling {
 public:
  Feeling(const BoneModel& model, double diameter)
      : bone_(model),
        drill_(default_burr(BurrKind::kDiamond, diameter), {}),
        feel_(default_feel(0.5 * diameter)) {}

  test::BoneForce force() {
    return [this](const Vector3d& tip) {
      drill_.begin_tick();
      const Quaterniond turn(Eigen::AngleAxisd(0.5, Vector3d(1.0, 0.3, 0.2).normalized()));
      return bone_force(drill_.touch(bone_, tip, turn), feel_, drill_.burr().parameters(), 0.0);
    };
  }

 private:
  BoneVolume bone_;
  Drill drill_;
  FeelParameters feel_;
};

/// Across, the posture holds the tool on an edge that it would slip off.
constexpr double kAcross = 2500.0;

TEST(StabilityTest, AHandComesToRestOnBone) {
  for (const Scene& scene : scenes()) {
    for (const double diameter : {1e-3, 4e-3, 7e-3}) {
      for (const double newtons : {0.1, 1.0, 10.0}) {
        Feeling feeling(scene.model, diameter);
        const Vector3d start(0.0, 0.1e-3, 0.5 * diameter + scene.above);
        const Restlessness rest =
            press(feeling.force(), start, {newtons, PressingHand::kFriction, kAcross});
        EXPECT_LT(rest.way, 0.1e-6) << scene.name << ' ' << diameter << ' ' << newtons;
        EXPECT_LT(rest.force, 1e-3) << scene.name << ' ' << diameter << ' ' << newtons;
        // It rests near the surface, not deep in the bone or below.
        EXPECT_GT(rest.mean.z(), -1e-3) << scene.name << ' ' << diameter << ' ' << newtons;
      }
    }
  }
}

TEST(StabilityTest, WithoutAnyFrictionMovementStaysBelowATenthOfAMillimetre) {
  for (const Scene& scene : scenes()) {
    for (const double diameter : {2e-3, 7e-3}) {
      for (const double newtons : {0.3, 3.0, 8.0}) {
        Feeling feeling(scene.model, diameter);
        const Vector3d start(0.0, 0.1e-3, 0.5 * diameter + scene.above);
        const Restlessness rest = press(feeling.force(), start, {newtons, 0.0, kAcross});
        EXPECT_LT(rest.way, 100e-6) << scene.name << ' ' << diameter << ' ' << newtons;
      }
    }
  }
}

TEST(StabilityTest, TheTestSeesALimitCycleWhereThereIsOne) {
  // Far beyond 2 b / T, what a sampled spring may have on this hand, it cannot rest.
  Feeling feeling(test::flat_bone(48, 0.5e-3), 4e-3);
  const auto soft = feeling.force();
  const auto hard = [&](const Vector3d& tip) { return Vector3d(12.0 * soft(tip)); };
  EXPECT_GT(press(hard, Vector3d(0, 0, 2e-3), {10.0, 0.0, kAcross}).way, 100e-6);
}

TEST(StabilityTest, BoneIsStiff) {
  for (const double diameter : {1e-3, 4e-3, 7e-3}) {
    Feeling feeling(test::flat_bone(48, 0.5e-3), diameter);
    EXPECT_GT(test::stiffness_at(feeling.force(), 0.5 * diameter, 1.0), 5000.0) << diameter;
    EXPECT_LT(test::stiffness_at(feeling.force(), 0.5 * diameter, 4.0),
              2.0 * PressingHand::kDamping / 1e-3)
        << diameter;
  }
}

}  // namespace
}  // namespace haptrial::bone
