#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/bone/drill/feel.h"
#include "tests/support/bone_press.h"
#include "tests/support/solid_bone.h"

namespace haptrial::bone {
namespace {

Contact contact_of(double volume, const Eigen::Vector3d& push) {
  Contact contact;
  contact.samples = volume > 0.0 ? 1 : 0;
  contact.volume = volume;
  contact.push = push;
  return contact;
}

TEST(FeelTest, MagnitudeHasTwoGainsALimitAndNoJump) {
  const FeelParameters p = default_feel(2e-3);
  EXPECT_EQ(magnitude(0.0, p), 0.0);
  double before = 0.0;
  const double step = p.threshold / 100.0;
  for (int n = 1; n < 5000; ++n) {
    const double now = magnitude(n * step, p);
    EXPECT_GE(now, before);
    EXPECT_LE(now - before, 1.0001 * p.second_gain * step);  // no jump
    before = now;
  }
  const auto slope = [&](double volume) {
    return (magnitude(volume + step, p) - magnitude(volume, p)) / step;
  };
  EXPECT_NEAR(slope(0.5 * p.threshold), p.first_gain, 1e-6 * p.first_gain);
  EXPECT_NEAR(slope(2.0 * p.threshold), p.second_gain, 1e-6 * p.second_gain);
  EXPECT_EQ(magnitude(1.0, p), p.force_limit);
}

TEST(FeelTest, ForceGoesAlongThePush) {
  const FeelParameters p = default_feel(2e-3);
  RandomStream random(1, "pushes");
  for (int n = 0; n < 100; ++n) {
    const Eigen::Vector3d direction(random.normal(), random.normal(), random.normal());
    const double volume = random.uniform(0.0, 4.0 * p.threshold);
    const Eigen::Vector3d push = 0.7 * volume * direction.normalized();
    const Eigen::Vector3d force = push_force(contact_of(volume, push), p);
    EXPECT_NEAR(force.norm(), magnitude(volume, p), 1e-12);
    EXPECT_NEAR(force.dot(direction.normalized()), force.norm(), 1e-12);
  }
}

TEST(FeelTest, ForceFadesWhereSamplesDoNotAgreeOnADirection) {
  const FeelParameters p = default_feel(2e-3);
  const double volume = 3.0 * p.threshold;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  EXPECT_EQ(push_force(contact_of(volume, before), p), before);
  for (int n = 1; n <= 100; ++n) {
    const double agreement = p.least_agreement * n / 50.0;  // up to twice the least
    const Eigen::Vector3d push = agreement * volume * Eigen::Vector3d::UnitX();
    const Eigen::Vector3d force = push_force(contact_of(volume, push), p);
    EXPECT_NEAR(force.x(), std::min(1.0, n / 50.0) * magnitude(volume, p), 1e-9);
    EXPECT_LE((force - before).norm(), magnitude(volume, p) / 50.0 + 1e-9);
    before = force;
  }
}

TEST(FeelTest, BothForcesTogetherStayWithinTheLimit) {
  const BurrParameters burr = default_burr(BurrKind::kCutting, 4e-3);
  const FeelParameters p = default_feel(2e-3);
  Contact contact = contact_of(1e-8, 1e-8 * Eigen::Vector3d::UnitZ());
  contact.turn = 1e-9 * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(bone_force(contact, p, burr, 1.0).norm(), p.force_limit, 1e-12);
  EXPECT_EQ(bone_force(Contact{}, p, burr, 1.0), Eigen::Vector3d(0, 0, 0));
}

TEST(FeelTest, TeethPullOnlyWhileTheBurrTurnsAndByItsHand) {
  BurrParameters burr = default_burr(BurrKind::kCutting, 4e-3);
  Contact contact = contact_of(1e-9, 1e-9 * Eigen::Vector3d::UnitZ());
  contact.turn = 1e-12 * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d forward = drag_force(contact, burr, 1.0);
  EXPECT_LT(forward.x(), 0.0);
  EXPECT_EQ(drag_force(contact, burr, 0.0), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(drag_force(contact, burr, 0.5), 0.5 * forward);
  burr.clockwise = false;
  EXPECT_EQ(drag_force(contact, burr, 1.0), -forward);
}

/// A wheel that turns clockwise before one's eyes rolls to the right.
TEST(FeelTest, AClockwiseBurrRunsAlongTheBoneAsAWheelRolls) {
  const BoneVolume bone(test::flat_bone(40, 0.5e-3));  // below z = 0
  const BurrParameters burr = default_burr(BurrKind::kCutting, 4e-3);
  EXPECT_TRUE(burr.clockwise);
  Drill drill(burr, {});
  // The holder of the handle stands at -y and looks along y, with x to the right.
  const auto turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitY());
  const Contact contact = drill.touch(bone, {0.0, 0.0, 1.5e-3}, turn);
  const Eigen::Vector3d force = drag_force(contact, burr, 1.0);
  EXPECT_GT(force.x(), 0.1);
  EXPECT_NEAR(force.y(), 0.0, 0.01 * force.x());
}

TEST(FeelTest, SmallBurrsCarryTheForceLimit) {
  for (const double radius : {0.25e-3, 0.5e-3, 1e-3, 3.5e-3, 10e-3}) {
    const FeelParameters p = default_feel(radius);
    EXPECT_NO_THROW(check(p));
    const double whole = 4.0 / 3.0 * 3.14159265358979 * std::pow(radius, 3);
    EXPECT_EQ(magnitude(whole, p), p.force_limit);
  }
}

TEST(FeelTest, IsReadFromADefinition) {
  Table table = Table::parse("second_gain = 5e9\nforce_limit = 6\n", "a.toml");
  FeelParameters p = default_feel(2e-3);
  feel_schema().read(table, p);
  table.finish();
  EXPECT_EQ(p.second_gain, 5e9);
  EXPECT_EQ(p.force_limit, 6.0);
  EXPECT_EQ(p.first_gain, default_feel(2e-3).first_gain);
  Table wrong = Table::parse("first_gain = 5e9\nsecond_gain = 1e9\n", "b.toml");
  feel_schema().read(wrong);
  EXPECT_THROW(wrong.finish(), InputError);
}

TEST(FeelTest, ImpossibleParametersAreNamed) {
  const auto refused = [](auto&& change) {
    FeelParameters p;
    change(p);
    EXPECT_THROW(check(p), std::invalid_argument);
  };
  EXPECT_NO_THROW(check(FeelParameters{}));
  refused([](FeelParameters& p) { p.first_gain = 0.0; });
  refused([](FeelParameters& p) { p.second_gain = 0.5 * p.first_gain; });
  refused([](FeelParameters& p) { p.threshold = std::nan(""); });
  refused([](FeelParameters& p) { p.force_limit = -1.0; });
  refused([](FeelParameters& p) { p.least_agreement = 1.5; });
}

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
