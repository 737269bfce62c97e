// Recall by frequency: planted systems are found, scipy computes the same, tests keep their level.
#include "analysis/force_training/study/recall_frequency.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <sstream>

#include "core/base/file_text.h"
#include "core/base/random.h"
#include "tests/analysis/force_training/study/recalled_waves.h"
#include "tests/support/null_levels.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis::recall_frequency_test {
namespace {

using recalled_waves::RecalledWaves;
using recalled_waves::WaveSystem;

/// One participant under one condition, with this system for everything.
RecallResponse response_of(const WaveSystem& system, std::size_t cycle, int trials = 24) {
  const RecalledWaves waves({{"only", system}}, 1, trials, 3);
  return recall_response(waves.spectra().front().recalls, cycle);
}

TEST(RecallFrequencyTest, AnExactRecallHasGainOneNoPhaseAndFullCoherence) {
  for (std::size_t cycle = 0; cycle < 4; ++cycle) {
    const RecallResponse found = response_of({}, cycle);
    EXPECT_NEAR(std::abs(found.response), 1.0, 1e-9);
    EXPECT_NEAR(std::arg(found.response), 0.0, 1e-9);
    EXPECT_NEAR(found.coherence, 1.0, 1e-9);
    EXPECT_EQ(found.trials, 24U);
  }
}

/// Patterns begin and end at 0, so that a delay loses nothing of them.
TEST(RecallFrequencyTest, APlantedGainAndDelayAreFound) {
  constexpr double kDelay = 0.2;
  for (std::size_t cycle = 0; cycle < 4; ++cycle) {
    const RecallResponse found = response_of({.gain = 0.6, .delay = kDelay}, cycle);
    const double frequency = static_cast<double>(cycle + 1) / RecalledWaves::kDuration;
    EXPECT_NEAR(std::abs(found.response), 0.6, 0.01) << cycle;
    EXPECT_NEAR(std::arg(found.response), -2.0 * std::numbers::pi * frequency * kDelay, 0.06)
        << cycle;
    EXPECT_GT(found.coherence, 0.97);
  }
}

/// Noise of the same spectrum as the signal, at r times its amplitude, leaves 1 / (1 + r²).
TEST(RecallFrequencyTest, NoiseLowersTheCoherenceAsItsPowerSays) {
  const double coherence = response_of({.noise = 1.0}, 1, 1500).coherence;
  EXPECT_NEAR(coherence, 0.5, 0.05);
}

TEST(RecallFrequencyTest, AnUnrelatedRecallHasTheCoherenceOfChance) {
  double sum = 0.0;
  constexpr int kPeople = 200, kTrials = 10;
  const RecalledWaves waves({{"only", {.gain = 0.0, .noise = 1.0}}}, kPeople, kTrials, 4);
  for (const RecalledSpectra& each : waves.spectra()) {
    sum += recall_response(each.recalls, 1).coherence;
  }
  EXPECT_NEAR(sum / kPeople, 1.0 / kTrials, 0.02);
}

/// Numbers that Debian's scipy prints of the same curves, one after the other.
std::vector<double> by_scipy(const std::filesystem::path& folder) {
  const std::string output = (folder / "out.txt").string();
  const std::string command = "/usr/bin/python3 -B '" HAPTRIAL_SOURCE_DIR
                              "/tests/analysis/force_training/study/recall_by_scipy.py' '" +
                              (folder / "curves.txt").string() + "' >'" + output + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::istringstream in(file_text(output));
  std::vector<double> numbers;
  for (double each = 0.0; in >> each;) {
    numbers.push_back(each);
  }
  return numbers;
}

TEST(RecallFrequencyTest, ScipyComputesTheSame) {
  const test::TemporaryFolder folder;
  constexpr int kTrials = 7;
  const RecalledWaves waves({{"only", {.gain = 0.8, .delay = 0.3, .noise = 0.5}}}, 1, kTrials, 5);
  {
    std::ofstream out(folder.path() / "curves.txt");
    for (const auto& [target, applied] : waves.curves()) {
      for (std::size_t i = 0; i < target.force.size(); ++i) {
        out << fmt::format("{} {}\n", target.force[i], applied.force[i]);
      }
    }
  }
  const std::vector<double> numbers = by_scipy(folder.path());
  ASSERT_EQ(numbers.size(), 3 * kRecallCycles);
  constexpr std::size_t kTaught = 5;  // cycles; others hold nothing but rounding
  for (std::size_t cycle = 0; cycle < kTaught; ++cycle) {
    const RecallResponse found = recall_response(waves.spectra().front().recalls, cycle);
    EXPECT_NEAR(std::abs(found.response), numbers[3 * cycle], 1e-9);
    EXPECT_NEAR(std::arg(found.response), numbers[3 * cycle + 1], 1e-9);
    EXPECT_NEAR(found.coherence, numbers[3 * cycle + 2], 1e-9);
  }
}

TEST(RecallFrequencyTest, BandsAreThoseThatWereTaughtAndConditionsDiffer) {
  const RecalledWaves waves({{"haptic", {.gain = 0.6, .delay = 0.25, .noise = 0.6}},
                             {"visual", {.gain = 0.9, .delay = 0.05, .noise = 0.4}}},
                            12, 12, 6);
  const auto bands = recall_by_frequency(waves.spectra(), {"haptic", "visual"});
  ASSERT_GE(bands.size(), 3U);
  double power = 0.0;
  for (const RecallBand& band : bands) {
    power += band.power;
    EXPECT_GE(band.power, 0.01);
    ASSERT_EQ(band.conditions.size(), 2U);
    EXPECT_EQ(band.conditions[0].people, 12U);
    EXPECT_EQ(band.conditions[0].trials, 12.0);
  }
  EXPECT_GT(power, 0.95);
  const RecallBand& second = bands[1];
  EXPECT_NEAR(second.conditions[0].gain->mean, 0.6, 0.12);
  EXPECT_NEAR(second.conditions[1].gain->mean, 0.9, 0.12);
  EXPECT_LT(second.conditions[0].phase->mean, second.conditions[1].phase->mean);
  ASSERT_TRUE(second.gain.p_adjusted);
  EXPECT_LT(*second.gain.p_adjusted, 0.01);
  EXPECT_LT(*second.phase.p_adjusted, 0.01);
  EXPECT_LT(*second.coherence.p_adjusted, 0.01);
}

TEST(RecallFrequencyTest, RunsOfOtherLengthsHaveNoFrequenciesInCommon) {
  const RecalledWaves waves({{"only", {.gain = 0.5}}}, 2, 4, 8);
  std::vector<RecalledSpectra> spectra = waves.spectra();
  RecallSpectrum twice = *spectra[0].recalls[0];
  twice.period *= 2.0;
  spectra[0].recalls[0] = &twice;
  const auto bands = recall_over_time(spectra, {"only"});
  ASSERT_FALSE(bands);
  EXPECT_EQ(bands.because(),
            "runs take 6.4 to 12.8 s, so that their cycles are different frequencies");
  twice.period *= 0.52;  // as runs differ by the ticks that they take
  EXPECT_TRUE(recall_over_time(spectra, {"only"}));
}

TEST(RecallFrequencyTest, PhasesWithoutACommonDirectionHaveNoMean) {
  const RecalledWaves waves({{"only", {.gain = 0.0, .noise = 1.0}}}, 8, 4, 8);
  const auto bands = recall_by_frequency(waves.spectra(), {"only"});
  EXPECT_FALSE(bands.front().conditions.front().phase);
}

TEST(RecallFrequencyTest, WhoRecallsNothingHasNoPhase) {
  const RecalledWaves waves({{"only", {.gain = 0.8, .delay = 0.5}}}, 6, 4, 8);
  std::vector<RecalledSpectra> spectra = waves.spectra();
  const auto all = recall_by_frequency(spectra, {"only"});
  std::vector<RecallSpectrum> nothing;
  for (const RecallSpectrum* recall : spectra[0].recalls) {
    nothing.push_back(*recall);
    std::ranges::fill(nothing.back().applied, 0.0);
  }
  for (std::size_t i = 0; i < nothing.size(); ++i) {
    spectra[0].recalls[i] = &nothing[i];
  }
  const RecallAtFrequency found = recall_by_frequency(spectra, {"only"})[0].conditions[0];
  EXPECT_EQ(found.people, 5U);
  ASSERT_TRUE(found.gain);
  ASSERT_TRUE(found.phase);
  EXPECT_NEAR(found.gain->mean, all[0].conditions[0].gain->mean, 0.05);
  EXPECT_NEAR(found.phase->mean, all[0].conditions[0].phase->mean, 0.05);
}

TEST(RecallFrequencyTest, OneTrialOfAParticipantIsLeftOut) {
  const RecalledWaves waves({{"only", {.noise = 0.2}}}, 3, 1, 9);
  const auto bands = recall_by_frequency(waves.spectra(), {"only"});
  EXPECT_EQ(bands.front().conditions.front().people, 0U);
  EXPECT_FALSE(bands.front().conditions.front().gain);
}

TEST(RecallFrequencyTest, TestsKeepTheirLevelAndIntervalsTheirCoverage) {
  const recalled_waves::RecallNullCounts counts = recalled_waves::null_recalls(50, 1);
  const auto band = test::binomial_band(50, 1.0 - 1e-6);
  for (const int found :
       {counts.gain, counts.phase, counts.coherence, counts.gain_missed, counts.phase_missed}) {
    EXPECT_LE(static_cast<std::size_t>(found), band.high);
  }
}

}  // namespace
}  // namespace haptrial::analysis::recall_frequency_test
