// results/construct_validity is what its manifest gives: at reduced size, for all of it takes
// minutes.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/studies/drilling/simulated_rater.h"
#include "experiments/study/study_run.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/load_bones.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/null_study.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;

fs::path shipped() { return fs::path(HAPTRIAL_SOURCE_DIR) / "experiments/construct_validity.toml"; }

fs::path results() { return fs::path(HAPTRIAL_SOURCE_DIR) / "results/construct_validity"; }

nlohmann::json statistics() {
  return nlohmann::json::parse(test::read_text(results() / "statistics.json"));
}

struct Injured {
  int procedures{0};
  int of{0};
};

/// Procedures in which a vital structure was opened, by experts and by novices, as metrics.csv has
/// them.
std::array<Injured, 2> injured_procedures() {
  std::istringstream table(test::read_text(results() / "metrics.csv"));
  std::string line;
  std::getline(table, line);
  const auto cells_of = [](const std::string& text) {
    std::vector<std::string> cells;
    std::istringstream row(text);
    for (std::string cell; std::getline(row, cell, ',');) {
      cells.push_back(cell);
    }
    return cells;
  };
  const std::vector<std::string> names = cells_of(line);
  const auto column = [&names](const char* name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  std::array<Injured, 2> sides;
  while (std::getline(table, line)) {
    const std::vector<std::string> cells = cells_of(line);
    Injured& side = sides[cells.at(column("group")) == "novices" ? 1 : 0];
    ++side.of;
    side.procedures += std::stod(cells.at(column("injured_structures"))) > 0.0 ? 1 : 0;
  }
  return sides;
}

TEST(ValidityResultsTest, ExpertsRarelyInjureAndNovicesMoreOften) {
  const auto [experts, novices] = injured_procedures();
  ASSERT_EQ(experts.of, 16);
  ASSERT_EQ(novices.of, 14);
  EXPECT_LE(experts.procedures, 1);
  EXPECT_GE(novices.procedures, 4);
}

TEST(ValidityResultsTest, EveryMetricThatExpertsAreExpectedToLeadIsLedByThem) {
  int expected = 0;
  const nlohmann::json results = statistics();
  for (const nlohmann::json& metric : results["metrics"]) {
    const auto end = metric["experts_expected"].get<std::string>();
    if (end == "higher" || end == "lower") {
      ++expected;
      // The probability that an expert is on the expected side of a novice.
      EXPECT_GT(metric["contrast"]["roc"]["area"].get<double>(), 0.5) << metric["name"];
    }
  }
  EXPECT_GE(expected, 7);
}

TEST(ValidityResultsTest, ThePageOfVirtualSurgeonsHasTheFiguresOfTheResults) {
  const std::string page =
      test::read_text(fs::path(HAPTRIAL_SOURCE_DIR) / "docs/algorithms/virtual-surgeon.md");
  const nlohmann::json s = statistics();
  const auto mean_of = [&s](const std::string& group) {
    for (const nlohmann::json& one : s["ratings"]["groups"]) {
      if (one["group"] == group) {
        return one["over_participant_means"]["mean"].get<double>();
      }
    }
    return -1.0;
  };
  const auto r_of = [&s](const std::string& name) {
    for (const nlohmann::json& one : s["metrics"]) {
      if (one["name"] == name) {
        return one["rating_over_participant_means"]["r"].get<double>();
      }
    }
    return -2.0;
  };
  const auto [experts, novices] = injured_procedures();
  for (const std::string& said :
       {fmt::format("ratings {:.2f} of surgeons, {:.2f} of residents and {:.2f} of novices",
                    mean_of("surgeons"), mean_of("residents"), mean_of("novices")),
        fmt::format("surgeons and residents open a vital structure in {} of 16 procedures, novices "
                    "in {} of 14",
                    experts.procedures, novices.procedures),
        fmt::format("visible share and ratings R = {:.2f}", r_of("visible_share")),
        fmt::format("region R = {:.2f}", r_of("region_log_ratio")),
        fmt::format("all metrics for participants left out R = {:.2f}",
                    s["combined"]["fit"]["cross_validated"]["r"].get<double>())}) {
    EXPECT_THAT(page, testing::HasSubstr(said));
  }
}

TEST(ValidityResultsTest, TheFirstProcedureComesOutAgainAndIsRatedTheSame) {
  if (test::kThreadSanitizer || test::kAddressSanitizer) {
    GTEST_SKIP() << "a whole procedure takes too long under a sanitizer";
  }
  const fs::path folder = results();
  const auto manifest = nlohmann::json::parse(test::read_text(folder / "manifest.json"));
  EXPECT_TRUE(manifest["simulated"].get<bool>());
  const auto sum = [](const fs::path& file) {
    return test::run_command("sha256sum < '" + file.string() + "'").output.substr(0, 64);
  };
  EXPECT_EQ(sum(shipped()), manifest["definition_sha256"]);
  EXPECT_EQ(sum(folder / "metrics.csv"), manifest["metrics_sha256"]);
  EXPECT_THAT(test::read_text(folder / "report.html"), testing::HasSubstr("SIMULATED"));

  const test::TemporaryFolder out;
  protocols::BoneDefinition d = protocols::load_bone_definition(shipped());
  d.simulator.bleeding.rate = 1e-9;  // as the manifest's command: blood takes most of the time
  experiments::DryRun dry;
  dry.participants = 1;
  dry.max_trials = 1;
  dry.seed = manifest["seed"].get<std::uint64_t>();
  dry.folder = out / "study";
  experiments::run_dry(protocols::bone_drilling(), d, dry);
  // Ratings of the bone depend on its completeness, its injuries and its roughness.
  const std::string lines =
      analysis::drilling::ratings_csv(experiments::simulate_ratings(dry.folder, 1));
  std::istringstream again(lines);
  std::istringstream kept(test::read_text(folder / "ratings.csv"));
  std::string a;
  std::string b;
  int compared = 0;
  while (std::getline(again, a)) {
    ASSERT_TRUE(std::getline(kept, b));
    EXPECT_EQ(a, b) << "results/regenerate.sh construct_validity makes it anew";
    ++compared;
  }
  EXPECT_EQ(compared, 3);  // a head and two raters
}

TEST(ValidityResultsTest, ASmallNullStudyFindsLittle) {
  if (test::kThreadSanitizer || test::kAddressSanitizer) {
    GTEST_SKIP() << "60 procedures take too long under a sanitizer";
  }
  const test::TemporaryFolder out;
  test::NullStudy study;
  study.people = 30;
  study.runs = 40;
  const auto d = test::null_experiment(shipped(), out / "null", study);
  const test::NullFigures figures = test::null_study(d, out / "sessions", study);
  ASSERT_EQ(figures.ratings.size(), 30U);
  std::set<double> scores;
  for (const std::vector<double>& person : figures.ratings) {
    ASSERT_EQ(person.size(), 2U);
    scores.insert(person.begin(), person.end());
  }
  EXPECT_GE(scores.size(), 4U) << "ratings that are nearly all the same test nothing";
  // Experts are drawn anew for every run, so that the runs are independent given the people; more
  // than 8 of 40 has a chance below 1 in 1000 at 5 %.
  EXPECT_LE(figures.means, 8);
  EXPECT_LE(figures.mixed, 8);
}

}  // namespace
}  // namespace haptrial
