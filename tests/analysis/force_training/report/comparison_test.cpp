#include "analysis/force_training/report/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "analysis/force_training/score/scores_csv.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/random.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

ScoredStudy study(const std::string& name, const std::vector<std::string>& subjects, double shift) {
  ScoredStudy s;
  s.name = name;
  RandomStream random(7, "scores");  // the same people in every study
  for (const std::string& subject : subjects) {
    s.people.push_back({subject});
    const double person = random.normal();
    int trial = 0;
    for (const std::string condition : {"visual", "haptic"}) {
      for (int repetition = 1; repetition <= 3; ++repetition) {
        TrialScore score{subject, condition, ++trial, trial, repetition};
        score.score = 5.0 + person + 0.01 * repetition + (condition == "haptic" ? shift : 0.0);
        s.scores.push_back(score);
      }
    }
  }
  return s;
}

TEST(ComparisonTest, FindsADifferenceWithinPeopleThatLiesWithinTheirSpread) {
  const std::vector<std::string> people{"S1", "S2", "S3", "S4", "S5", "S6"};
  ScoredStudy second = study("later", people, 0.2);
  second.scores.front().score += 0.003;  // or the differences would have no variance
  const StudyComparison c = compare_studies(study("first", people, 0.0), second);
  ASSERT_EQ(c.conditions.size(), 2u);
  EXPECT_EQ(c.conditions[0].condition, "haptic");
  EXPECT_EQ(c.conditions[0].shared, 6u);
  EXPECT_NEAR(*c.conditions[0].second.value - *c.conditions[0].first.value, 0.2, 1e-12);
  EXPECT_GT(c.conditions[0].welch->p, 0.3) << "people differ by far more";
  EXPECT_NEAR(c.conditions[1].paired->difference, 0.001 / 6.0, 1e-9);
  EXPECT_NEAR(c.conditions[1].paired->t, 1.0, 1e-6) << "one of six differs";
  EXPECT_NEAR(c.conditions[1].paired->p, 0.363217, 1e-5) << "t(5) = 1, two-sided";
}

TEST(ComparisonTest, PairsStayPairsWhereTheirDifferencesDoNotVary) {
  const std::vector<std::string> people{"S1", "S2", "S3", "S4"};
  ScoredStudy second = study("b", people, 0.25);
  const StudyComparison c = compare_studies(study("a", people, 0.0), second);
  ASSERT_EQ(c.conditions[0].condition, "haptic");
  EXPECT_FALSE(c.conditions[0].paired);
  EXPECT_NEAR(c.conditions[0].shared_difference, 0.25, 1e-12);
  const auto lines = comparison_lines(c);
  EXPECT_THAT(lines[3], HasSubstr("difference within 4 participants 0.25"));
  EXPECT_THAT(lines[3], HasSubstr("; its interval and test are not defined, because the "
                                  "differences do not vary"));
  EXPECT_THAT(lines[3], Not(HasSubstr("between the means")));
  EXPECT_NEAR(
      nlohmann::json::parse(comparison_json(c))["conditions"][0]["shared_difference"].get<double>(),
      0.25, 1e-12);
}

TEST(ComparisonTest, OnlySharedPeopleArePaired) {
  const StudyComparison c =
      compare_studies(study("a", {"S1", "S2", "S3"}, 0.0), study("b", {"S2", "S3", "S9"}, 0.1));
  EXPECT_EQ(c.conditions[0].shared, 2u);
  const StudyComparison others =
      compare_studies(study("a", {"S1", "S2"}, 0.0), study("b", {"S8", "S9"}, 0.1));
  EXPECT_EQ(others.conditions[0].shared, 0u);
  EXPECT_FALSE(others.conditions[0].paired);
  EXPECT_TRUE(others.conditions[0].welch);
  EXPECT_THAT(
      comparison_lines(others)[2],
      testing::StartsWith("No participant is paired. Not paired: S1, S2 (only in a); S8, S9 "
                          "(only in b)."));
  EXPECT_THAT(comparison_lines(others)[3], HasSubstr("difference between the means"));
}

