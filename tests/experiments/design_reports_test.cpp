// Reports of studies whose design the force study cannot have, made from imported curves.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

using test::CommandResult;
using test::run_command;
using testing::HasSubstr;
using testing::Not;

class DesignReportsTest : public testing::Test {
 protected:
  /// Curves of six virtual subjects under three conditions.
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    const CommandResult made = run_command(
        fmt::format("haptrial dry-run '{}' --subjects 6 --trials 18 --out '{}' && "
                    "haptrial export --curves '{}' '{}'",
                    test::shipped_definition().string(), in("study"), in("curves"), in("study")));
    ASSERT_EQ(made.status, 0) << made.errors;
  }
  static void TearDownTestSuite() { folder_.reset(); }
  void TearDown() override { std::filesystem::remove_all(in("report")); }

  static std::string in(const std::string& name) { return (*folder_ / name).string(); }

  /// conditions.csv with one more column, and only the rows that `more` has a value for.
  std::string table(const std::string& column,
                    const std::function<std::string(int subject, const std::string& condition,
                                                    int repetition)>& more) {
    std::istringstream text(test::read_text(*folder_ / "curves/conditions.csv"));
    std::string line;
    std::getline(text, line);
    std::string all = fmt::format("{},{}\n", line, column);
    while (std::getline(text, line)) {
      std::vector<std::string> fields;
      std::istringstream row(line);
      for (std::string field; std::getline(row, field, ',');) {
        fields.push_back(field);
      }
      // subject,trial,condition,block,repetition,...
      const std::string value =
          more(std::stoi(fields[0].substr(1)), fields[2], std::stoi(fields[4]));
      if (!value.empty()) {
        all += fmt::format("{},{}\n", line, value);
      }
    }
    test::write_text(*folder_ / "table.csv", all);
    return in("table.csv");
  }

  /// The report, and statistics.json into `json_`.
  std::string report(const std::string& conditions, const std::string& options) {
    const CommandResult run =
        run_command(fmt::format("haptrial analyze --curves '{}' --conditions '{}' --out '{}' {}",
                                in("curves"), conditions, in("report"), options));
    EXPECT_EQ(run.status, 0) << run.errors;
    json_ = nlohmann::json::parse(test::read_text(*folder_ / "report/statistics.json"));
    return test::read_text(*folder_ / "report/report.md");
  }

  static std::unique_ptr<test::TemporaryFolder> folder_;
  nlohmann::json json_;
};
std::unique_ptr<test::TemporaryFolder> DesignReportsTest::folder_;

TEST_F(DesignReportsTest, BetweenParticipants) {
  const std::string text =
      report(table("note",
                   [](int subject, const std::string& condition, int) {
                     return condition == (subject <= 3 ? "haptic" : "visual") ? "kept" : "";
                   }),
             "--planned 'visual < haptic'");
  EXPECT_THAT(text, HasSubstr("(3 simulated participants, 18 trials)"));
  EXPECT_THAT(text, HasSubstr("36 scored recall trials of 6 participants under 2 conditions"));
  EXPECT_THAT(text, HasSubstr("Varied between participants: condition (haptic, visual)."));
  EXPECT_THAT(text, HasSubstr("Welch's analysis of variance"));
  EXPECT_THAT(text, HasSubstr("| U = "));
  EXPECT_THAT(text, Not(HasSubstr("paired t(")));
  EXPECT_THAT(text, Not(HasSubstr("balanced")));
  EXPECT_EQ(json_["conditions"][0]["participants"], 3);
  EXPECT_EQ(json_["participants_as_unit"]["planned"][0]["t_test"], "Welch");
  EXPECT_EQ(json_["participants_as_unit"]["planned"][0]["permutation"]["arrangements"], 20);
}

TEST_F(DesignReportsTest, Mixed) {
  const std::string text =
      report(table("group", [](int subject, const std::string&,
                               int) { return subject <= 3 ? "expert" : "novice"; }),
             "--factor group --factor condition --planned 'expert < novice'");
  EXPECT_THAT(text, HasSubstr("between participants: group (expert, novice)"));
  EXPECT_THAT(text, HasSubstr("mixed analysis of variance"));
  EXPECT_THAT(text, HasSubstr("- Effect of group × condition: "));
  EXPECT_THAT(text, HasSubstr("interaction.svg"));
  const auto& effects = json_["participants_as_unit"]["effects"];
  ASSERT_EQ(effects.size(), 3u);
  EXPECT_EQ(effects[0]["df_error"], 4.0);
  EXPECT_EQ(effects[2]["df_effect"], 2.0);
  EXPECT_EQ(effects[2]["df_error"], 8.0);
}

TEST_F(DesignReportsTest, TwoFactorsWithin) {
  const std::string text =
      report(table("practice", [](int, const std::string&,
                                  int repetition) { return repetition == 1 ? "first" : "later"; }),
             "--factor condition --factor practice --planned 'later < first'");
  EXPECT_THAT(text, HasSubstr("Varied within participants: condition (haptic, visual, visuohaptic) "
                              "and practice (first, later)."));
  EXPECT_THAT(text, HasSubstr("two-way repeated-measures analysis of variance"));
  EXPECT_THAT(text, HasSubstr("The planned tests were given to analyze, not stated in the"));
  const auto& effects = json_["participants_as_unit"]["effects"];
  ASSERT_EQ(effects.size(), 3u);
  EXPECT_EQ(effects[1]["df_effect"], 1.0);
  EXPECT_FALSE(effects[1].contains("greenhouse_geisser_epsilon"));  // nothing to correct
  EXPECT_TRUE(effects[0].contains("greenhouse_geisser_epsilon"));
}

TEST_F(DesignReportsTest, AnUnknownReferenceOfSessionsIsRefusedToo) {
  const CommandResult run =
      run_command(fmt::format("haptrial analyze '{}' --reference hap", in("study")));
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("the reference condition names 'hap'"));
  const CommandResult good =
      run_command(fmt::format("haptrial analyze '{}' --reference visual", in("study")));
  EXPECT_EQ(good.status, 0) << good.errors;
  EXPECT_THAT(good.output, HasSubstr("The reference condition was given to analyze"));
}

TEST_F(DesignReportsTest, APlannedTestOfAnUnknownConditionIsRefused) {
  const CommandResult run = run_command(
      fmt::format("haptrial analyze --curves '{}' --conditions '{}/conditions.csv' --out '{}' "
                  "--planned 'visula < haptic'",
                  in("curves"), in("curves"), in("report")));
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("names 'visula', which the data do not have; allowed: "
                                    "'haptic', 'visual', 'visuohaptic'"));
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "report"));
}

}  // namespace
}  // namespace haptrial
