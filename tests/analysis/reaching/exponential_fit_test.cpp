#include "analysis/reaching/exponential_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

std::vector<double> exponential(double a, double b, double t, int cycles) {
  std::vector<double> values;
  for (int n = 0; n < cycles; ++n) {
    values.push_back(a + b * std::exp(-n / t));
  }
  return values;
}

TEST(ExponentialFitTest, ExactExponentialsAreFound) {
  for (const double a : {0.0, 2.0, -0.01}) {
    for (const double b : {1.0, -3.0}) {
      for (const double t : {0.7, 3.0, 10.0, 40.0}) {
        const auto fit = fit_exponential(exponential(a, b, t, 32));
        ASSERT_TRUE(fit) << fit.because();
        EXPECT_NEAR(fit->asymptote, a, 1e-6);
        EXPECT_NEAR(fit->amplitude, b, 1e-6);
        EXPECT_NEAR(fit->time_constant, t, 1e-6 * t);
        EXPECT_NEAR(fit->rate(), 1.0 / t, 1e-6 / t);
        EXPECT_NEAR(fit->r_squared, 1.0, 1e-12);
      }
    }
  }
}

TEST(ExponentialFitTest, AWeightIsAValueThatComesTwice) {
  std::vector<double> values = exponential(1.0, 4.0, 3.0, 12);
  RandomStream random(3, "noise");
  for (double& v : values) {
    v += 0.3 * random.normal();
  }
  // Without weight a value does not count, whatever it is.
  std::vector<double> weights(values.size(), 1.0), cut(values.begin(), values.end() - 1);
  weights.back() = 0.0;
  values.back() = 1e3;
  const auto without = fit_exponential(values, weights), shorter = fit_exponential(cut);
  EXPECT_NEAR(without->time_constant, shorter->time_constant, 1e-6);
  std::vector<double> twice(values.size(), 2.0);
  EXPECT_NEAR(fit_exponential(exponential(1.0, 4.0, 3.0, 12), twice)->time_constant, 3.0, 1e-6);
}

TEST(ExponentialFitTest, WhatIsNoExponentialIsSaid) {
  std::vector<double> line, step(20, 1.0);
  for (int n = 0; n < 20; ++n) {
    line.push_back(0.1 * n);
  }
  EXPECT_FALSE(fit_exponential(line));
  step[0] = 3.0;
  EXPECT_FALSE(fit_exponential(step));
  EXPECT_FALSE(fit_exponential(std::vector(20, 1.0)));
  EXPECT_FALSE(fit_exponential(exponential(0.0, 1.0, 2.0, 4)));
  EXPECT_THROW(fit_exponential(line, std::vector{1.0}), std::invalid_argument);
}

/// Participants with parameters of their own around asymptote 1, amplitude 8, time constant 4.
CycleTable people(RandomStream& random, std::size_t count, int cycles) {
  CycleTable table;
  for (std::size_t p = 0; p < count; ++p) {
    const double a = 1.0 + 0.8 * random.normal(), b = 8.0 + 1.5 * random.normal();
    std::vector<std::optional<double>> row;
    for (const double value : exponential(a, b, 4.0, cycles)) {
      row.emplace_back(value + 1.5 * random.normal());
    }
    table.participants.push_back(p);
    table.values.push_back(row);
  }
  return table;
}

TEST(ExponentialFitTest, IntervalsHoldTheTruth) {
  constexpr int kStudies = 300;
  std::array<int, 3> held{};
  for (int study = 0; study < kStudies; ++study) {
    RandomStream random(static_cast<std::uint64_t>(study), "people who learn");
    ParticipantResampling how;
    how.resampling = {static_cast<std::uint64_t>(study), "coverage", 999, 1};
    const auto fit = fit_learning(people(random, 16, 32), how);
    ASSERT_TRUE(fit) << fit.because();
    const auto holds = [](const Defined<BootstrapInterval>& i, double truth) {
      return i && i->low <= truth && truth <= i->high ? 1 : 0;
    };
    held[0] += holds(fit->asymptote, 1.0);
    held[1] += holds(fit->amplitude, 8.0);
    held[2] += holds(fit->time_constant, 4.0);
  }
  for (std::size_t k = 0; k < held.size(); ++k) {
    RecordProperty("held_" + std::to_string(k), held[k]);
    const double bound = 3.3 * std::sqrt(0.95 * 0.05 * kStudies);  // binomial, one in a thousand
    EXPECT_NEAR(held[k], 0.95 * kStudies, bound);
  }
}