TEST(ComparisonTest, OnePersonHasAMeanAndOwnConditionsAreNamed) {
  ScoredStudy one = study("one", {"S1"}, 0.0);
  std::erase_if(one.scores, [](const TrialScore& score) { return score.condition == "visual"; });
  const auto lines =
      comparison_lines(compare_studies(study("four", {"S1", "S2", "S3", "S4"}, 0.0), one));
  EXPECT_EQ(lines[2], "Only in four, so not compared: visual.");
  EXPECT_THAT(lines[4], HasSubstr("(1 participant)"));
  EXPECT_THAT(lines[4], Not(HasSubstr("not defined (1 participant)")));
}

std::vector<Identity> virtual_people(const std::vector<std::string>& subjects, std::uint64_t seed) {
  std::vector<Identity> people;
  for (const std::string& subject : subjects) {
    people.push_back({subject, true, seed, {{"hand", "1a"}, {"subject", "2b"}}});
  }
  return people;
}

TEST(ComparisonTest, VirtualSubjectsArePairedBySeedAndPopulationToo) {
  const std::vector<std::string> all{"S1", "S2", "S3", "S4", "S5", "S6"};
  ScoredStudy first = study("a", all, 0.0);
  ScoredStudy second = study("b", all, 0.1);
  first.people = virtual_people(all, 1);
  second.people = virtual_people(all, 1);
  second.people[1].seed = 2;
  second.people[2].population["subject"] = "2c";
  second.people[3] = {"S4", false};
  second.people[4].seed.reset();
  second.people[5].population["pace"] = "3d";  // only one of the studies has a pace
  const StudyComparison c = compare_studies(first, second);
  EXPECT_THAT(c.paired, ElementsAre("S1", "S6"));
  EXPECT_EQ(c.conditions[0].shared, 2u);
  const std::string line = comparison_lines(c)[2];
  EXPECT_THAT(line, HasSubstr("Paired: 2 participants."));
  EXPECT_THAT(line, HasSubstr("S2 (virtual subjects of different seeds: 1 and 2)"));
  EXPECT_THAT(line, HasSubstr("S3 (virtual subjects of different populations: [subject]"));
  EXPECT_THAT(line, HasSubstr("S4 (a virtual subject in one study, a person in the other)"));
  EXPECT_THAT(line, HasSubstr("S5 (virtual subjects of unknown seed)"));
  const auto json = nlohmann::json::parse(comparison_json(c));
  EXPECT_EQ(json["paired_participants"].size(), 2u);
  EXPECT_EQ(json["not_paired"].size(), 4u);
}

TEST(ComparisonTest, ScoresOfDifferentParametersAreRefusedOrAlarmed) {
  ScoredStudy first = study("a", {"S1", "S2"}, 0.0);
  ScoredStudy second = study("b", {"S1", "S2"}, 0.1);
  first.parameters = {{"filter", "0.1 s"}, {"samples", "1000"}};
  second.parameters = {{"filter", "0.2 s"}, {"samples", "1000"}, {"window", "1 s"}};
  try {
    compare_studies(first, second);
    FAIL() << "nothing was refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("(filter: 0.1 s and 0.2 s; window: as published and 1 s)"));
    EXPECT_THAT(error.what(), HasSubstr("--different-scoring"));
    EXPECT_THAT(error.what(), Not(HasSubstr("samples")));
  }
  const StudyComparison c = compare_studies(first, second, Scoring::kMayDiffer);
  ASSERT_EQ(comparison_alarms(c).size(), 1u);
  EXPECT_THAT(comparison_alarms(c)[0], testing::StartsWith("DIFFERENT SCORING: "));
  EXPECT_THAT(comparison_json(c), HasSubstr("\"parameter\": \"filter\""));
  first.parameters = second.parameters;
  EXPECT_THAT(comparison_alarms(compare_studies(first, second)), testing::IsEmpty());
}

TEST(ComparisonTest, OverThePathAgainstOverTimeIsSaid) {
  const ScoredStudy first = study("guided", {"S1", "S2"}, 0.0);
  ScoredStudy second = study("free", {"S1", "S2"}, 0.1);
  second.own_pace = true;
  const auto lines = comparison_lines(compare_studies(first, second));
  EXPECT_THAT(lines[2], HasSubstr("free compares forces over the place on the path, guided over "
                                  "time."));
  second.own_pace = false;
  EXPECT_THAT(comparison_lines(compare_studies(first, second))[2], HasSubstr("Paired: 2"));
}

