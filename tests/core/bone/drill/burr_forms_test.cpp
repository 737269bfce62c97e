// Burrs that are no balls, against the geometry of what they are immersed in.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/bone/drill/drill.h"
#include "core/bone/drill/feel.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/message_of.h"
#include "tests/support/solid_bone.h"

namespace haptrial::bone::burr_forms_test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;
constexpr double kSpacing = 0.25e-3;

const BurrDimensions kFissure{BurrForm::kCylinder, 2e-3, 6e-3, 0.0};
const BurrDimensions kTaper{BurrForm::kCone, 2.4e-3, 5e-3, 1.2e-3};
const BurrDimensions kPear{BurrForm::kPear, 3e-3, 6e-3, 1.5e-3};
const std::array kForms{kFissure, kTaper, kPear};
const Quaterniond kUpright = Quaterniond::Identity();
const Quaterniond kLying(Eigen::AngleAxisd(0.5 * kPi, Vector3d::UnitY()));

BurrParameters burr_of(const BurrDimensions& dimensions, double voxel = kSpacing) {
  return for_bone(default_burr(BurrKind::kCutting, dimensions), voxel);
}

BurrParameters few_samples(const BurrDimensions& dimensions) {
  return default_burr(BurrKind::kCutting, dimensions);
}

/// The area of a circle's part that is deeper than `under` below its highest point.
double segment(double radius, double depth) {
  const double below = radius - depth;  // from the centre to the chord
  return radius * radius * std::acos(below / radius) -
         below * std::sqrt(radius * radius - below * below);
}

TEST(BurrFormsTest, SamplesFillTheShapeWithTheirImages) {
  for (const BurrDimensions& dimensions : kForms) {
    const Burr burr(few_samples(dimensions));
    EXPECT_NEAR(burr.samples(), 11494, 200) << static_cast<int>(dimensions.form);
    EXPECT_NEAR(burr.samples() * burr.sample_volume(), burr.shape().volume(),
                1e-12 * burr.shape().volume());
    std::set<std::array<int, 3>> places;
    const Burr::Arrays a = burr.arrays();
    for (std::int32_t n = 0; n < a.count; ++n) {
      EXPECT_LE(burr.shape().nearest(burr.position(n)).distance, 1e-4 * burr.reach());
      places.insert({a.x[n], a.y[n], a.z[n]});
    }
    const int sign = burr.shape().is_point_symmetric() ? -1 : 1;
    for (const auto& p : places) {
      EXPECT_TRUE(places.contains({-p[0], -p[1], sign * p[2]}));
    }
  }
}

TEST(BurrFormsTest, SamplesPushInwardsAndCutByTheLatitudeOfTheSurface) {
  for (const BurrDimensions& dimensions : kForms) {
    const Burr burr(few_samples(dimensions));
    const BurrParameters& p = burr.parameters();
    for (std::int32_t n = 0; n < burr.samples(); ++n) {
      const Vector3d outwards = burr.shape().nearest(burr.position(n)).normal;
      // But for samples between two surfaces, whose rounded place may be nearer to the other one.
      constexpr double kStep = 3e-7;
      const Vector3d at = burr.position(n);
      const double deeper = burr.shape().nearest(at - kStep * outwards).distance;
      if (deeper > burr.shape().nearest(at).distance - kStep + 1e-10) {
        continue;
      }
      EXPECT_NEAR(burr.direction(n).dot(-outwards), 1.0, 3e-3);
      const double latitude = std::abs(0.5 * kPi - std::acos(outwards.z()));
      EXPECT_NEAR(static_cast<double>(burr.power(n)),
                  std::max(0.0, p.removal_rate - p.falloff * latitude), 2e-3 * p.removal_rate);
    }
  }
}

