#include "analysis/force_training/exchange/import_curves.h"
#include "analysis/force_training/study/study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "analysis/force_training/exchange/export_curves.h"
#include "analysis/force_training/report/report.h"
#include "analysis/force_training/report/study_json.h"
#include "analysis/force_training/score/score_parameters.h"
#include "analysis/force_training/score/scores_csv.h"
#include "core/base/error.h"
#include "tests/analysis/exchange/small_session.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::exchange::import_curves_test {
namespace {

namespace fs = std::filesystem;
using analysis::ScoreParameters;
using analysis::StudyResult;
using testing::HasSubstr;
using testing::Not;

void ignore(std::uint64_t) {}

class ImportCurvesTest : public testing::Test {
 protected:
  fs::path put(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  /// Table with both curves of a trial. @param offset  of the applied force [N]
  std::string curves(double offset, const char* heading = "time,target_force,applied_force\n") {
    std::string text = heading;
    for (int k = 0; k < 500; ++k) {
      char line[96];
      const double t = 7.0 + 0.01 * k;  // starts whenever the clock did
      const double target = 5.0 + 2.0 * std::sin(t);
      std::snprintf(line, sizeof line, "%.17g,%.17g,%.17g\n", t, target, target + offset);
      text += line;
    }
    return text;
  }

  StudyResult import(const std::string& table, int jobs = 1, CurveStudy study = {}) {
    study.folder = folder_.path();
    study.table = put("table.csv", table);
    return analyze_curves(study, {}, jobs, ignore);
  }

  std::string refusal(const std::string& table, CurveStudy study = {}) {
    try {
      import(table, 1, std::move(study));
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was refused";
  }

  test::TemporaryFolder folder_;
};

TEST_F(ImportCurvesTest, ExportedCurvesGetTheScoresOfTheirSessionFiles) {
  const std::vector<fs::path> files{folder_ / "a.h5", folder_ / "b.h5"};
  write_session(files[0], {.subject = "P01", .simulated = false, .trials = 6});
  write_session(files[1], {.subject = "P02", .simulated = true, .rate = 1000.0, .trials = 5});
  EXPECT_EQ(export_curves(files, folder_ / "out", {}, 2, ignore).trials, 11u);
  StudyResult theirs = analysis::analyze_study(files, {}, 1);
  for (analysis::TrialScore& score : theirs.scores) {
    EXPECT_TRUE(score.quality.test.saturation);
    score.quality = {};  // of which curves know nothing
  }
  const StudyResult ours =
      analyze_curves({folder_ / "out", folder_ / "out/conditions.csv"}, {}, 2, ignore);
  EXPECT_EQ(analysis::scores_csv(ours.scores), analysis::scores_csv(theirs.scores));
  EXPECT_TRUE(ours.simulated());
  ASSERT_EQ(ours.recalls.size(), 3u);
  EXPECT_EQ(ours.recalls[2].warped, theirs.recalls[2].warped);
  EXPECT_EQ(ours.recalls[2].pairs, theirs.recalls[2].pairs);
}

TEST_F(ImportCurvesTest, AConstantOffsetHasAKnownScore) {
  put("c/1.csv", curves(0.0));
  put("c/2.csv", curves(0.25));
  const auto study = import(
      "subject,trial,condition,file,block,repetition\n"
      "B,1,visual,c/2.csv,2,3\nA,2,haptic,c/1.csv,1,1\n");
  ASSERT_EQ(study.scores.size(), 2u);
  EXPECT_EQ(study.scores[0].subject, "A");
  EXPECT_EQ(study.scores[0].condition, "haptic");
  EXPECT_EQ(study.scores[1].block, 2);
  EXPECT_EQ(study.scores[1].repetition, 3);
  // The same curve but for the box filter, which takes sin(t) down by 1 - (0.1²/24).
  EXPECT_LT(study.scores[0].rms_unaligned, 2.0 * 0.01 / 24 * 1.1);
  EXPECT_NEAR(study.scores[1].rms_unaligned, 0.25, 1e-3);
  EXPECT_FALSE(study.simulated());
}

TEST_F(ImportCurvesTest, TimesOrARateGiveTheSame) {
  put("timed.csv", curves(0.5));
  std::string text = curves(0.5);
  std::string bare = "target_force,applied_force\n";
  for (auto line = text.find('\n') + 1; line < text.size(); line = text.find('\n', line) + 1) {
    const auto comma = text.find(',', line) + 1;
    bare += text.substr(comma, text.find('\n', line) + 1 - comma);
  }
  put("bare.csv", bare);
  const auto study =
      import("subject,trial,condition,file,rate\nA,1,haptic,timed.csv,\nA,2,haptic,bare.csv,100\n");
  ASSERT_EQ(study.scores.size(), 2u);
  EXPECT_GT(study.scores[0].score, 0.1);
  EXPECT_NEAR(study.scores[0].score, study.scores[1].score, 1e-9);
}

TEST_F(ImportCurvesTest, TwoFilesAndColumnsOfOtherNames) {
  put("wanted.csv", curves(0.0, "t_s,wanted_N,x\n"));
  put("pressed.csv", curves(0.5, "t_s,x,fz_N\n"));
  put("both.csv", curves(0.5));
  CurveStudy names;
  names.columns = ImportColumns({"time=t_s", "target_force=wanted_N", "applied_force=fz_N"});
  const auto two = import(
      "subject,trial,condition,target,applied\nA,1,haptic,wanted.csv,pressed.csv\n", 1, names);
  const auto one = import("subject,trial,condition,file\nA,1,haptic,both.csv\n");
  EXPECT_EQ(two.scores.at(0).score, one.scores.at(0).score);
}

TEST_F(ImportCurvesTest, TrainingIsNotScoredAndJobsDoNotMatter) {
  std::string table = "subject,trial,condition,phase,file,simulated\n";
  for (int trial = 1; trial <= 6; ++trial) {
    const auto name = std::to_string(trial) + ".csv";
    put(name, curves(0.1 * trial));
    table += "A," + std::to_string(trial) + ",haptic,training,absent.csv,1\n";
    table += "A," + std::to_string(trial) + ",haptic,test," + name + ",TRUE\n";
  }
  const auto one = import(table, 1);
  const auto three = import(table, 3);
  EXPECT_EQ(one.scores.size(), 6u);
  EXPECT_TRUE(one.simulated());
  EXPECT_EQ(analysis::scores_csv(one.scores), analysis::scores_csv(three.scores));
}

TEST_F(ImportCurvesTest, TheReportClaimsNothingThatIsNotThere) {
  put("1.csv", curves(0.1));
  put("2.csv", curves(0.3));
  const auto study = import("subject,trial,condition,file\nA,1,haptic,1.csv\nA,2,visual,2.csv\n");
  EXPECT_EQ(study.curves_from, "table.csv");
  const std::string report = to_html(study_report(study, {}));
  EXPECT_THAT(report, HasSubstr("The curves were not recorded by haptrial; table.csv says"));
  for (const char* absent : {"Tracking of the trajectory", "Timing of the servo loop", "Device",
                             "A stimulus", "Recorded by haptrial", "trained a force pattern"}) {
    EXPECT_THAT(report, Not(HasSubstr(absent)));
  }
  const std::string json = statistics_json(study);
  EXPECT_THAT(json, HasSubstr("\"curves_from\": \"table.csv\""));
  EXPECT_THAT(json, Not(HasSubstr("tracking")));
  EXPECT_THAT(json, Not(HasSubstr("timing")));
}

TEST_F(ImportCurvesTest, BadInputGetsASentence) {
  put("good.csv", curves(0.0));
  const std::string head = "subject,trial,condition,file\n";
  const std::string good = head + "A,1,haptic,good.csv\n";
  EXPECT_THAT(refusal("subject,trial,file\nA,1,good.csv\n"), HasSubstr("condition"));
  EXPECT_THAT(refusal(good + "A,1,visual,good.csv\n"), HasSubstr("table.csv:3: trial is '1'"));
  EXPECT_THAT(refusal(head + "A,1.5,haptic,good.csv\n"), HasSubstr("a whole number from 1"));
  EXPECT_THAT(refusal(head + "A,0,haptic,good.csv\n"), HasSubstr("table.csv:2: trial is '0'"));
  EXPECT_THAT(refusal(head + ",1,haptic,good.csv\n"), HasSubstr("table.csv:2: subject is ''"));
  EXPECT_THAT(refusal(head + "A,1,haptic,absent.csv\n"), HasSubstr("absent.csv"));
  EXPECT_THAT(refusal("subject,trial,condition,file,phase\nA,1,haptic,good.csv,exam\n"),
              HasSubstr("phase is 'exam'; allowed: test or training"));
  EXPECT_THAT(refusal("subject,trial,condition,file,phase\nA,1,haptic,good.csv,training\n"),
              HasSubstr("has no row of the phase test"));
  EXPECT_THAT(refusal("subject,trial,condition,file,rate\nA,1,haptic,good.csv,-5\n"),
              HasSubstr("rate is '-5'; allowed: a number above 0 [Hz]"));
  EXPECT_THAT(refusal("subject,trial,condition,file,simulated\nA,1,haptic,good.csv,maybe\n"),
              HasSubstr("true or false"));
  EXPECT_THAT(refusal("subject,trial,condition,file,target\nA,1,haptic,good.csv,good.csv\n"),
              HasSubstr("file, or both of the others"));
  CurveStudy names;
  names.columns = ImportColumns({"applied_force=force"});
  EXPECT_THAT(refusal(good, names), HasSubstr("force"));
  put("nan.csv", "time,target_force,applied_force\n0,1,1\n0.1,nan,1\n");
  EXPECT_THAT(refusal(head + "A,1,haptic,nan.csv\n"), HasSubstr("nan.csv:3"));
  put("back.csv", "time,target_force,applied_force\n0.1,1,1\n0.1,2,1\n");
  EXPECT_THAT(refusal(head + "A,1,haptic,back.csv\n"), HasSubstr("back.csv:3"));
}

TEST_F(ImportCurvesTest, PracticeIsNotExportedAndASessionWithoutPassesIsNoError) {
  const std::vector<fs::path> files{folder_ / "a.h5", folder_ / "b.h5"};
  write_session(files[0], {.subject = "P01", .trials = 2, .practice = 3});
  write_session(files[1], {.subject = "P02", .trials = 0});
  const CurvesSummary done = export_curves(files, folder_ / "out", {}, 1, ignore);
  EXPECT_EQ(done.trials, 2u);
  EXPECT_EQ(done.subjects, 2u);
  const StudyResult study =
      analyze_curves({folder_ / "out", folder_ / "out/conditions.csv"}, {}, 1, ignore);
  ASSERT_EQ(study.scores.size(), 2u);
  EXPECT_EQ(study.scores[0].block, 1);
}

TEST_F(ImportCurvesTest, TwoSessionsOfASubjectHaveNoCommonTable) {
  const std::vector<fs::path> files{folder_ / "a.h5", folder_ / "b.h5"};
  write_session(files[0], {});
  write_session(files[1], {.start_utc = "2026-11-21T09:30:00Z"});
  EXPECT_THROW(export_curves(files, folder_ / "out", {}, 1, ignore), InputError);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

}  // namespace
}  // namespace haptrial::exchange::import_curves_test
