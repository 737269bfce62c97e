// The mixed model in the report and in statistics.json.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/force_training/report/report_parts.h"
#include "analysis/force_training/report/study_json.h"
#include "tests/analysis/force_training/example_study.h"
#include "tests/support/condition_null.h"

namespace haptrial::analysis::report_mixed_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Six participants, three conditions of two blocks of two trials.
test::Scores study(const test::Variances& variances) {
  test::Scores scores;
  for (const char* subject : {"P01", "P02", "P03", "P04", "P05", "P06"}) {
    for (int i = 0; i < 12; ++i) {
      TrialScore score;
      score.subject = subject;
      score.condition.assign(1, "abc"[i / 4]);
      score.block = 1 + i / 2;
      scores.push_back(score);
    }
  }
  RandomStream random(2, "report");
  return test::simulated(scores, random, variances);
}

std::string section(const test::Scores& scores) {
  StudyStatistics statistics;
  statistics.mixed = study_mixed(scores, {"a", "b", "c"});
  Document document;
  add_mixed(document, statistics);
  return to_markdown(document);
}

TEST(ReportMixed, NamesTheTermsAndComparesEveryTwoConditions) {
  const std::string text =
      section(study({.subject = 9.0, .cell = 4.0, .block = 2.0, .residual = 0.1}));
  EXPECT_THAT(text, AllOf(HasSubstr("over 72 trials"), HasSubstr("Do the conditions differ? F(2, "),
                          HasSubstr("a (mean)"), HasSubstr("a − b"), HasSubstr("b − c"),
                          HasSubstr("After Holm"), HasSubstr("Condition within participant"),
                          HasSubstr("subject:block"), Not(HasSubstr("A standard deviation of 0"))));
}

TEST(ReportMixed, SaysWhatAVarianceAtZeroMeansAndWhichTermsAreMissing) {
  auto scores = study({.subject = 9.0, .cell = 0.0, .block = 0.0, .residual = 1.0});
  EXPECT_THAT(section(scores), HasSubstr("A standard deviation of 0 means"));
  std::erase_if(scores, [n = 0](const auto&) mutable { return n++ % 2 == 1; });
  EXPECT_THAT(section(scores),
              HasSubstr("No term for the block within participant: each has a single trial."));
}

TEST(ReportMixed, StatisticsJsonHasTheTermsAndEveryTwoConditions) {
  const std::string json = statistics_json(example_study(false));
  EXPECT_THAT(json, AllOf(HasSubstr("\"formula\": \"score ~ condition + (1 | subject)"),
                          HasSubstr("\"lme4\": \"(1 | subject:condition)\""),
                          HasSubstr("\"df_denominator_satterthwaite\""),
                          HasSubstr("\"variance_residual\"")));
}

TEST(ReportMixed, SaysWhyThereIsNoModel) {
  EXPECT_THAT(section({}), HasSubstr("Not defined, because there are no trials."));
}

}  // namespace
}  // namespace haptrial::analysis::report_mixed_test
