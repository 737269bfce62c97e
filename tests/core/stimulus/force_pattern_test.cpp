#include "core/stimulus/force_pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/stimulus/stimulus.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::stimulus::force_pattern_test {
namespace {

constexpr double kDuration = 15.0;  // [s]
constexpr double kStep = 0.002;     // of the stored pattern [s]

ForcePattern drawn(std::uint64_t seed, const ForcePatternParameters& p = {},
                   double duration = kDuration) {
  RandomStream random(seed, "force_pattern");
  return {p, duration, random};
}

ForcePatternParameters sinusoids_only() {
  ForcePatternParameters p;
  p.bumps_min = p.bumps_max = 0;
  p.ramp = 0.0;
  return p;
}

std::vector<double> sampled(const ForcePattern& pattern) {
  const int steps = static_cast<int>(std::ceil(pattern.duration() / kStep));
  std::vector<double> forces;
  for (int i = 0; i <= steps; ++i) {
    forces.push_back(pattern.at(pattern.duration() * i / steps));
  }
  return forces;
}

TEST(ForcePatternTest, NeverLeavesItsRange) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const ForcePattern pattern = drawn(seed);
    const auto forces = sampled(pattern);
    const auto [low, high] = std::minmax_element(forces.begin(), forces.end());
    EXPECT_GE(*low, 0.0) << seed;
    EXPECT_LE(*high, 12.0) << seed;
    EXPECT_NEAR(pattern.peak(), *high, 1e-9) << seed;
  }
}

TEST(ForcePatternTest, TheSumOfSinusoidsFillsZeroToBaseMax) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const auto forces = sampled(drawn(seed, sinusoids_only()));
    const auto [low, high] = std::minmax_element(forces.begin(), forces.end());
    EXPECT_NEAR(*low, 0.0, 1e-9) << seed;
    EXPECT_NEAR(*high, 10.0, 1e-9) << seed;
  }
}

TEST(ForcePatternTest, TheSumOfSinusoidsTurnsNoOftenerThanItsBandLimitAllows) {
  int most = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto f = sampled(drawn(seed, sinusoids_only()));
    int extrema = 0;
    for (std::size_t i = 2; i < f.size(); ++i) {
      extrema += (f[i] > f[i - 1]) != (f[i - 1] > f[i - 2]);
    }
    EXPECT_LE(extrema, 2 * 0.2 * kDuration + 2) << seed;
    most = std::max(most, extrema);
  }
  EXPECT_GE(most, 4) << "the patterns do use their band";
}

TEST(ForcePatternTest, TheSumOfSinusoidsIsAsSmoothAsItsBandLimitSays) {
  // Bernstein: a function of |f| <= F that stays in [0, A] has slope <= pi F A. A finite stretch of
  // it may be steeper, by how much it would leave the range outside; a factor of 4 bounds these.
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto f = sampled(drawn(seed, sinusoids_only()));
    for (std::size_t i = 1; i < f.size(); ++i) {
      ASSERT_LT(std::abs(f[i] - f[i - 1]) / kStep, 4.0 * 3.1416 * 0.2 * 10.0) << seed;
    }
  }
}

TEST(ForcePatternTest, RampsUpAndDownLinearly) {
  ForcePatternParameters without;
  without.ramp = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto plain = sampled(drawn(seed, without));
    const auto ramped = sampled(drawn(seed));
    EXPECT_EQ(ramped.front(), 0.0);
    EXPECT_EQ(ramped.back(), 0.0);
    for (std::size_t i = 0; i < plain.size(); ++i) {
      const double t = kDuration * static_cast<double>(i) / static_cast<double>(plain.size() - 1);
      const double share = std::min({1.0, t, kDuration - t});  // ramps of one second
      ASSERT_NEAR(ramped[i], share * plain[i], 1e-9) << seed << " at " << t;
    }
  }
}

TEST(ForcePatternTest, ABumpChangesThePatternWithinItsWidthOnly) {
  ForcePatternParameters one = sinusoids_only();
  one.bumps_min = one.bumps_max = 1;
  int raised = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto base = sampled(drawn(seed, sinusoids_only()));
    const auto bumped = sampled(drawn(seed, one));
    int first = -1;
    int last = -1;
    double highest = 0.0;
    for (int i = 0; i < static_cast<int>(base.size()); ++i) {
      if (std::abs(bumped[i] - base[i]) > 1e-9) {
        first = first < 0 ? i : first;
        last = i;
      }
      highest = std::max(highest, bumped[i] - base[i]);
    }
    EXPECT_LE((last - first) * kStep, one.bump_width_max) << seed;
    raised += highest > 0.0;
    // A parabola over at least 0.6 s cannot rise faster than 4 · 12 N / 0.6 s on the base's slope.
    for (std::size_t i = 1; i < bumped.size(); ++i) {
      ASSERT_LT(std::abs(bumped[i] - bumped[i - 1]) / kStep, 4 * 12 / 0.6 + 26) << seed;
    }
  }
  EXPECT_EQ(raised, 200) << "a bump adds to the force where its centre is";
}