TEST(ExponentialFitTest, ThreadsDoNotChangeTheIntervals) {
  RandomStream random(1, "people who learn");
  const CycleTable table = people(random, 10, 20);
  ParticipantResampling how;
  how.resampling = {5, "threads", 2500, 1};
  const auto one = fit_learning(table, how);
  how.resampling.threads = 3;
  const auto three = fit_learning(table, how);
  ASSERT_TRUE(one->time_constant) << one->time_constant.because();
  ASSERT_TRUE(one->amplitude) << one->amplitude.because();
  EXPECT_EQ(one->time_constant->low, three->time_constant->low);
  EXPECT_EQ(one->amplitude->high, three->amplitude->high);
  EXPECT_EQ(one->time_constant->level, 0.95);
}

// Six people learn in one cycle and two in three: draws of the six alone end at the shortest time
// constant that is searched, which is no limit of the time constant.
TEST(ExponentialFitTest, AnIntervalThatEndsWithTheSearchIsOpen) {
  CycleTable table;
  RandomStream random(5, "open");
  for (std::size_t p = 0; p < 8; ++p) {
    auto& row = table.values.emplace_back();
    table.participants.push_back(p);
    for (const double value : exponential(0.0, 1.0, p < 6 ? 0.05 : 3.0, 12)) {
      row.emplace_back(value + 0.001 * random.normal());
    }
  }
  const auto fit = fit_learning(table);
  ASSERT_TRUE(fit) << fit.because();
  ASSERT_TRUE(fit->time_constant) << fit->time_constant.because();
  EXPECT_GT(fit->at_bound, 0u);
  EXPECT_EQ(fit->time_constant->low, -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isfinite(fit->time_constant->high));
}

/// The mean of rows; nothing if all are the first.
std::optional<std::vector<double>> mean_unless_first(std::span<const std::size_t> rows) {
  double sum = 0.0;
  for (const std::size_t row : rows) {
    sum += static_cast<double>(row);
  }
  return sum > 0.0 ? std::optional(std::vector{sum / static_cast<double>(rows.size())})
                   : std::nullopt;
}

TEST(ParticipantIntervalsTest, LeaveOutDrawsWithoutANumberAndCountTheOthers) {
  ParticipantResampling how;
  how.resampling = {1, "few", 99'999, 2};
  const auto intervals = participant_intervals(5, {2.0}, mean_unless_first, how);
  ASSERT_TRUE(intervals[0]) << intervals[0].because();
  // All five are the first in 1 of 3,125 draws.
  EXPECT_LT(intervals[0]->resamples, 99'999u);
  EXPECT_GT(intervals[0]->resamples, 99'900u);
}

TEST(ParticipantIntervalsTest, SayThatTheParticipantsAreTooFew) {
  ParticipantResampling how;
  how.resampling = {1, "few", 1'999, 2};
  const auto of_three = participant_intervals(3, {1.0}, mean_unless_first, how);
  EXPECT_THAT(of_three[0].because(),
              testing::MatchesRegex("with 3 participants its ends lie beyond the [0-9]+ resamples, "
                                    "as far as so few values take them"));
  const auto fails = [](std::span<const std::size_t> rows) {
    return rows.size() < 4 ? std::nullopt : mean_unless_first(rows);
  };
  EXPECT_EQ(participant_intervals(4, {1.5}, fails, how)[0].because(),
            "it does not exist without one of the participants");
}

}  // namespace
}  // namespace haptrial::analysis
