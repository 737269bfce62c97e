// Thresholds over a second variable, compared between conditions, beside the lines that the
// simulated people have.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analysis/psychophysics/report/report_surfaces.h"
#include "analysis/psychophysics/study/trials_study.h"
#include "core/base/random.h"
#include "core/psychometric/procedure/quest_plus.h"
#include "core/psychometric/procedure/threshold_surface.h"
#include "tests/support/null_levels.h"

namespace haptrial::analysis::trials::surface_comparison_test {
namespace {

std::vector<double> even(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(from + (to - from) * i / (count - 1));
  }
  return values;
}

constexpr double kSpread = 0.15;

double share_of_yes(double x, double y, double offset, double slope) {
  const double z = (y - offset - slope * x) / kSpread;
  return 0.01 + 0.98 * 0.5 * std::erfc(-z / std::sqrt(2.0));
}

/// The threshold of y is a straight line over x.
psychometric::QuestDefinition line() {
  psychometric::QuestDefinition d;
  d.stimulus = {{"x", even(0.0, 1.0, 5), {}, false}, {"y", even(0.0, 2.0, 9), {}, false}};
  d.parameters = {{"offset", even(0.2, 1.6, 8), {}, false},
                  {"slope", even(-1.0, 1.0, 11), {}, false}};
  d.model = [](const double* s, const double* p, double* probability) {
    probability[1] = share_of_yes(s[0], s[1], p[0], p[1]);
    probability[0] = 1.0 - probability[1];
  };
  return d;
}

struct People {
  std::size_t count{8};
  int trials{40};                  // under each condition
  double offset{0.0}, slope{0.0};  // of "on" less "off"
  bool smooth{false};              // a surface without a formula is fitted, not a line
};

/// One trial of a person with a line.
StudyTrial answered(double x, double y, double offset, double slope, bool smooth,
                    RandomStream& random) {
  const double yes = random.uniform() < share_of_yes(x, y, offset, slope) ? 1.0 : 0.0;
  StudyTrial trial;
  trial.levels = {{"search", "x", x, x, yes}, {"search", "y", y, y, yes}};
  if (smooth) {  // its thresholds are of the first variable
    std::swap(trial.levels[0], trial.levels[1]);
  }
  return trial;
}

/// People differ in their lines, and in what the condition changes of them.
TrialsData data_of(const People& people, std::size_t study) {
  TrialsData data;
  const auto xs = even(0.0, 1.0, 5), ys = even(0.0, 2.0, 9);
  RandomStream random(study, "lines of people");
  for (std::size_t p = 0; p < people.count; ++p) {
    const std::string name = fmt::format("P{:02}", p + 1);
    data.sessions.push_back({name + ".h5", name, "", "simulated", true, false});
    const double offset = 0.8 + 0.1 * random.normal(), slope = 0.1 * random.normal();
    for (const bool on : {false, true}) {
      const double own_offset = offset + 0.05 * random.normal() + (on ? people.offset : 0.0);
      const double own_slope = slope + 0.05 * random.normal() + (on ? people.slope : 0.0);
      for (int i = 0; i < people.trials; ++i) {
        const double x = xs[static_cast<std::size_t>(random.uniform() * 5.0)];
        const double y = ys[static_cast<std::size_t>(random.uniform() * 9.0)];
        StudyTrial trial = answered(x, y, own_offset, own_slope, people.smooth, random);
        trial.session = p;
        trial.trial = static_cast<int>(data.trials.size()) + 1;
        trial.variables = {{"light", 0, kNotKnown, on ? "on" : "off"}};
        data.trials.push_back(std::move(trial));
      }
    }
  }
  return data;
}

std::unique_ptr<psychometric::Procedure> surface_of(const People& people) {
  if (people.smooth) {
    static const psychometric::ThresholdSurface begun(
        {.variables = {{"y", even(0.0, 2.0, 9), true}, {"x", even(0.0, 1.0, 5), false}}});
    return std::make_unique<psychometric::ThresholdSurface>(begun);
  }
  static const auto tables = std::make_shared<const psychometric::QuestTables>(line());
  return std::make_unique<psychometric::QuestPlus>(tables, psychometric::QuestStop{60, 0.0});
}

TrialsResult analyzed(const People& people, std::size_t study) {
  TrialsPlan plan;
  plan.kind = AnalysisKind::kPsychometric;
  plan.functions = true;
  plan.by = {"light"};
  plan.threshold_at = 0.5;
  plan.resamples = 0;
  plan.permutations = 0;
  plan.plan = parse_analysis_plan({"on != off"}, "", "tests");
  return analyze(
      data_of(people, study), plan, [&](const std::string&) { return surface_of(people); }, 1);
}

const Quantity& quantity_of(const TrialsResult& result, const std::string& name) {
  const auto found = std::ranges::find(result.quantities, name, &Quantity::name);
  EXPECT_NE(found, result.quantities.end()) << name;
  return *found;
}

const TTest& test_of(const TrialsResult& result, const std::string& name) {
  return *quantity_of(result, name).tests.planned.tests.front().t;
}

/// Over x from 0 to 1 a line has the mean offset + slope / 2.
TEST(SurfaceComparisonTest, DifferencesAreThoseOfThePeoplesLines) {
  const TrialsResult result = analyzed({.count = 8, .trials = 150, .offset = 0.1, .slope = 0.5}, 1);
  for (const auto& [name, truth] :
       {std::pair("surface_threshold", 0.1 + 0.5 * 0.5), {"surface_slope", 0.5}}) {
    const TTest& test = test_of(result, name);
    EXPECT_NEAR(test.difference, truth, 4.0 * test.error) << name;
    EXPECT_LT(test.error, 0.25 * truth) << name;
    EXPECT_LT(test.p, 0.05) << name;
  }
}

/// With HAPTRIAL_EVERY_STUDY 200 studies, or as many as it says; else none: a study takes more than
/// a second.
void count_null_studies(const People& people) {
  const char* asked = std::getenv("HAPTRIAL_EVERY_STUDY");
  if (asked == nullptr) {
    GTEST_SKIP() << "set HAPTRIAL_EVERY_STUDY=1 to count 200 null studies, which take minutes";
  }
  const std::size_t studies = std::max<std::size_t>(200, std::strtoul(asked, nullptr, 10));
  const int threads = studies > 200 ? 1 : 2;
  const auto levels = test::null_levels(studies, threads, [&](std::size_t number) {
    const TrialsResult result = analyzed(people, number);
    test::NullLevels noted;
    for (const char* name : {"surface_threshold", "surface_slope"}) {
      noted.note(name, true, test_of(result, name).p < 0.05);
    }
    return noted;
  });
  const auto band = test::binomial_band(studies, 1.0 - 1e-4);
  for (const auto& level : levels) {
    std::printf("%s: %zu of %zu\n", level.test.c_str(), level.found, level.replications);
    EXPECT_GE(level.found, band.low) << level.test;
    EXPECT_LE(level.found, band.high) << level.test;
  }
}

TEST(SurfaceComparisonTest, TestsOfLinesKeepTheirLevelInNullStudies) { count_null_studies({}); }

TEST(SurfaceComparisonTest, TestsOfSmoothSurfacesKeepTheirLevelInNullStudies) {
  count_null_studies({.smooth = true});
}

// --- three variables and four -------------------------------------------------------------------

struct Hyperplane {
  std::size_t others{2};  // variables beside the first
  int trials{40};
  double shift{0.0};  // of "on" less "off"
  double threshold(const std::vector<double>& level) const {
    double sum = 0.0;
    for (std::size_t k = 1; k < level.size(); ++k) {
      sum += level[k] - 0.5;
    }
    return 1.0 + 0.2 * sum;
  }
};

/// Eight people whose thresholds lie on planes that differ in height.
TrialsData data_of(const Hyperplane& plane, std::size_t study) {
  TrialsData data;
  const auto first = even(0.0, 2.0, 9), other = even(0.0, 1.0, 4);
  RandomStream random(study, "planes of people");
  for (std::size_t p = 0; p < 8; ++p) {
    const std::string name = fmt::format("P{:02}", p + 1);
    data.sessions.push_back({name + ".h5", name, "", "simulated", true, false});
    const double own = 0.1 * random.normal();
    for (const bool on : {false, true}) {
      const double height = own + 0.05 * random.normal() + (on ? plane.shift : 0.0);
      for (int i = 0; i < plane.trials; ++i) {
        std::vector<double> level{first[random.below(first.size())]};
        for (std::size_t k = 0; k < plane.others; ++k) {
          level.push_back(other[random.below(other.size())]);
        }
        const double yes =
            random.uniform() < share_of_yes(0.0, level[0], plane.threshold(level) + height, 0.0)
                ? 1.0
                : 0.0;
        StudyTrial trial;
        for (std::size_t k = 0; k < level.size(); ++k) {
          trial.levels.push_back({"search", std::string(1, "abcd"[k]), level[k], level[k], yes});
        }
        trial.session = p;
        trial.trial = static_cast<int>(data.trials.size()) + 1;
        trial.variables = {{"light", 0, kNotKnown, on ? "on" : "off"}};
        data.trials.push_back(std::move(trial));
      }
    }
  }
  return data;
}

TrialsResult analyzed(const Hyperplane& plane, std::size_t study,
                      const psychometric::ThresholdSurface& begun) {
  TrialsPlan plan;
  plan.kind = AnalysisKind::kPsychometric;
  plan.functions = true;
  plan.by = {"light"};
  plan.threshold_at = 0.5;
  plan.resamples = 0;
  plan.permutations = 0;
  plan.plan = parse_analysis_plan({"on != off"}, "", "tests");
  return analyze(
      data_of(plane, study), plan,
      [&](const std::string&) { return std::make_unique<psychometric::ThresholdSurface>(begun); },
      1);
}

psychometric::ThresholdSurface surface_of(const Hyperplane& plane) {
  psychometric::SurfaceParameters p{.variables = {{"a", even(0.0, 2.0, 9), true}}};
  for (std::size_t k = 0; k < plane.others; ++k) {
    p.variables.push_back({std::string(1, "bcd"[k]), even(0.0, 1.0, 4), false});
  }
  return psychometric::ThresholdSurface(p);
}

/// The mean of a plane over a symmetric grid is its height in the middle.
TEST(SurfaceComparisonTest, MeansOverTwoOtherVariablesDifferAsThePeoplesPlanesDo) {
  const Hyperplane plane{.others = 2, .trials = 120, .shift = 0.25};
  const TrialsResult result = analyzed(plane, 1, surface_of(plane));
  ASSERT_EQ(result.surfaces.front().placed.size(), 9u);
  const std::string table = surfaces_csv(result);
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(table, '\n')),
            1 + 9 * result.surfaces.size());
  EXPECT_NE(table.find(",\"b, c\",\"0, 0\",a,"), std::string::npos) << table.substr(0, 300);
  const TTest& test = test_of(result, "surface_threshold");
  EXPECT_NEAR(test.difference, 0.25, 4.0 * test.error);
  EXPECT_LT(test.error, 0.25 * 0.25);
}

