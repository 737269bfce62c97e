// Constants of bone's feel from recordings: of the simulator itself, and of its law with noise.

#include "analysis/bone_drilling/feel/feel_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>

#include "analysis/files/csv.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/bone/drill/drill.h"
#include "core/bone/drill/feel.h"
#include "tests/support/solid_bone.h"

namespace haptrial::analysis::drilling::feel_fit_test {
namespace {

using testing::HasSubstr;
constexpr double kRadius = 2e-3;
constexpr double kPi = std::numbers::pi;

/// Forces and removal of the simulator's own burr at places on flat bone, drilling at every other.
std::vector<FeelSample> recorded(const bone::BurrParameters& burr,
                                 const bone::FeelParameters& feel) {
  std::vector<FeelSample> samples;
  bone::Drill drill(burr, {});
  const bone::BoneModel model = test::flat_bone(48, 0.25e-3);
  for (int n = 0; n < 120; ++n) {
    FeelSample sample;
    sample.depth = 5e-3 * kRadius * (1 + n);
    sample.tilt = 0.5 * kPi * (n % 4) / 3.0;
    bone::BoneVolume volume(model);
    drill.begin_tick();
    const Eigen::Vector3d tip(1e-5 * n, 0.0, kRadius - sample.depth);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(sample.tilt, Eigen::Vector3d::UnitX()));
    const bone::Contact contact = drill.touch(volume, tip, turn);
    sample.force = bone::push_force(contact, feel).norm();
    if (n % 2 == 1) {
      constexpr double kDt = 1e-4;
      const double taken = drill.remove(volume, contact, sample.force, 1.0, kDt).volume;
      sample.feed = taken / kDt / (kPi * sample.depth * (2.0 * kRadius - sample.depth));
    }
    samples.push_back(sample);
  }
  return samples;
}

TEST(FeelFitTest, TheSimulatorsOwnConstantsComeBack) {
  bone::BurrParameters burr = bone::default_burr(bone::BurrKind::kCutting, 2.0 * kRadius);
  burr.removal_rate = 24.0;
  burr.falloff = 9.0;
  bone::FeelParameters feel = bone::default_feel(kRadius);
  feel.threshold = 1.5e-9;
  feel.force_limit = 1e3;
  const FeelFit fit = fit_feel(kRadius, recorded(burr, feel));
  // The burr's samples and voxels of 0.25 mm make a few per cent.
  EXPECT_NEAR(fit.first_gain.value, feel.first_gain, 0.05 * feel.first_gain);
  EXPECT_NEAR(fit.second_gain.value, feel.second_gain, 0.05 * feel.second_gain);
  EXPECT_NEAR(fit.threshold.value, feel.threshold, 0.15 * feel.threshold);
  ASSERT_TRUE(fit.removal_rate && fit.falloff);
  EXPECT_NEAR(fit.removal_rate->value, 24.0, 0.05 * 24.0);
  EXPECT_NEAR(fit.falloff->value, 9.0, 0.1 * 9.0);
}

TEST(FeelFitTest, TheMeanLatitudeIsThatOfTheBurrsSamples) {
  const bone::Burr burr(bone::default_burr(bone::BurrKind::kCutting, 2.0 * kRadius));
  for (const double depth : {0.3e-3, 1e-3, 2e-3}) {
    for (const double tilt : {0.0, 0.6, 0.5 * kPi}) {
      const Eigen::Vector3d normal(std::sin(tilt), 0.0, std::cos(tilt));  // into bone
      double sum = 0.0;
      int count = 0;
      for (int s = 0; s < burr.samples(); ++s) {
        if (burr.position(s).dot(normal) > kRadius - depth) {
          sum += std::abs(std::asin(std::clamp(burr.direction(s).z(), -1.0, 1.0)));
          ++count;
        }
      }
      EXPECT_NEAR(mean_latitude(kRadius, depth, tilt), sum / count, 0.02) << depth << ' ' << tilt;
    }
  }
}

/// The law with these constants.
struct Truth {
  double first_gain{0.7e9};
  double second_gain{2.1e9};
  double threshold{1.2e-9};
  double removal_rate{25.0};
  double falloff{12.0};
};

/// A recording of the law with normal errors of force and feed.
std::vector<FeelSample> simulated(const Truth& truth, std::span<const double> latitudes,
                                  std::uint64_t seed) {
  RandomStream random(seed, "recording of feel");
  std::vector<FeelSample> samples;
  for (std::size_t n = 0; n < latitudes.size(); ++n) {
    FeelSample sample;
    sample.depth = 1e-3 * static_cast<double>(1 + n) / static_cast<double>(latitudes.size());
    sample.tilt = 0.5 * kPi * static_cast<double>(n % 3) / 2.0;
    const double volume = immersed_volume(kRadius, sample.depth);
    const double force = truth.first_gain * std::min(volume, truth.threshold) +
                         truth.second_gain * std::max(0.0, volume - truth.threshold);
    sample.force = force + 0.05 * random.normal();
    const double circle = kPi * sample.depth * (2.0 * kRadius - sample.depth);
    sample.feed = force * volume / circle * (truth.removal_rate - truth.falloff * latitudes[n]) +
                  1e-3 * random.normal();
    samples.push_back(sample);
  }
  return samples;
}

/// Number of studies whose intervals hold the truth, of each of the five constants.
std::array<int, 5> covered(int studies) {
  constexpr std::size_t kSamples = 150;
  const Truth truth;
  std::vector<double> latitudes;
  for (std::size_t n = 0; n < kSamples; ++n) {
    latitudes.push_back(mean_latitude(kRadius, 1e-3 * static_cast<double>(1 + n) / kSamples,
                                      0.5 * kPi * static_cast<double>(n % 3) / 2.0));
  }
  std::array<int, 5> held{};
  for (int study = 0; study < studies; ++study) {
    const FeelFit fit =
        fit_feel(kRadius, simulated(truth, latitudes, static_cast<std::uint64_t>(study)));
    const std::array estimates{fit.first_gain, fit.second_gain, fit.threshold, *fit.removal_rate,
                               *fit.falloff};
    const std::array values{truth.first_gain, truth.second_gain, truth.threshold,
                            truth.removal_rate, truth.falloff};
    for (std::size_t i = 0; i < held.size(); ++i) {
      held[i] += estimates[i].low <= values[i] && values[i] <= estimates[i].high ? 1 : 0;
    }
  }
  return held;
}

/// HAPTRIAL_STUDIES counts more of them.
TEST(FeelFitTest, IntervalsHoldTheTruth) {
  const char* more = std::getenv("HAPTRIAL_STUDIES");
  const int studies = more != nullptr ? std::atoi(more) : 60;
  const double spread = 3.0 * std::sqrt(0.95 * 0.05 * studies);
  for (const int held : covered(studies)) {
    std::cout << "covered " << held << " of " << studies << '\n';
    EXPECT_NEAR(held, 0.95 * studies, spread);
  }
}

TEST(FeelFitTest, WhatCannotBeToldApartIsLeftOutOrRefused) {
  const Truth truth;
  std::vector<double> latitudes(100, 0.5);
  std::vector<FeelSample> upright = simulated(truth, latitudes, 1);
  for (FeelSample& sample : upright) {
    sample.tilt = 0.5 * kPi;
    sample.depth = 0.5e-3 + 1e-3 * sample.depth;
  }
  EXPECT_FALSE(fit_feel(kRadius, upright).removal_rate) << "one latitude";
  for (FeelSample& sample : upright) {
    sample.depth = 0.5e-3;
  }
  EXPECT_THROW(fit_feel(kRadius, upright), InputError) << "one depth";
  upright.resize(10);
  EXPECT_THROW(fit_feel(kRadius, upright), InputError) << "few";
}

TEST(FeelFitTest, ATableIsReadAndRefusedByItsLine) {
  const auto read = [](const char* text) {
    return read_feel_samples(CsvTable::parse(text, "press.csv"), kRadius);
  };
  const auto samples = read("time,depth,force,feed,tilt\n0,1e-4,0.5,,0.3\n1,2e-4,1,0.002,0\n");
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_FALSE(samples[0].feed);
  EXPECT_EQ(samples[1].feed, 0.002);
  EXPECT_EQ(samples[0].tilt, 0.3);
  const auto refusal = [&](const char* text) -> std::string {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal("depth,force\n0.4,1\n1e-4,1\n"), HasSubstr("press.csv:2: depth is '0.4'"));
  // An immersed ball has no circle on the surface, by which the law of removal divides.
  EXPECT_EQ(refusal("depth,force\n1e-4,1\n0.004,1\n"),
            "press.csv:3: depth is '0.004'; allowed: from -0.03 to below the burr's diameter, "
            "0.004 [m]");
  EXPECT_EQ(refusal("depth,force\n-0.03,0\n0.0039,1\n"), "");
  EXPECT_THAT(refusal("depth,force\n-0.4,1\n"), HasSubstr("depth is '-0.4'"));
  EXPECT_THAT(refusal("depth,force\n1e-4,500\n"), HasSubstr("allowed: a force of at most 100 [N]"));
  EXPECT_THAT(refusal("depth,force,feed\n1e-4,1,2\n"), HasSubstr("at most 0.1 [m/s]"));
  EXPECT_THAT(refusal("depth,force,tilt\n1e-4,1,90\n"), HasSubstr("allowed: an angle from 0"));
  EXPECT_THAT(refusal("depth\n1\n"), HasSubstr("force"));
}

}  // namespace
}  // namespace haptrial::analysis::drilling::feel_fit_test
