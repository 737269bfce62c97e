// Among people who do not differ every test that `haptrial statistics` prints finds a difference in
// one study of twenty at most, whether values are normal or ratings that tie.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/statistics/design/design_tests.h"
#include "core/base/random.h"
#include "tests/support/null_levels.h"

namespace haptrial::analysis {
namespace {

using test::NullLevels;

struct NullDesign {
  const char* name;
  std::vector<std::string> within, between;  // levels
  int people;                                // in each group
};

const std::vector<NullDesign> kDesigns{
    {"two conditions", {"a", "b"}, {"all"}, 12},
    {"three conditions", {"a", "b", "c"}, {"all"}, 7},
    {"four conditions", {"a", "b", "c", "d"}, {"all"}, 6},
    {"two groups", {"one"}, {"x", "y"}, 6},
    {"three groups", {"one"}, {"x", "y", "z"}, 3},
    {"two groups, two conditions", {"a", "b"}, {"x", "y"}, 6},
};

std::vector<Observation> observed(const NullDesign& design, bool ratings, RandomStream& random) {
  std::vector<Observation> all;
  for (const std::string& group : design.between) {
    for (int i = 0; i < design.people; ++i) {
      const double person = random.normal();
      for (const std::string& level : design.within) {
        const double value = person + random.normal();
        all.push_back({fmt::format("{}{}", group, i),
                       {level, group},
                       ratings ? std::clamp(std::round(value), -2.0, 2.0) : value});
      }
    }
  }
  return all;
}

void note(const DesignTests& tests, NullLevels& levels) {
  for (const auto& effect : tests.effects) {
    if (effect) {
      levels.note(effect->factor, true, effect->p <= 0.05);
    }
  }
  if (tests.ranks) {
    levels.note("on ranks", true, tests.ranks->p <= 0.05);
  }
  for (const TestFamily& family : tests.families) {
    for (const NamedTest& each : named_tests(family, family.name + ": ")) {
      levels.note(each.name, true, each.p <= 0.05);
    }
  }
}

TEST(NullDesigns, EveryTestKeepsItsLevel) {
  const std::size_t studies = test::null_studies(200);
  const auto band = test::binomial_band(studies, 1.0 - 1e-6);
  for (const NullDesign& design : kDesigns) {
    for (const bool ratings : {false, true}) {
      const auto levels = test::null_levels(studies, 2, [&](std::size_t number) {
        RandomStream random(number + 1, design.name);
        const auto table = design_table(observed(design, ratings, random), {"condition", "group"});
        NullLevels found;
        note(design_tests(table, {}, {1, "", 99, 1}), found);
        return found;
      });
      for (const test::NullLevel& level : levels) {
        RecordProperty(
            fmt::format("{}, {}: {}", design.name, ratings ? "ratings" : "normal", level.test),
            fmt::format("{} of {}", level.found, level.replications));
        EXPECT_LE(level.found, band.high) << design.name << ", " << level.test;
      }
    }
  }
}

}  // namespace
}  // namespace haptrial::analysis
