#include "analysis/force_training/exchange/import_checks.h"
#include "analysis/force_training/exchange/import_curves.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "analysis/force_training/report/report.h"
#include "analysis/force_training/score/score_parameters.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::exchange::import_checks_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

void ignore(std::uint64_t) {}

/// How a table of six good recalls at 100 Hz, of which one may be made otherwise, is written.
struct Recall {
  double to_time{1.0};   // factor of the times
  double to_force{1.0};  // factor of both forces
  double sign{1.0};      // of the applied force
  int step{1};           // every so many rows are kept
  int rows{600};
  bool constant_target{false};
  bool constant_applied{false};
  bool equal{false};
  bool gap{false};
  std::string subject{"A"};
  std::string condition{"haptic"};
};

constexpr int kTrials = 6;

class ImportChecksTest : public testing::Test {
 protected:
  /// The warnings about six recalls; `odd` changes some of them, counted from 1.
  std::vector<std::string> warnings(const std::function<void(int trial, Recall&)>& odd) {
    std::string text = "subject,trial,condition,time,target_force,applied_force\n";
    for (int trial = 1; trial <= kTrials; ++trial) {
      Recall recall;
      odd(trial, recall);
      for (int k = 0; k < recall.rows; k += recall.step) {
        const double t = 0.01 * k;
        const double late = recall.gap && k > 300 ? 1.0 : 0.0;
        const double target = recall.constant_target ? 5.0 : 5.0 + 3.0 * std::sin(1.7 * t + trial);
        const double applied =
            recall.constant_applied ? 4.0 : 4.5 + 2.5 * std::sin(1.7 * t + trial - 0.3);
        text += fmt::format("{},{},{},{},{},{}\n", recall.subject, trial, recall.condition,
                            recall.to_time * (t + late), recall.to_force * target,
                            recall.to_force * recall.sign * (recall.equal ? target : applied));
      }
    }
    std::ofstream(folder_ / "table.csv", std::ios::binary) << text;
    study_ = analyze_curves({{}, folder_ / "table.csv"}, {}, 1, ignore);
    return study_.remarks;
  }

  test::TemporaryFolder folder_;
  analysis::StudyResult study_;
};

TEST_F(ImportChecksTest, GoodCurvesGetNoWarning) {
  EXPECT_THAT(warnings([](int, Recall&) {}), IsEmpty());
}

TEST_F(ImportChecksTest, MillisecondsAreNotSeconds) {
  const auto found = warnings([](int, Recall& r) { r.to_time = 1000.0; });
  ASSERT_THAT(found, ElementsAre(StartsWith("WARNING: implausible times in 6 of 6 trials (")));
  EXPECT_THAT(found[0], HasSubstr("(A, trial 1: 5990 s with 0.1000 rows a second; A, trial 2: "));
  EXPECT_THAT(found[0], HasSubstr("; ...). Times are read as seconds and rates as hertz; are these "
                                  "milliseconds?"));
}

TEST_F(ImportChecksTest, MillinewtonsAreNotNewtons) {
  EXPECT_THAT(warnings([](int trial, Recall& r) { r.to_force = trial == 3 ? 1000.0 : 1.0; }),
              ElementsAre(AllOf(
                  StartsWith("WARNING: implausibly large forces in 1 of 6 trials (A, trial 3: "),
                  HasSubstr("target 8000 N, applied 7000 N"), HasSubstr("millinewtons"))));
  EXPECT_THAT(warnings([](int, Recall& r) { r.to_force = 1e-3; }),
              ElementsAre(StartsWith("WARNING: implausibly small forces in 6 of 6")));
}

TEST_F(ImportChecksTest, AReversedSignIsSeen) {
  EXPECT_THAT(warnings([](int, Recall& r) { r.sign = -1.0; }),
              ElementsAre(AllOf(StartsWith("WARNING: an applied force that mirrors the target "
                                           "force in 6 of 6 trials (A, trial 1: correlation -0."),
                                HasSubstr("opposite sign?"))));
}

