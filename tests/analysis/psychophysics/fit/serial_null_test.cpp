// Staircases make drift and repetition of their own, for people who have neither: what is expected
// by chance takes it off, a study's test keeps its level and still finds what is there.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/psychophysics/fit/serial.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/psychometric/procedure/staircase.h"
#include "tests/support/null_levels.h"

namespace haptrial::analysis::trials {
namespace {

using psychometric::PsychometricFunction;
using psychometric::PsychometricParameters;
using psychometric::Staircase;

constexpr int kPeople = 12;

/// A person's addition to the log odds of "yes".
struct Habit {
  double repetition{0.0};  // half of it for "yes" before, less half for "no"
  double drift{0.0};       // from first to last of 50 trials
};

PsychometricParameters function() {
  PsychometricParameters p;
  p.threshold = 10.0;
  p.width = 4.0;
  return p;
}

std::unique_ptr<psychometric::Procedure> staircase() {
  psychometric::StaircaseParameters p;
  p.start = 14.0;
  p.high = 20.0;
  p.down = 1;
  p.steps = {{2.0, 2.0, 0}, {1.0, 1.0, 2}};
  p.stop_reversals = 16;
  return std::make_unique<Staircase>(p);
}

LikelihoodOptions options() {
  LikelihoodOptions options;
  options.function = function();
  options.task = Task::kYesNo;
  options.guess = options.lapse = {0.0, 0.0};
  return options;
}

/// One person at one staircase, whose function is fitted to what they said.
SerialRecord session(RandomStream& random, const Habit& habit) {
  const PsychometricFunction truth(function());
  SerialRecord record;
  const auto procedure = staircase();
  std::vector<TrialBlock> blocks;
  int before = 0;
  while (!procedure->finished()) {
    const double level = procedure->next().front();
    const double p = truth(level);
    const double place = static_cast<double>(record.trials.size()) / 50.0 - 0.5;
    const double odds =
        std::log(p / (1.0 - p)) + 0.5 * habit.repetition * before + habit.drift * place;
    const int yes = random.uniform() < 1.0 / (1.0 + std::exp(-odds)) ? 1 : 0;
    procedure->report(yes, {level});
    before = yes == 1 ? 1 : -1;
    record.trials.push_back({0, 0, level, yes, before, 1});
    record.tracks.push_back(0);
    blocks.push_back({level, yes, 1});
  }
  record.adaptive = {{true, staircase}};
  const LikelihoodFit fit = likelihood_fit(pooled(blocks), options());
  record.functions = {
      fit.undetermined ? std::nullopt : std::optional(fitted_function(function(), fit.parameters))};
  return record;
}

/// Numbers of the people of a study: as they are found, and less those by chance.
struct Study {
  std::vector<double> drift, repetition, plain_drift, plain_repetition;
  std::size_t people{0}, drift_held{0}, repetition_held{0};  // intervals of one that hold 0
};

bool holds_nothing(double value, double error, double chance_error) {
  return std::abs(value) <= 1.959964 * std::hypot(error, chance_error);
}

Study study(std::size_t number, const Habit& habit) {
  RandomStream random(derived_seed(number, "serial null"), "answers");
  Study result;
  for (int p = 0; p < kPeople; ++p) {
    const SerialRecord record = session(random, habit);
    const auto found = serial_coefficients(record.trials, record.functions);
    const auto chance = serial_coefficients_by_chance(record, options(), random.bits());
    if (found.drift && found.repetition && chance.drift && chance.repetition) {
      result.plain_drift.push_back(*found.drift);
      result.plain_repetition.push_back(*found.repetition);
      result.drift.push_back(*found.drift - *chance.drift);
      result.repetition.push_back(*found.repetition - *chance.repetition);
      ++result.people;
      result.drift_held +=
          holds_nothing(result.drift.back(), found.drift_error, chance.drift_error) ? 1 : 0;
      result.repetition_held +=
          holds_nothing(result.repetition.back(), found.repetition_error, chance.repetition_error)
              ? 1
              : 0;
    }
  }
  return result;
}

bool found(const std::vector<double>& values) {
  const auto test = against_zero(values);
  return test && test->p < 0.05;
}

TEST(SerialNullTest, ATestOverPeopleKeepsItsLevel) {
  constexpr std::size_t kStudies = 120;
  std::vector<Study> studies(kStudies);
  parallel_for(kStudies, 2, [&](std::size_t i) { studies[i] = study(i, {}); });
  std::size_t drift = 0, repetition = 0, plain_repetition = 0;
  std::size_t people = 0, drift_held = 0, repetition_held = 0;
  for (const Study& each : studies) {
    people += each.people;
    drift_held += each.drift_held;
    repetition_held += each.repetition_held;
    drift += found(each.drift) ? 1 : 0;
    repetition += found(each.repetition) ? 1 : 0;
    plain_repetition += found(each.plain_repetition) ? 1 : 0;
  }
  // A test with a level of 0.05 leaves the band once in a million times.
  const auto band = test::binomial_band(kStudies, 1.0 - 1e-6);
  EXPECT_LE(drift, band.high);
  EXPECT_LE(repetition, band.high);
  EXPECT_GT(plain_repetition, band.high) << "or there is nothing to take off";
  const auto share = [&](std::size_t held) {
    return static_cast<double>(held) / static_cast<double>(people);
  };
  EXPECT_NEAR(share(drift_held), 0.95, 0.025) << people << " people";
  EXPECT_NEAR(share(repetition_held), 0.95, 0.025) << people << " people";
}

TEST(SerialNullTest, WhatIsThereIsFound) {
  std::size_t drift = 0, repetition = 0;
  constexpr std::size_t kStudies = 10;
  for (std::size_t i = 0; i < kStudies; ++i) {
    repetition += found(study(i, {.repetition = 2.0}).repetition) ? 1 : 0;
    drift += found(study(i, {.drift = 5.0}).drift) ? 1 : 0;
  }
  EXPECT_GE(repetition, kStudies - 1);
  EXPECT_GE(drift, kStudies - 1);
}

TEST(SerialNullTest, TheSameSeedGivesTheSameNumbers) {
  RandomStream random(1, "answers");
  const SerialRecord record = session(random, {});
  const auto once = serial_coefficients_by_chance(record, options(), 5);
  const auto again = serial_coefficients_by_chance(record, options(), 5);
  const auto other = serial_coefficients_by_chance(record, options(), 6);
  ASSERT_TRUE(once.drift && again.drift && other.drift);
  EXPECT_EQ(*once.drift, *again.drift);
  EXPECT_EQ(*once.repetition, *again.repetition);
  EXPECT_NE(*once.drift, *other.drift);
}

/// A track that was broken off is done anew no longer than it went.
TEST(SerialNullTest, ABrokenTrackIsNotFinished) {
  RandomStream random(1, "answers");
  SerialRecord record = session(random, {});
  record.trials.resize(20);
  record.tracks.resize(20);
  record.adaptive.front().finished = false;
  std::size_t asked = 0;
  record.adaptive.front().begin = [&asked] {
    struct Counted final : psychometric::Procedure {
      explicit Counted(std::size_t& count) : asked(count) {}
      const psychometric::Level& next() const override { return inner->next(); }
      void report(double answer, const psychometric::Level& applied) override {
        ++asked;
        inner->report(answer, applied);
      }
      bool finished() const override { return inner->finished(); }
      std::vector<psychometric::Estimate> estimates() const override { return {}; }
      std::size_t& asked;
      std::unique_ptr<psychometric::Procedure> inner{staircase()};
    };
    return std::make_unique<Counted>(asked);
  };
  serial_coefficients_by_chance(record, options(), 5);
  EXPECT_EQ(asked, 25u * 20u);
}

}  // namespace
}  // namespace haptrial::analysis::trials