void count_null_studies(const Hyperplane& plane) {
  const char* asked = std::getenv("HAPTRIAL_EVERY_STUDY");
  if (asked == nullptr) {
    GTEST_SKIP() << "set HAPTRIAL_EVERY_STUDY=1 to count 200 null studies, which take minutes";
  }
  const std::size_t studies = std::max<std::size_t>(200, std::strtoul(asked, nullptr, 10));
  const auto begun = surface_of(plane);
  std::size_t done = 0, found = 0;
  const auto levels = test::null_levels(studies, 1, [&](std::size_t number) {
    test::NullLevels noted;
    const TrialsResult result = analyzed(plane, number, begun);
    const bool below = test_of(result, "surface_threshold").p < 0.05;
    noted.note("surface_threshold", true, below);
    found += below ? 1 : 0;
    if (++done % 20 == 0) {
      std::printf("%zu of %zu\n", found, done);
      std::fflush(stdout);
    }
    return noted;
  });
  const auto band = test::binomial_band(studies, 1.0 - 1e-4);
  EXPECT_GE(levels.front().found, band.low);
  EXPECT_LE(levels.front().found, band.high);
}

TEST(SurfaceComparisonTest, TestsOfThreeVariablesKeepTheirLevelInNullStudies) {
  count_null_studies(Hyperplane{.others = 2});
}

TEST(SurfaceComparisonTest, TestsOfFourVariablesKeepTheirLevelInNullStudies) {
  count_null_studies(Hyperplane{.others = 3});
}

}  // namespace
}  // namespace haptrial::analysis::trials::surface_comparison_test
