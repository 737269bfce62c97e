#include "analysis/tutoring/link_study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <cmath>

#include "analysis/tutoring/link_report.h"
#include "core/base/random.h"
#include "tests/support/null_levels.h"

namespace haptrial::analysis::link {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::size_t kStudies = 100;
const std::vector<std::string> kNetworks{"near", "middle", "far", "farther", "farthest"};

/// Passes of participants who differ, over networks of which none does but for `slope`.
/// @param slope  of the distance of the hands, as a share, for each network farther away
std::vector<LedPass> passes_of(int participants, double slope, std::uint64_t seed) {
  RandomStream random(seed, "passes");
  std::vector<LedPass> passes;
  for (int p = 0; p < participants; ++p) {
    const double own = std::exp(0.4 * random.normal());
    for (std::size_t trial = 0; trial < 3 * kNetworks.size(); ++trial) {
      const auto n = static_cast<double>(trial % kNetworks.size());
      LedPass led;
      led.subject = fmt::format("S{:02}", p + 1);
      led.pass.trial = static_cast<std::int32_t>(trial + 1);
      led.network = kNetworks[trial % kNetworks.size()];
      led.set_delay = 0.02 * n;
      led.apart = 0.006 * own * (1.0 + slope * n) * std::exp(0.3 * random.normal());
      led.coupling = 2.0 * own * std::exp(0.3 * random.normal());
      passes.push_back(led);
    }
  }
  return passes;
}

TEST(LinkStudyTest, ANetworkThatKeepsHandsApartIsFound) {
  const auto quantities = link_quantities(passes_of(12, 0.3, 1), kNetworks, {1, "test", 99, 1});
  ASSERT_EQ(quantities.size(), 2u);
  const LinkQuantity& apart = quantities[0];
  EXPECT_THAT(apart.table.names, ElementsAre("near", "middle", "far", "farther", "farthest"));
  ASSERT_TRUE(apart.tests.effects.front());
  EXPECT_LT(apart.tests.effects.front()->p, 1e-6);
  double ratio = 0.0;
  for (const auto& row : apart.table.means) {
    ratio += (*row[4] - *row[0]) / static_cast<double>(apart.table.means.size());
  }
  EXPECT_NEAR(ratio, std::log(1.0 + 4.0 * 0.3), 0.1) << "as it was put in";
  ASSERT_TRUE(quantities[1].tests.effects.front());
  EXPECT_GT(quantities[1].tests.effects.front()->p, 0.001) << "no network changes the force";
}

TEST(LinkStudyTest, OneNetworkIsNoCondition) {
  EXPECT_TRUE(link_quantities(passes_of(4, 0.0, 1), {"near"}, {1, "test", 0, 1}).empty());
}

/// Studies of 12 participants whose networks are alike: no test of the report finds more than
/// chance leaves with 99.9 %. Greenhouse and Geisser's correction, where none is needed, and Holm's
/// make theirs rarer (docs/algorithms/tutoring.md has 2,000 studies).
TEST(LinkStudyTest, EveryTestOfTheReportKeepsItsLevel) {
  const auto levels = test::null_levels(kStudies, 2, [](std::size_t study) {
    const auto quantities =
        link_quantities(passes_of(12, 0.0, 1000 + study), kNetworks, {study, "null", 0, 1});
    test::NullLevels found;
    for (const LinkQuantity& q : quantities) {
      found.note(q.title + ": F", false, q.tests.effects.front()->p < 0.05);
      found.note(q.title + ": Friedman", true, q.tests.ranks->p < 0.05);
      for (const TestFamily& family : q.tests.families) {
        bool any = false;
        for (const SideTest& test : family.tests) {
          any = any || *test.holm < 0.05;
        }
        found.note(q.title + ": " + family.name, false, any);
      }
    }
    return found;
  });
  const test::Band band = test::binomial_band(kStudies, 0.999);
  ASSERT_EQ(levels.size(), 6u);
  for (const test::NullLevel& level : levels) {
    EXPECT_EQ(level.replications, kStudies);
    EXPECT_LE(level.found, band.high) << level.test;
    EXPECT_GE(level.found, level.leads ? band.low : 1u) << level.test;
  }
}

TEST(LinkReportTest, SaysWhatIsSimulatedAndEscapesNames) {
  LinkStudy study;
  study.passes = passes_of(3, 0.0, 2);
  study.passes.front().subject = "<b>";
  study.simulated = true;
  study.networks = kNetworks;
  study.quantities = link_quantities(study.passes, study.networks, {1, "test", 99, 1});
  const Document report = link_report(study);
  const std::string html = to_html(report);
  EXPECT_THAT(html, HasSubstr("SIMULATED"));
  EXPECT_THAT(html, HasSubstr("&lt;b&gt;"));
  EXPECT_THAT(html, testing::Not(HasSubstr("<b></td>")));
  EXPECT_THAT(to_markdown(report), HasSubstr("| farthest | 9 |"));
  EXPECT_THAT(link_csv(study), HasSubstr("subject,session,trial,phase,condition,network,"));
}

}  // namespace
}  // namespace haptrial::analysis::link