TEST(BurrFormsTest, TheSideOfAFissureBurrCutsAndItsEndLess) {
  const Burr burr(few_samples(kFissure));
  const BurrParameters& p = burr.parameters();
  const auto end = static_cast<float>(p.removal_rate - p.falloff * 0.5 * kPi);
  for (std::int32_t n = 0; n < burr.samples(); ++n) {
    const Vector3d at = burr.position(n);
    const double from_side = 1e-3 - std::hypot(at.x(), at.y());
    const double from_end = 3e-3 - std::abs(at.z());
    if (std::abs(from_side - from_end) > 1e-6) {
      EXPECT_NEAR(burr.power(n), from_side < from_end ? 25.0F : end, 1e-3F);
    }
  }
}

/// The immersed volume in bone below a plane at z = 0, and which way it pushes.
void expect_volume(const BurrDimensions& dimensions, const Vector3d& tip, const Quaterniond& turn,
                   double volume, double tolerance) {
  const BoneVolume bone(test::flat_bone(80, kSpacing));
  Drill drill(burr_of(dimensions), {});
  drill.begin_tick();
  const Contact contact = drill.touch(bone, tip, turn);
  EXPECT_NEAR(contact.volume, volume, tolerance * volume);
  const FeelParameters feel = default_feel(drill.burr().shape().ball_radius());
  const Vector3d force = bone_force(contact, feel, drill.burr().parameters(), 0.0);
  EXPECT_NEAR(force.norm(), magnitude(volume, feel), tolerance * magnitude(volume, feel));
  EXPECT_GT(force.normalized().z(), 0.995) << "out of the bone";
}

TEST(BurrFormsTest, AnUprightCylinderIsPushedByTheVolumeBelowThePlane) {
  for (const double depth : {0.25e-3, 0.6e-3, 1.1e-3}) {
    expect_volume(kFissure, {1e-4, 2e-4, 3e-3 - depth}, kUpright, kPi * 1e-6 * depth, 0.02);
  }
}

TEST(BurrFormsTest, ALyingCylinderIsPushedByTheSegmentBelowThePlane) {
  for (const double depth : {0.2e-3, 0.4e-3, 0.8e-3}) {
    expect_volume(kFissure, {1e-4, 2e-4, 1e-3 - depth}, kLying, 6e-3 * segment(1e-3, depth), 0.03);
  }
}

TEST(BurrFormsTest, AnUprightTaperAndPearArePushedByTheVolumeBelowThePlane) {
  const double depth = 0.8e-3;
  // A frustum from the tip, and a ball's cap.
  const double wide = 0.6e-3 + (1.2e-3 - 0.6e-3) * depth / 5e-3;
  const double frustum = kPi / 3.0 * depth * (0.36e-6 + 0.6e-3 * wide + wide * wide);
  expect_volume(kTaper, {1e-4, 2e-4, 2.5e-3 - depth}, kUpright, frustum, 0.03);
  const double cap = kPi * depth * depth * (1.5e-3 - depth / 3.0);
  expect_volume(kPear, {1e-4, 2e-4, 3e-3 - depth}, kUpright, cap, 0.03);
}

TEST(BurrFormsTest, DeepInBoneNothingPushes) {
  const BoneVolume bone(test::solid_bone(80, kSpacing, [](const Vector3d&) { return true; }));
  RandomStream random(3, "turns");
  for (const double voxel : {kSpacing, 0.1e-3}) {  // without and with a tree of cells
    for (const BurrDimensions& dimensions : kForms) {
      Drill drill(burr_of(dimensions, voxel), {});
      for (int n = 0; n < 5; ++n) {
        drill.begin_tick();
        const Quaterniond turn =
            Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
                .normalized();
        const Contact contact = drill.touch(bone, {1e-4 * n, 0.0, 2e-4}, turn);
        ASSERT_EQ(contact.samples, drill.burr().samples());
        EXPECT_EQ(contact.push, Vector3d::Zero().eval());
        const FeelParameters feel = default_feel(1e-3);
        EXPECT_EQ(push_force(contact, feel), Vector3d::Zero().eval());
      }
    }
  }
}

