#include "analysis/psychophysics/report/report_hierarchical.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/psychophysics/report/trials_findings.h"
#include "analysis/psychophysics/study/trials_study.h"
#include "tests/analysis/psychophysics/simulated_trials.h"

namespace haptrial::analysis::trials {
namespace {

using test::SimulatedTask;
using test::SimulatedTrials;
using testing::HasSubstr;
using testing::Not;

/// Two conditions whose thresholds differ by 1 N, which is more than people differ.
TrialsResult hierarchical_result(int participants, int threads = 1) {
  SimulatedTrials study;
  study.task = SimulatedTask::kComparison;
  study.participants = participants;
  study.effect = 1.0;
  TrialsPlan plan = test::plan_of(study);
  plan.hierarchical = true;
  plan.population = plan.serial = plan.track_intervals = false;
  return analyze(test::simulated_trials(study), plan, {}, threads);
}

TEST(HierarchicalReportTest, StatesGroupAndPeopleWithTheirDiagnostics) {
  const TrialsResult result = hierarchical_result(5);
  ASSERT_TRUE(result.hierarchical && *result.hierarchical);
  const HierarchicalFunctions& all = **result.hierarchical;
  ASSERT_TRUE(all.fit.converged) << all.fit.r_hat << " " << all.fit.effective;
  EXPECT_EQ(all.conditions, (std::vector<std::string>{"off", "on"}));
  EXPECT_LT(all.fit.differences[0].threshold.low, 1.0);
  EXPECT_GT(all.fit.differences[0].threshold.high, 1.0);
  for (const FindingTable& table :
       {hierarchical_group_findings(result), hierarchical_people_findings(result)}) {
    ASSERT_FALSE(table.rows.empty());
    for (const FindingRow& row : table.rows) {
      for (const char* diagnostic : {"r_hat", "effective_draws"}) {
        EXPECT_EQ(std::ranges::count(row, diagnostic, &Finding::name), 1) << diagnostic;
      }
    }
  }
  EXPECT_EQ(hierarchical_people_findings(result).rows.size(), 10u);
  EXPECT_THAT(hierarchical_sentence(result), HasSubstr("R-hat at most"));
  EXPECT_THAT(hierarchical_sentence(result), HasSubstr("on less off"));
  EXPECT_THAT(estimates_csv(result), HasSubstr("hierarchical,threshold,"));
}

TEST(HierarchicalReportTest, ChainsThatHaveNotConvergedGiveNoNumbers) {
  TrialsResult result = hierarchical_result(3);
  ASSERT_TRUE(result.hierarchical && *result.hierarchical);
  HierarchicalFunctions all = **result.hierarchical;
  all.fit.converged = false;
  result.hierarchical = all;
  EXPECT_THAT(hierarchical_sentence(result), HasSubstr("have not converged"));
  EXPECT_THAT(hierarchical_sentence(result), Not(HasSubstr("threshold")));
  EXPECT_TRUE(hierarchical_group_findings(result).rows.empty());
  EXPECT_TRUE(hierarchical_people_findings(result).rows.empty());
}

TEST(HierarchicalReportTest, TwoParticipantsAreNoGroup) {
  const TrialsResult result = hierarchical_result(2);
  EXPECT_THAT(hierarchical_sentence(result), HasSubstr("fewer than three participants"));
  EXPECT_TRUE(hierarchical_group_findings(result).rows.empty());
}

TEST(HierarchicalReportTest, ThreadsChangeNothing) {
  EXPECT_EQ(estimates_csv(hierarchical_result(3, 1)), estimates_csv(hierarchical_result(3, 4)));
}

TEST(HierarchicalReportTest, WithoutTheKeyThereIsNoModel) {
  EXPECT_EQ(hierarchical_sentence(TrialsResult{}), "");
}

}  // namespace
}  // namespace haptrial::analysis::trials