TEST(ComparisonTest, EveryPIsAdjustedOverTheConditions) {
  const std::vector<std::string> people{"S1", "S2", "S3", "S4", "S5", "S6"};
  ScoredStudy second = study("later", people, 0.2);
  RandomStream random(3, "noise");
  for (TrialScore& s : second.scores) {
    s.score += 0.2 * random.normal();
  }
  const StudyComparison c = compare_studies(study("first", people, 0.0), second);
  const auto expect_holm = [&](auto test, auto holm) {
    const double low = std::min((c.conditions[0].*test)->p, (c.conditions[1].*test)->p);
    const double high = std::max((c.conditions[0].*test)->p, (c.conditions[1].*test)->p);
    const bool first_is_low = (c.conditions[0].*test)->p == low;
    EXPECT_NEAR(*(c.conditions[first_is_low ? 0 : 1].*holm), std::min(1.0, 2.0 * low), 1e-15);
    EXPECT_NEAR(*(c.conditions[first_is_low ? 1 : 0].*holm),
                std::max(std::min(1.0, 2.0 * low), high), 1e-15);
  };
  expect_holm(&ConditionComparison::paired, &ConditionComparison::paired_holm);
  expect_holm(&ConditionComparison::welch, &ConditionComparison::welch_holm);
  const auto json = nlohmann::json::parse(comparison_json(c));
  EXPECT_EQ(json["conditions"][0]["welch_p_holm"].get<double>(), *c.conditions[0].welch_holm);
}

TEST(ComparisonTest, LinesCountThoseWhoHaveTheCondition) {
  ScoredStudy first = study("a", {"S1", "S2", "S3", "S4"}, 0.0);
  std::erase_if(first.scores, [](const TrialScore& s) {  // groups between participants
    return (s.condition == "haptic") !=
           (s.subject == "S1" || s.subject == "S2" || s.subject == "S3");
  });
  ScoredStudy second = study("b", {"S1", "S2", "S3", "S4", "S5"}, 0.1);
  first.people = virtual_people({"S1", "S2", "S3", "S4"}, 1);
  second.people[0] = virtual_people({"S1"}, 1)[0];
  const StudyComparison c = compare_studies(first, second);
  const auto lines = comparison_lines(c);
  EXPECT_THAT(lines[0], HasSubstr("a: 4 simulated participants, 12 scored trials"));
  EXPECT_THAT(lines[1], HasSubstr("b: 5 participants, 1 of them simulated, 30 scored trials"));
  EXPECT_THAT(lines[3], testing::ContainsRegex("Haptic: .* \\(3 participants\\) and .* "
                                               "\\(5 participants\\)"));
  EXPECT_THAT(lines[4], testing::ContainsRegex("Visual: .* \\(1 participant\\) and"));
  EXPECT_THAT(comparison_alarms(c).at(0), HasSubstr("SIMULATED PARTICIPANTS"));
}

TEST(ComparisonTest, StudiesWithoutACommonConditionAreRefused) {
  ScoredStudy other = study("b", {"S1"}, 0.0);
  for (TrialScore& s : other.scores) {
    s.condition = "olfactory";
  }
  EXPECT_THROW(compare_studies(study("a", {"S1"}, 0.0), other), InputError);
}

class ScoredStudyTest : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string problem() {
    try {
      read_scored_study(folder_.path());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  test::TemporaryFolder folder_;
};

TEST_F(ScoredStudyTest, IsReadFromWhatAnalyzeWrote) {
  auto scores = study("x", {"S,1", "S\"2\nb"}, 0.3).scores;
  scores[0].score = 0.1 + 0.2;
  write("scores.csv", scores_csv(scores));
  write("statistics.json",
        R"({"simulated": true, "sessions": [{"definition": "study.toml"}],
            "identities": [{"subject": "S,1", "simulated": true, "seed": 18446744073709551615,
                            "population": {"hand": "0f"}},
                           {"subject": "S\"2\nb", "simulated": false}],
            "parameters": {"forces are compared over": "the path", "samples": "1000"}})");
  const ScoredStudy read = read_scored_study(folder_.path());
  EXPECT_TRUE(read.simulated());
  ASSERT_EQ(read.people.size(), 2u);
  EXPECT_EQ(read.people[0].seed, 18446744073709551615u);
  EXPECT_EQ(read.people[0].population.at("hand"), "0f");
  EXPECT_FALSE(read.people[1].simulated);
  EXPECT_EQ(read.parameters.size(), 1u);
  EXPECT_TRUE(read.own_pace);
  ASSERT_EQ(read.scores.size(), scores.size());
  for (std::size_t i = 0; i < scores.size(); ++i) {
    EXPECT_EQ(read.scores[i].subject, scores[i].subject);
    EXPECT_EQ(read.scores[i].condition, scores[i].condition);
    EXPECT_EQ(read.scores[i].repetition, scores[i].repetition);
    EXPECT_EQ(read.scores[i].score, scores[i].score);
  }
  EXPECT_EQ(read.name, "study");
  const StudyComparison same = compare_studies(read, read);
  EXPECT_NE(same.first.name, same.second.name);
}