TEST(ForcePatternTest, BumpsReachAboveTheBaseAndTheirNumberVaries) {
  int above = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    above += drawn(seed).peak() > 10.0;
  }
  EXPECT_GT(above, 10);
  EXPECT_LT(above, 100);
}

TEST(ForcePatternTest, ShortPatternsHoldABumpAsLongAsThemselves) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto forces = sampled(drawn(seed, {}, 0.5));
    EXPECT_TRUE(std::all_of(forces.begin(), forces.end(), [](double f) {
      return f >= 0.0 && f <= 12.0;
    })) << seed;
  }
}

TEST(ForcePatternTest, GivenForcesAreJoinedByLines) {
  const ForcePattern pattern({0.0, 2.0, 1.0}, 4.0);
  EXPECT_EQ(pattern.at(0.0), 0.0);
  EXPECT_DOUBLE_EQ(pattern.at(1.0), 1.0);
  EXPECT_DOUBLE_EQ(pattern.at(2.0), 2.0);
  EXPECT_DOUBLE_EQ(pattern.at(3.0), 1.5);
  EXPECT_EQ(pattern.at(-1.0), 0.0);
  EXPECT_EQ(pattern.at(9.0), 1.0);
  EXPECT_EQ(pattern.at(std::numeric_limits<double>::quiet_NaN()), 0.0);
  EXPECT_EQ(pattern.peak(), 2.0);
  EXPECT_THROW(ForcePattern({1.0}, 1.0), std::invalid_argument);
  EXPECT_THROW(ForcePattern({1.0, 2.0}, 0.0), std::invalid_argument);
}

TEST(ForcePatternTest, AskingDoesNotAllocate) {
  const ForcePattern pattern = drawn(1);
  const test::AllocationGuard guard;
  double sum = 0.0;
  for (double t = -1.0; t < 16.0; t += 0.01) {
    sum += pattern.at(t);
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(sum, 0.0);
}

TEST(ForcePatternTest, ParametersAreReadWithTheirBounds) {
  const std::string text =
      "sinusoids = 4\nmax_frequency = 0.2\nbase_max = 10.0\nbumps_min = 2\nbumps_max = 4\n"
      "bump_max = 12.0\nbump_width_min = 0.6\nbump_width_max = 1.4\nramp = 1.0\n";
  const auto problems = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    Table t = Table::parse(changed, "f.toml");
    force_pattern_schema().read(t);
    try {
      t.finish();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(problems("4", "4"), "");
  EXPECT_EQ(problems("bumps_max = 4", "bumps_max = 1"),
            "f.toml:5: bumps_max is 1; allowed: at least bumps_min, 2");
  EXPECT_EQ(problems("12.0", "9.0"), "f.toml:6: bump_max is 9; allowed: at least base_max, 10 [N]");
  EXPECT_EQ(problems("1.4", "0.5"),
            "f.toml:8: bump_width_max is 0.5; allowed: at least bump_width_min, 0.6 [s]");
  EXPECT_EQ(problems("base_max = 10.0\n", ""),
            "f.toml:1: base_max is missing; allowed: a number above 0 and at most 100 [N]");
}

TEST(StimulusTest, IsAFunctionOfItsSeed) {
  const Stimulus a = make_stimulus({}, {}, 11);
  const Stimulus b = make_stimulus({}, {}, 11);
  const Stimulus c = make_stimulus({}, {}, 12);
  EXPECT_EQ(a.path.points(), b.path.points());
  EXPECT_EQ(sampled(a.force), sampled(b.force));
  EXPECT_NE(a.path.length(), c.path.length());
  EXPECT_NE(sampled(a.force), sampled(c.force));
}

TEST(StimulusTest, ForceLastsAsLongAsThePath) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Stimulus s = make_stimulus({}, {}, seed);
    EXPECT_EQ(s.force.duration(), s.path.duration());
  }
}

TEST(StimulusTest, ForceParametersLeaveThePathAlone) {
  ForcePatternParameters other;
  other.sinusoids = 9;
  EXPECT_EQ(make_stimulus({}, other, 3).path.points(), make_stimulus({}, {}, 3).path.points());
}

}  // namespace
}  // namespace haptrial::stimulus::force_pattern_test