TEST_F(ImportChecksTest, ForcesThatDoNotChangeOrAreTheSame) {
  EXPECT_THAT(warnings([](int trial, Recall& r) { r.constant_target = trial == 2; }),
              ElementsAre(StartsWith("WARNING: a target force that does not change in 1 of 6 "
                                     "trials (A, trial 2: 5.000 N).")));
  EXPECT_THAT(warnings([](int trial, Recall& r) { r.constant_applied = trial < 3; }),
              ElementsAre(StartsWith("WARNING: an applied force that does not change in 2 of 6")));
  EXPECT_THAT(warnings([](int trial, Recall& r) { r.equal = trial == 1; }),
              ElementsAre(StartsWith("WARNING: an applied force that equals the target force in "
                                     "every row in 1 of 6 trials (A, trial 1: 600 rows).")));
}

TEST_F(ImportChecksTest, AHandfulOfRowsAndOtherRates) {
  EXPECT_THAT(
      warnings([](int trial, Recall& r) { r.rows = trial == 4 ? 2 : 600; }),
      ElementsAre(StartsWith("WARNING: implausible times in 1 of 6 trials (A, trial 4: "),
                  StartsWith("WARNING: very few rows in 1 of 6 trials (A, trial 4: 2 rows)")));
  EXPECT_THAT(warnings([](int trial, Recall& r) { r.step = trial == 5 ? 2 : 1; }),
              ElementsAre(AllOf(StartsWith("WARNING: another sampling rate than in most trials in "
                                           "1 of 6 trials (A, trial 5: 50.00 rows a second, most "
                                           "100.0)"))));
  EXPECT_THAT(warnings([](int trial, Recall& r) { r.gap = trial == 5; }),
              testing::Contains(StartsWith("WARNING: gaps between two rows in 1 of 6 trials (A, "
                                           "trial 5: 1.010 s)")));
}

TEST_F(ImportChecksTest, NamesThatDifferInABlankOrACapital) {
  EXPECT_THAT(
      warnings([](int trial, Recall& r) { r.condition = trial == 1 ? "\"haptic \"" : "haptic"; }),
      ElementsAre("WARNING: the names of conditions differ only in blanks, hyphens, capitals or "
                  "zeros that change no number and are taken for different conditions: \"haptic\" "
                  "(5 trials), "
                  "\"haptic \" (1 trial)."));
  EXPECT_THAT(
      warnings([](int trial, Recall& r) { r.condition = trial == 1 ? "Haptic" : "haptic"; }),
      ElementsAre(HasSubstr("\"Haptic\" (1 trial), \"haptic\" (5 trials)")));
  EXPECT_THAT(warnings([](int trial, Recall& r) {
                r.condition = trial < 4 ? "visuo-haptic" : "visuo\u00a0haptic";
              }),
              testing::SizeIs(1));
  EXPECT_THAT(warnings([](int trial, Recall& r) { r.subject = trial == 1 ? "a" : "A"; }),
              ElementsAre(HasSubstr("names of participants differ only")));
  EXPECT_THAT(warnings([](int trial, Recall& r) { r.condition = trial < 4 ? "visual" : "haptic"; }),
              IsEmpty());
}

TEST_F(ImportChecksTest, TheReportHasTheWarnings) {
  warnings([](int, Recall& r) { r.sign = -1.0; });
  EXPECT_THAT(to_html(study_report(study_, {})),
              HasSubstr("WARNING: an applied force that mirrors"));
}

TEST_F(ImportChecksTest, CurvesOfDifferentLength) {
  const auto put = [&](const std::string& name, int rows) {
    std::string text = "time,force\n";
    for (int k = 0; k < rows; ++k) {
      text += fmt::format("{},{}\n", 0.01 * k, 5.0 + std::sin(0.02 * k));
    }
    std::ofstream(folder_ / name, std::ios::binary) << text;
  };
  put("target.csv", 1000);
  put("applied.csv", 300);
  std::ofstream(folder_ / "trials.csv")
      << "subject,trial,condition,target,applied\nA,1,haptic,target.csv,applied.csv\n";
  const auto study = analyze_curves({folder_.path(), folder_ / "trials.csv"}, {}, 1, ignore);
  EXPECT_THAT(study.remarks,
              ElementsAre(StartsWith("WARNING: target and applied force of different length in 1 "
                                     "of 1 trial (A, trial 1: target 9.990 s, applied 2.990 s).")));
}

}  // namespace
}  // namespace haptrial::exchange::import_checks_test
