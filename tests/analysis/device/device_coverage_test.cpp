// Certificates of a virtual arm with planted faults.

#include "tests/analysis/device/device_coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "analysis/device/certificate.h"
#include "analysis/device/certificate_report.h"
#include "core/device/handle_part.h"
#include "tests/analysis/device/simulated_certificate.h"

namespace haptrial::test {
namespace {

using analysis::CertificatePart;
using analysis::CertificateResult;
using analysis::Interval;

constexpr double kTicksPerSecond = 1000.0;  // [Hz]

CertificateResult certificate_of(const device::VirtualDeviceParameters& electronics,
                                 const device::SensedMountParameters& mount,
                                 const std::vector<CertificatePart>& parts) {
  const analysis::Excitation excitation(kTicksPerSecond, 4.8);
  return identify_device(simulated_certificate(electronics, mount, excitation, 1, parts),
                         excitation);
}

TEST(CertificateTest, IntervalsHoldThePlantedFaultsAsOftenAsTheySay) {
  constexpr int kSeeds = 40;
  for (const device::Part of : {device::Part::kTip, device::Part::kRotation, device::Part::kGrip}) {
    for (const CoverageCount& count : count_coverage(faulty_part(of), 1, kSeeds)) {
      // Intervals of one certificate share their data, so that certificates count, not intervals.
      const double share = static_cast<double>(count.held) / count.of;
      EXPECT_GT(share, 0.95 - 4.0 * std::sqrt(0.95 * 0.05 / kSeeds))
          << device::part_word(of) << ", " << count.figure << ": " << count.held << " of "
          << count.of;
    }
  }
}

TEST(CertificateTest, MotionAloneHoldsFaultsDrawnAtRandomAsOftenAsItSays) {
  constexpr int kSeeds = 5;
  for (const device::Part of : {device::Part::kTip, device::Part::kRotation, device::Part::kGrip}) {
    for (const CoverageCount& count : count_free_coverage(of, 1, kSeeds)) {
      const double share = static_cast<double>(count.held) / count.of;
      EXPECT_GT(share, 0.95 - 4.0 * std::sqrt(0.95 * 0.05 / kSeeds))
          << device::part_word(of) << ", " << count.figure << ": " << count.held << " of "
          << count.of;
    }
  }
}

TEST(CertificateTest, APerfectDeviceHasNoFaults) {
  device::SensedMountParameters mount;
  mount.friction = 0.0;
  const CertificateResult found =
      certificate_of({}, mount,
                     {CertificatePart::kRest, CertificatePart::kGrid, CertificatePart::kFrequency,
                      CertificatePart::kMove});
  ASSERT_TRUE(found.statics);
  EXPECT_NEAR(found.statics->gain.value, 1.0, 0.002);
  EXPECT_EQ(found.statics->dead_zone.low, 0.0);
  EXPECT_LT(found.statics->dead_zone.high, 0.01);
  ASSERT_EQ(found.response.size(), 3u);
  ASSERT_EQ(found.motion.size(), 3u);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_FALSE(found.response[axis].resonance);
    EXPECT_FALSE(found.response[axis].bandwidth);
    EXPECT_NEAR(found.response[axis].delay.value, 0.001, 5e-5);
    EXPECT_FALSE(found.motion[axis].cogging);
    EXPECT_NEAR(found.motion[axis].friction.value, 0.0, 0.002);
  }
  EXPECT_NEAR(found.rest.resolution, 1e-5, 1e-12) << "of the encoders";
}

TEST(CertificateTest, MotionAloneTellsFrictionDeadZoneAndDelayInCommandedNewtons) {
  device::VirtualDeviceParameters electronics = faulty_electronics();
  electronics.faults.resonance = 0.0;
  electronics.faults.cogging = 0.0;
  const device::SensedMountParameters mount = faulty_mount();
  const CertificateResult found = certificate_of(electronics, mount, {CertificatePart::kFree});
  EXPECT_FALSE(found.statics) << "a gain needs a sensor or a known mass";
  EXPECT_FALSE(found.rest.sensor);
  ASSERT_EQ(found.free.size(), 3u);
  const double gain = electronics.faults.gain;
  for (const analysis::FreeMotion& axis : found.free) {
    EXPECT_NEAR(axis.friction.value, mount.friction / gain, 0.005);
    EXPECT_NEAR(axis.mobility.value, gain / mount.mass, 0.02);
    EXPECT_NEAR(axis.dead_zone.value, electronics.faults.dead_zone, 0.005);
    EXPECT_NEAR(axis.delay.value, 0.004, 1e-4);
  }
  EXPECT_NEAR(found.free[1].offset.value, electronics.faults.gravity_error / gain, 0.005);
}

/// Findings of a handle whose tip tells nothing.
std::vector<analysis::FindingList> findings_of(const analysis::CertificateRecord& record,
                                               const analysis::Excitation& excitation) {
  std::vector<analysis::PartCertificate> parts(1);
  parts.push_back(analysis::identify_part(record, excitation));
  return analysis::certificate_findings(parts);
}

const analysis::Finding& figure_of(const std::vector<analysis::FindingList>& lists,
                                   const std::string& list, const std::string& figure) {
  const auto at = std::ranges::find(lists, list, &analysis::FindingList::name);
  return *std::ranges::find(at->findings, figure, &analysis::Finding::name);
}

TEST(CertificateTest, ARotationIsStatedAboutItsAxes) {
  constexpr double kRadius = 0.02;  // [m]
  const FaultyPart faulty = faulty_part(device::Part::kRotation);
  const analysis::Excitation excitation(kTicksPerSecond, faulty.max_force, {1}, faulty.reach);
  analysis::CertificateRecord record = simulated_certificate(
      faulty.electronics, faulty.mount, excitation, 1,
      {CertificatePart::kRest, CertificatePart::kGrid, CertificatePart::kMove}, faulty.reach);
  record.of = device::Part::kRotation;
  record.radius = kRadius;
  const auto lists = findings_of(record, excitation);
  const auto& inertia = figure_of(lists, "rotation_summary", "inertia");
  EXPECT_NEAR(inertia.value.as_number(), 0.05 * kRadius * kRadius, 2e-6);
  EXPECT_EQ(inertia.unit, "kg·m²");
  EXPECT_NEAR(figure_of(lists, "rotation_summary", "gain").value.as_number(), 0.92, 0.02);
  const auto& friction = figure_of(lists, "rotation_summary", "friction");
  EXPECT_NEAR(friction.value.as_number(), 0.2 * kRadius, 2e-4);
  EXPECT_EQ(friction.unit, "N·m");
  EXPECT_NEAR(figure_of(lists, "rotation_summary", "position_resolution").value.as_number(),
              1e-5 / kRadius, 1e-9);
}

TEST(CertificateTest, WithoutASensorAGripSaysWhatItTakes) {
  const FaultyPart faulty = faulty_part(device::Part::kGrip);
  const analysis::Excitation excitation(kTicksPerSecond, faulty.max_force, {0}, faulty.reach);
  analysis::CertificateRecord record = simulated_certificate(
      faulty.electronics, faulty.mount, excitation, 1, {CertificatePart::kFree}, faulty.reach);
  record.of = device::Part::kGrip;
  const auto lists = findings_of(record, excitation);
  for (const char* figure : {"gain", "friction", "inertia"}) {
    EXPECT_NE(figure_of(lists, "grip_summary", figure).why_not.find("force sensor"),
              std::string::npos)
        << figure;
  }
  const double gain = faulty.electronics.faults.gain;
  const auto estimate = [&](const char* figure) {
    return figure_of(lists, "grip_summary", figure).value.as_number();
  };
  EXPECT_NEAR(estimate("delay"), 0.002, 2e-4);
  EXPECT_NEAR(estimate("dead_zone"), 0.15, 0.01);
  EXPECT_NEAR(estimate("friction_commanded"), 0.25 / gain, 0.01);
  EXPECT_NEAR(estimate("cogging_commanded"), 0.08 / gain, 0.005);
  EXPECT_NEAR(estimate("cogging_period"), 0.0025, 2e-5);
  EXPECT_NEAR(estimate("resonance"), 120.0, 5.0);
  EXPECT_FALSE(figure_of(lists, "rotation_summary", "gain").why_not.empty())
      << "a part without motors is not left out in silence";
}

TEST(CertificateTest, AKnownMassTellsGainAndInertia) {
  device::VirtualDeviceParameters electronics = faulty_electronics();
  electronics.faults.cogging = 0.0;
  device::SensedMountParameters mount = faulty_mount();
  mount.added_mass = 0.2;
  const CertificateResult found =
      certificate_of(electronics, mount, {CertificatePart::kFree, CertificatePart::kLoaded});
  ASSERT_EQ(found.loaded.size(), 3u);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const analysis::WeighedMotion weighed =
        weigh(found.free[axis], found.loaded[axis], mount.added_mass);
    EXPECT_NEAR(weighed.gain.value, 0.87, 0.015);
    EXPECT_NEAR(weighed.inertia.value, 0.22, 0.005);
    EXPECT_LT(weighed.gain.low, 0.87);
    EXPECT_GT(weighed.gain.high, 0.87);
  }
}

TEST(CertificateTest, AHandleThatNobodyMovesTellsNothingOfFriction) {
  const analysis::Excitation excitation(kTicksPerSecond, 4.8);
  analysis::CertificateRecord record = simulated_certificate(
      faulty_electronics(), faulty_mount(), excitation, 1, {CertificatePart::kMove});
  for (Eigen::Vector3d& position : record.parts[3].position) {
    position.setZero();
  }
  EXPECT_TRUE(identify_motion(record, excitation).empty());
}

TEST(CertificateTest, WallsAreBracketedByTheFirstThatIsNotPassive) {
  const analysis::Excitation excitation(kTicksPerSecond, 4.8);
  analysis::CertificateRecord record;
  record.walls = {{500.0, true}, {1000.0, true}, {2000.0, false}, {1400.0, true}, {4000.0, true}};
  const CertificateResult found = identify_device(record, excitation);
  ASSERT_TRUE(found.wall);
  EXPECT_EQ(found.wall->passive, 1400.0);
  EXPECT_EQ(found.wall->active, 2000.0);
}

}  // namespace
}  // namespace haptrial::test