TEST_F(ScoredStudyTest, ImportedCurvesAreComparedToo) {
  const ScoredStudy given = study("x", {"S1"}, 0.0);
  write("scores.csv", scores_csv(given.scores));
  write("statistics.json", R"({"curves_from": "pilot-table.csv", "parameters": {},
                               "identities": [{"subject": "S1", "simulated": false}]})");
  EXPECT_EQ(read_scored_study(folder_.path()).name, "pilot-table");
}

TEST_F(ScoredStudyTest, WhatIsNoneGetsASentence) {
  EXPECT_THAT(problem(), HasSubstr("scores.csv: cannot be read"));
  const std::string heading = scores_csv({});
  for (const std::string bad :
       {"", "a,b,c\n", "S1,1,1,1,visual,x,0,0,0,0\n", "S1,1,1,1,visual,1,0,0,0\n",
        "S1,1,1,1,visual,1,0,0,0,0", "S1,1,1,1,visual,inf,0,0,0,0\n", "\"S1,1\n"}) {
    const bool is_row = bad.size() > 8;
    write("scores.csv", (is_row ? heading : "") + bad);
    EXPECT_THAT(problem(), HasSubstr(is_row ? "scores.csv:2: " : "scores.csv:1: ")) << bad;
    EXPECT_THAT(problem(), testing::Not(HasSubstr("\n"))) << bad;
  }
  write("scores.csv", scores_csv(study("x", {"S1"}, 0.0).scores));
  EXPECT_THAT(problem(), HasSubstr("statistics.json: cannot be read"));
  for (const std::string bad : {"{", "{}", "[1]", R"({"identities": [], "parameters": {}})"}) {
    write("statistics.json", bad);
    EXPECT_THAT(problem(), HasSubstr("statistics.json: is not the statistics")) << bad;
  }
  write("statistics.json", R"({"simulated": true, "parameters": {}})");
  EXPECT_THAT(problem(), HasSubstr("older haptrial"));
  write("statistics.json", R"({"curves_from": "table.csv", "identities": [], "parameters": {}})");
  EXPECT_THAT(problem(), HasSubstr("does not list participant S1"));
}

TEST_F(ScoredStudyTest, TheComparisonIsWrittenAsPageFigureAndNumbers) {
  ScoredStudy first = study("first<", {"S1", "S2", "S3"}, 0.0);
  first.people = virtual_people({"S1", "S2", "S3"}, 1);
  ScoredStudy second = study("second", {"S1", "S2", "S3"}, 0.4);
  const StudyComparison c = compare_studies(first, second);
  write_comparison(c, folder_.path());
  const std::string html = file_text(folder_ / "comparison.html");
  EXPECT_THAT(html, HasSubstr("SIMULATED"));
  EXPECT_THAT(html, HasSubstr("first&lt;"));
  EXPECT_THAT(html, HasSubstr("<svg"));
  EXPECT_THAT(html, HasSubstr("Adjusted p"));
  EXPECT_EQ(html.find("<h2>Within participants"), html.npos) << "nobody is paired";
  second.people = first.people;
  write_comparison(compare_studies(first, second), folder_.path());
  EXPECT_NE(file_text(folder_ / "comparison.html").find("<h2>Within participants"), html.npos);
  std::ifstream numbers(folder_ / "comparison.json");
  const auto json = nlohmann::json::parse(numbers);
  EXPECT_EQ(json["conditions"].size(), 2u);
  EXPECT_NEAR(json["conditions"][0]["second_participant_means"]["mean"].get<double>() -
                  json["conditions"][0]["first_participant_means"]["mean"].get<double>(),
              0.4, 1e-12);
}

}  // namespace
}  // namespace haptrial::analysis