/// An upright fissure burr that goes sideways leaves a slot as wide as itself with a flat floor.
TEST(BurrFormsTest, AFissureBurrLeavesASlotOfItsWidthWithAFlatFloor) {
  constexpr double kFine = 0.125e-3;
  BoneVolume bone(test::flat_bone(96, kFine));
  BurrParameters parameters = burr_of(kFissure, kFine);
  parameters.removal_rate = 5000.0;
  Drill drill(parameters, {});
  constexpr double kDepth = 2.1e-3;
  for (int n = 0; n <= 400; ++n) {
    drill.begin_tick();
    const Vector3d tip(-3e-3 + 1.5e-5 * n, 0.0, 3e-3 - kDepth);
    const Contact contact = drill.touch(bone, tip, kUpright);
    drill.remove(bone, contact, 5.0, 1.0, 1e-3);
  }
  int wrong = 0;
  int slot = 0;
  const geometry::VoxelGrid& grid = bone.grid();
  for (int k = 0; k < 96; ++k) {
    for (int j = 0; j < 96; ++j) {
      const Vector3d p = grid.centre(48, j, k);  // in the middle of the way
      const double beside = std::abs(p.y()) - 1e-3;
      const double below = -kDepth - p.z();
      const double out = std::max(beside, below);
      if (p.z() < 0.0 && std::abs(out) > 0.5 * kFine) {
        slot += out < 0.0 ? 1 : 0;
        wrong += (bone.density(Voxel(48, j, k)) > 0.0F) != (out > 0.0) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(slot, 200);
  EXPECT_EQ(wrong, 0);
}

TEST(BurrFormsTest, WholeCellsAreWhatTheirSamplesAreOnEveryInstructionSet) {
  RandomStream random(4, "poses");
  const BoneModel model = test::solid_bone(80, 0.1e-3, [](const Vector3d& p) {
    return std::sin(p.x() / 4e-4) + std::sin(p.y() / 5e-4) + std::sin(p.z() / 3e-4) < 1.2;
  });
  const BoneVolume bone(model);
  std::vector<Drill> drills;
  for (const InstructionSet set : available_instruction_sets()) {
    drills.emplace_back(burr_of(kPear, 0.1e-3), std::span<const Structure>{}, set);
  }
  ASSERT_FALSE(drills.front().burr().cells().empty());
  const Burr& burr = drills.front().burr();
  for (int n = 0; n < 20; ++n) {
    const Vector3d tip(random.uniform(-4e-3, 4e-3), random.uniform(-4e-3, 4e-3),
                       random.uniform(-4e-3, 4e-3));
    const Quaterniond turn =
        Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
            .normalized();
    Contact first;
    for (Drill& drill : drills) {
      drill.begin_tick();
      const Contact c = drill.touch(bone, tip, turn);
      first = &drill == &drills.front() ? c : first;
      EXPECT_EQ(c.samples, first.samples);
      EXPECT_EQ(c.push, first.push);
      EXPECT_EQ(c.turn, first.turn);
    }
    int samples = 0;
    int unsure = 0;
    for (std::int32_t s = 0; s < burr.samples(); ++s) {
      const Eigen::Array3d at =
          ((tip + turn * burr.position(s) - bone.grid().origin) / 0.1e-3).array() + 0.5;
      unsure += ((at - at.round()).abs() < 2e-3).any();
      samples += bone.density(Voxel(at.floor().cast<int>().matrix())) > 0.0F ? 1 : 0;
    }
    EXPECT_LE(std::abs(first.samples - samples), unsure);
  }
}

TEST(BurrFormsTest, TickDoesNotAllocate) {
  BoneVolume bone(test::flat_bone(80, kSpacing));
  for (const BurrDimensions& dimensions : kForms) {
    Drill drill(burr_of(dimensions), {});
    const test::AllocationGuard guard;
    for (int n = 0; n < 20; ++n) {
      drill.begin_tick();
      const Contact c = drill.touch(bone, Vector3d(0, 0, 3e-3 - 1e-4 * n), kUpright);
      drill.remove(bone, c, 2.0, 1.0, 1e-3);
    }
    EXPECT_EQ(guard.count(), 0U);
  }
}

TEST(BurrFormsTest, SharpnessHalvesAfterTheWearVolume) {
  BurrParameters burr = default_burr(BurrKind::kCutting, 4e-3);
  EXPECT_EQ(sharpness(burr, 1e-3), 1.0);
  burr.wear_volume = 2e-7;
  EXPECT_EQ(sharpness(burr, 0.0), 1.0);
  EXPECT_EQ(sharpness(burr, 2e-7), 0.5);
  EXPECT_DOUBLE_EQ(sharpness(burr, 6e-7), 0.25);
}

BurrParameters read(const std::string& text) {
  Table table = Table::parse("kind = 'cutting'\n" + text, "a.toml");
  const BurrParameters p = burr_schema().read(table);
  table.finish();
  return p;
}

TEST(BurrFormsTest, AreReadFromADefinition) {
  const BurrParameters fissure = read("shape = 'cylinder'\ndiameter = 0.0016\nlength = 0.006\n");
  EXPECT_EQ(fissure.form, BurrForm::kCylinder);
  EXPECT_EQ(fissure.length, 0.006);
  const BurrParameters taper =
      read("shape = 'cone'\ndiameter = 0.002\nlength = 0.006\nnarrow_diameter = 0\n");
  EXPECT_EQ(taper.form, BurrForm::kCone);
  EXPECT_EQ(taper.narrow_diameter, 0.0);
  const BurrParameters pear = read("shape = 'pear'\ndiameter = 0.003\nlength = 0.006\n");
  EXPECT_EQ(pear.narrow_diameter, 0.0015) << "half of the diameter";
  EXPECT_EQ(read("shape = 'ball'\ndiameter = 0.003\n").form, BurrForm::kBall);
  EXPECT_EQ(read("diameter = 0.003\nwear_volume = 1e-7\n").wear_volume, 1e-7);
  for (const BurrParameters& p : {fissure, taper, pear}) {
    EXPECT_NO_THROW(Burr{p});
  }
}

TEST(BurrFormsTest, EveryWrongKeyGetsASentence) {
  const auto says = [](const std::string& text) {
    return test::message_of<InputError>([&] { read(text); });
  };
  EXPECT_NE(says("shape = 'cube'\ndiameter = 0.002\n").find("'cube'"), std::string::npos);
  EXPECT_NE(says("shape = 'cylinder'\ndiameter = 0.002\n").find("length"), std::string::npos);
  EXPECT_NE(says("shape = 'pear'\ndiameter = 0.002\nlength = 0.002\n")
                .find("length is 0.002; allowed: at least 1.01 times diameter, 0.002 [m]"),
            std::string::npos);
  EXPECT_NE(says("shape = 'cone'\ndiameter = 0.002\nlength = 0.004\nnarrow_diameter = 0.003\n")
                .find("narrow_diameter is 0.003; allowed: at most diameter, 0.002 [m]"),
            std::string::npos);
  EXPECT_NE(says("diameter = 0.002\nsample_spacing = 0.0011\n")
                .find("at most half of diameter, 0.002 [m]"),
            std::string::npos);
  EXPECT_NE(says("diameter = 0.03\nsample_spacing = 1e-5\n").find("a million samples"),
            std::string::npos);
  EXPECT_NE(says("diameter = 0.002\nlength = 0.004\n").find("length"), std::string::npos)
      << "a ball has none";
  EXPECT_NE(says("diameter = 0.002\nwear_volume = 0\n").find("wear_volume"), std::string::npos);
}

}  // namespace
}  // namespace haptrial::bone::burr_forms_test
