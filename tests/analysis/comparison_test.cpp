#include "analysis/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "analysis/scores_csv.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/random.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis {
namespace {

using testing::HasSubstr;

ScoredStudy study(const std::string& name, const std::vector<std::string>& subjects, double shift) {
  ScoredStudy s;
  s.name = name;
  RandomStream random(7, "scores");  // the same people in every study
  for (const std::string& subject : subjects) {
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
  EXPECT_NEAR(c.conditions[0].second->mean - c.conditions[0].first->mean, 0.2, 1e-12);
  EXPECT_GT(c.conditions[0].welch->p, 0.3) << "people differ by far more";
  EXPECT_NEAR(c.conditions[1].paired->difference, 0.001 / 6.0, 1e-9);
  EXPECT_NEAR(c.conditions[1].paired->t, 1.0, 1e-6) << "one of six differs";
  EXPECT_NEAR(c.conditions[1].paired->p, 0.363217, 1e-5) << "t(5) = 1, two-sided";
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
  EXPECT_THAT(comparison_lines(others)[2], HasSubstr("not defined"));
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
            "parameters": {"forces are compared over": "the path"}})");
  const ScoredStudy read = read_scored_study(folder_.path());
  EXPECT_TRUE(read.simulated);
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
  for (const std::string bad : {"{", "{}", "[1]", R"({"simulated": true, "parameters": {}})"}) {
    write("statistics.json", bad);
    EXPECT_THAT(problem(), HasSubstr("statistics.json: is not the statistics")) << bad;
  }
}

TEST_F(ScoredStudyTest, TheComparisonIsWrittenAsPageFigureAndNumbers) {
  ScoredStudy first = study("first<", {"S1", "S2", "S3"}, 0.0);
  first.simulated = true;
  ScoredStudy second = study("second", {"S1", "S2", "S3"}, 0.4);
  const StudyComparison c = compare_studies(first, second);
  write_comparison(c, folder_.path());
  const std::string html = file_text(folder_ / "comparison.html");
  EXPECT_THAT(html, HasSubstr("SIMULATED"));
  EXPECT_THAT(html, HasSubstr("first&lt;"));
  EXPECT_THAT(html, HasSubstr("<svg"));
  std::ifstream numbers(folder_ / "comparison.json");
  const auto json = nlohmann::json::parse(numbers);
  EXPECT_EQ(json["conditions"].size(), 2u);
  EXPECT_NEAR(json["conditions"][0]["second_participant_means"]["mean"].get<double>() -
                  json["conditions"][0]["first_participant_means"]["mean"].get<double>(),
              0.4, 1e-12);
}

}  // namespace
}  // namespace haptrial::analysis
