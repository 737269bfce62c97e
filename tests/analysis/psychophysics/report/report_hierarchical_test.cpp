#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/psychophysics/report/report_apparatus.h"
#include "analysis/psychophysics/report/report_hierarchical.h"
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

// Levels as measured: what a certificate's gain makes of them.

namespace {

TEST(ReportApparatusTest, AMeasuredLevelHasTheUncertaintyOfBoth) {
  device::Certificate c;
  c.gain = 0.9;
  c.gain_low = 0.87;
  c.gain_high = 0.93;
  const Estimated exact = as_measured({100.0, 100.0, 100.0}, "N/m", c);
  EXPECT_NEAR(exact.value, 90.0, 1e-12);
  EXPECT_NEAR(exact.low, 87.0, 1e-12);
  EXPECT_NEAR(exact.high, 93.0, 1e-12);
  const Estimated both = as_measured({100.0, 100.0 - 4.0 / 0.9, 100.0 + 4.0 / 0.9}, "N/m", c);
  EXPECT_NEAR(both.low, 85.0, 1e-9) << "3 and 4 are 5";
  EXPECT_NEAR(both.high, 95.0, 1e-9);
  EXPECT_TRUE(std::isnan(as_measured({100.0}, "N/m", c).low)) << "an interval that is not known";
}

TEST(ReportApparatusTest, AForceLosesTheDeadZone) {
  device::CertifiedForce c;
  c.gain = c.gain_low = c.gain_high = 0.6;
  c.dead_zone = 0.004;
  EXPECT_NEAR(as_measured({0.02}, "N·m", c).value, 0.6 * 0.016, 1e-15);
  EXPECT_NEAR(as_measured({20.0}, "mN·m", c).value, 0.6 * 16.0, 1e-12);
  EXPECT_EQ(as_measured({0.003}, "N·m", c).value, 0.0);
  EXPECT_NEAR(as_measured({0.02}, "N·m/rad", c).value, 0.6 * 0.02, 1e-15) << "at large forces";
}

TEST(ReportApparatusTest, LevelsAreMeasuredByThePartThatTheyActOn) {
  device::Certificate c;
  c.gain = 0.9;
  c.rotation.emplace().gain = 0.6;
  c.grip.emplace().gain = 0.5;
  const std::string devices = "[devices.stylus]\n[devices.pinch]\ngrip_of = \"stylus\"\n";
  const std::string on_grip = "[fields.squeeze]\ntype = \"push\"\ndevice = \"pinch\"\n";
  const std::string on_tip = "[fields.hold]\ntype = \"push\"\ndevice = \"stylus\"\n";
  EXPECT_EQ(figures_of("N", c, devices).value().gain, 0.9);
  EXPECT_EQ(figures_of("N·m", c, devices).value().gain, 0.6);
  EXPECT_EQ(figures_of("N", c, devices + on_grip).value().gain, 0.5);
  EXPECT_EQ(figures_of("N/m", c, devices + on_tip).value().gain, 0.9);
  EXPECT_FALSE(figures_of("N", c, devices + on_grip + on_tip));
  c.rotation.reset();
  EXPECT_FALSE(figures_of("N·m", c, devices));
  EXPECT_FALSE(figures_of("m", c, devices));
}

TEST(ReportApparatusTest, OnlyLevelsThatGrowWithForceAreMeasured) {
  for (const char* unit : {"N", "mN", "N/m", "N·s/m"}) {
    EXPECT_TRUE(grows_with_force(unit)) << unit;
  }
  for (const char* unit : {"", "m", "Hz", "m/N", "degrees"}) {
    EXPECT_FALSE(grows_with_force(unit)) << unit;
  }
}

TEST(ReportApparatusTest, TheCertificateIsThatOfTheDefinition) {
  TrialsResult result;
  result.definition_name = "study.toml";
  result.definition = "[experiment]\nname = \"x\"\n";
  EXPECT_FALSE(certificate_of(result));
  EXPECT_TRUE(apparatus_findings(result).tables.empty());
  result.definition +=
      "[certificate]\nfile = \"arm.json\"\nchecksum = \"0123456789abcdef\"\ndevice = \"virtual\"\n"
      "gain = 0.87\ngain_low = 0.86\ngain_high = 0.88\n";
  const auto certificate = certificate_of(result);
  ASSERT_TRUE(certificate);
  EXPECT_EQ(certificate->gain, 0.87);
  EXPECT_FALSE(certificate->friction);
  EXPECT_EQ(apparatus_findings(result).tables.size(), 1u);
}

}  // namespace
}  // namespace haptrial::analysis::trials
