#include "core/bone/drill/feel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/random.h"
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

}  // namespace
}  // namespace haptrial::bone
