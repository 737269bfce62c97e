// Lines with errors on both axes: exact cases, SciPy's orthogonal distance regression, coverage.
#include "analysis/psychometric/models/errors_in_variables.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "analysis/psychometric/models/magnitude.h"
#include "analysis/statistics/tests/t_tests.h"
#include "core/base/file_text.h"
#include "core/base/random.h"
#include "tests/support/null_levels.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis::errors_in_variables_test {
namespace {

using Points = std::vector<NoisyPoint>;

Points drawn(RandomStream& random, const RepeatScatter& scatter) {
  Points points;
  for (int i = 0; i < 6; ++i) {
    const double count = 2.0 + i % 3, at = 0.4 * i;
    points.push_back({at + std::sqrt(scatter.xx / count) * random.normal(),
                      0.3 + 0.8 * at + std::sqrt(scatter.yy / count) * random.normal(), count});
  }
  return points;
}

TEST(ErrorsInVariablesTest, EqualErrorsGiveThePrincipalAxis) {
  RandomStream random(1, "axis");
  Points points = drawn(random, {0.04, 0.04});
  double xx = 0.0, yy = 0.0, xy = 0.0, x = 0.0, y = 0.0;
  for (NoisyPoint& p : points) {
    p.count = 2.0;
    x += p.x / 6.0;
    y += p.y / 6.0;
  }
  for (const NoisyPoint& p : points) {
    xx += (p.x - x) * (p.x - x);
    yy += (p.y - y) * (p.y - y);
    xy += (p.x - x) * (p.y - y);
  }
  const auto line = noisy_line(points, {0.01, 0.01});
  ASSERT_TRUE(line) << line.because();
  EXPECT_NEAR(std::atan(line->slope), 0.5 * std::atan2(2.0 * xy, xx - yy), 1e-12);
}

TEST(ErrorsInVariablesTest, ExchangedAxesHaveTheInverseSlope) {
  RandomStream random(2, "exchange");
  const RepeatScatter scatter{0.02, 0.05, -0.01};
  const Points points = drawn(random, scatter);
  Points exchanged;
  for (const NoisyPoint& p : points) {
    exchanged.push_back({p.y, p.x, p.count});
  }
  const auto line = noisy_line(points, scatter);
  const auto other = noisy_line(exchanged, {scatter.yy, scatter.xx, scatter.xy});
  EXPECT_NEAR(line->slope * other->slope, 1.0, 1e-12);
}

TEST(ErrorsInVariablesTest, WithoutErrorsOfTheLevelItIsLeastSquares) {
  RandomStream random(3, "least squares");
  std::vector<MagnitudeTrial> plain, measured;
  for (const double level : {1.0, 2.0, 4.0, 8.0}) {
    for (int k = 0; k < 3; ++k) {
      const double estimate = std::pow(level, 0.7) * std::exp(0.2 * random.normal());
      plain.push_back({1, level, estimate});
      measured.push_back({1, level, estimate, level * std::exp(1e-7 * random.normal())});
    }
  }
  const auto a = power_law(plain), b = power_law(measured);
  ASSERT_TRUE(b) << b.because();
  EXPECT_NEAR(a->exponent, b->exponent, 1e-6);
  EXPECT_NEAR(a->lines[0].low, b->lines[0].low, 1e-6);
}

/// Slope, intercept and standard error as Debian's scipy prints them.
std::vector<double> by_scipy(const std::filesystem::path& folder) {
  const std::string output = (folder / "out.txt").string();
  const std::string command = "/usr/bin/python3 -B '" HAPTRIAL_SOURCE_DIR
                              "/tests/analysis/psychometric/models/line_by_scipy.py' '" +
                              (folder / "points.txt").string() + "' >'" + output + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::istringstream in(file_text(output));
  std::vector<double> numbers;
  for (double each = 0.0; in >> each;) {
    numbers.push_back(each);
  }
  return numbers;
}

TEST(ErrorsInVariablesTest, ScipysOrthogonalDistanceRegressionGivesTheSame) {
  const RepeatScatter scatter{0.04, 0.09};
  for (const int seed : {4, 5, 6}) {
    RandomStream random(static_cast<std::uint64_t>(seed), "scipy");
    const Points points = drawn(random, scatter);
    const test::TemporaryFolder folder;
    {
      std::ofstream out(folder.path() / "points.txt");
      for (const NoisyPoint& p : points) {
        out << fmt::format("{} {} {} {}\n", p.x, p.y, std::sqrt(scatter.xx / p.count),
                           std::sqrt(scatter.yy / p.count));
      }
    }
    const std::vector<double> judged = by_scipy(folder.path());
    ASSERT_EQ(judged.size(), 3U);
    const auto line = noisy_line(points, scatter);
    EXPECT_NEAR(line->slope, judged[0], 1e-5);
    EXPECT_NEAR(line->intercept, judged[1], 1e-5);
    EXPECT_NEAR(line->error, judged[2], 1e-5);
  }
}

/// Trials of a person whose stimuli and numbers scatter: six levels, four trials each.
void add_person(std::size_t person, double exponent, RandomStream& random,
                std::vector<MagnitudeTrial>& trials) {
  for (int level = 0; level < 6; ++level) {
    const double nominal = std::exp(0.4 * level);
    for (int k = 0; k < 4; ++k) {
      const double measured = nominal * std::exp(0.4 * random.normal());
      trials.push_back({person, nominal,
                        std::pow(nominal, exponent) * std::exp(0.3 * random.normal()), measured});
    }
  }
}

/// Each set is of one person. Counted is how often the interval holds the exponent.
TEST(ErrorsInVariablesTest, IntervalsHoldTheExponentAndItIsNotTooSmall) {
  constexpr int kSets = 1000;
  constexpr double kExponent = 1.4;
  int held = 0;
  double sum = 0.0, flat = 0.0;
  for (int set = 0; set < kSets; ++set) {
    RandomStream random(7, fmt::format("set {}", set));
    std::vector<MagnitudeTrial> trials;
    add_person(1, kExponent, random, trials);
    const auto law = power_law(trials);
    ASSERT_TRUE(law) << law.because();
    held += law->lines[0].low <= kExponent && kExponent <= law->lines[0].high ? 1 : 0;
    sum += law->exponent / kSets;
    double xy = 0.0, xx = 0.0;  // least squares over the same measured levels
    for (const MagnitudeLevel& level : law->levels) {
      xy += (std::log(level.measured) - 1.0) * std::log(level.mean);
      xx += (std::log(level.measured) - 1.0) * (std::log(level.measured) - 1.0);
    }
    flat += xy / xx / kSets;
  }
  std::printf("%d of %d intervals hold the exponent; mean %.3f, least squares %.3f\n", held, kSets,
              sum, flat);
  EXPECT_GE(held, 930);
  EXPECT_LE(held, 970);
  EXPECT_NEAR(sum, kExponent, 0.04);
  EXPECT_LT(flat, kExponent - 0.06);
}

/// Ten people whose exponents differ, in two conditions that do not.
TEST(ErrorsInVariablesTest, ExponentsOfConditionsThatDoNotDifferKeepTheLevel) {
  const int studies = std::getenv("HAPTRIAL_EVERY_STUDY") == nullptr ? 200 : 2000;
  std::size_t found = 0;
  for (int study = 0; study < studies; ++study) {
    RandomStream random(8, fmt::format("null {}", study));
    std::vector<std::vector<MagnitudeTrial>> trials(2);
    for (std::size_t person = 0; person < 10; ++person) {
      for (auto& condition : trials) {
        add_person(person, 1.0 + 0.1 * random.normal(), random, condition);
      }
    }
    const auto a = power_law(trials[0]), b = power_law(trials[1]);
    ASSERT_TRUE(a && b);
    found += paired_t_test(a->exponents, b->exponents, Tail::kTwoSided)->p < 0.05 ? 1 : 0;
  }
  std::printf("%zu of %d null studies below 5 %%\n", found, studies);
  const auto band = test::binomial_band(static_cast<std::size_t>(studies), 1.0 - 1e-4);
  EXPECT_GE(found, band.low);
  EXPECT_LE(found, band.high);
}

TEST(ErrorsInVariablesTest, WhatIsNotDefinedSaysWhy) {
  EXPECT_THAT(noisy_line(Points{{1, 1, 2}, {2, 2, 2}}, {0.0, 0.1}).because(),
              testing::HasSubstr("both directions"));
  EXPECT_THAT(noisy_line(Points{{1, 1, 2}, {1.01, 2, 2}, {0.99, 0, 2}}, {0.1, 0.1}).because(),
              testing::HasSubstr("than their errors"));
  EXPECT_THAT(
      power_law(std::vector<MagnitudeTrial>{{1, 1.0, 1.0, 1.1}, {1, 2.0, 2.0, 2.1}}).because(),
      testing::HasSubstr("presented twice"));
  EXPECT_THAT(power_law(std::vector<MagnitudeTrial>{{1, 1.0, 1.0, 1.1}, {1, 2.0, 2.0}}).because(),
              testing::HasSubstr("others were not"));
}

}  // namespace
}  // namespace haptrial::analysis::errors_in_variables_test
