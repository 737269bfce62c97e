// One table with a row for each sample, columns of other names, and factors.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "analysis/force_training/exchange/import_curves.h"
#include "analysis/force_training/score/score_parameters.h"
#include "analysis/force_training/score/scores_csv.h"
#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::exchange::import_table_test {
namespace {

namespace fs = std::filesystem;
using analysis::StudyResult;
using testing::ElementsAre;
using testing::HasSubstr;

void ignore(std::uint64_t) {}

constexpr int kRows = 300;

/// The rows "TRIAL,time,target,applied" of a recall. @param offset  of the applied force [N]
std::string samples(const std::string& trial, double offset) {
  std::string text;
  for (int k = 0; k < kRows; ++k) {
    const double t = 0.01 * k;
    const double target = 5.0 + 2.0 * std::sin(3.0 * t);
    text += fmt::format("{},{},{},{}\n", trial, t, target, target + offset);
  }
  return text;
}

class ImportTableTest : public testing::Test {
 protected:
  fs::path put(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  StudyResult import(const std::string& text, const std::vector<std::string>& columns = {},
                     const std::vector<std::string>& factors = {}) {
    const CurveStudy study{{}, put("table.csv", text), ImportColumns(columns), factors};
    return analyze_curves(study, {}, 2, ignore);
  }

  std::string refusal(const std::string& text, const std::vector<std::string>& columns = {},
                      const std::vector<std::string>& factors = {}) {
    try {
      import(text, columns, factors);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was refused";
  }

  test::TemporaryFolder folder_;
};

const std::string kHead = "subject,trial,condition,time,target_force,applied_force\n";

TEST_F(ImportTableTest, GivesTheScoresOfAFileATrial) {
  const StudyResult one = import(kHead + samples("A,1,haptic", 0.1) + samples("A,2,visual", 0.4) +
                                 samples("B,1,visual", 0.2));
  std::string table = "subject,trial,condition,file\n";
  for (const auto& [trial, offset] :
       {std::pair{"A,1,haptic", 0.1}, std::pair{"A,2,visual", 0.4}, std::pair{"B,1,visual", 0.2}}) {
    const std::string name = fmt::format("{}.csv", offset);
    put(name, kHead + samples(trial, offset));
    table += fmt::format("{},{}\n", trial, name);
  }
  const CurveStudy files{folder_.path(), put("trials.csv", table)};
  const StudyResult many = analyze_curves(files, {}, 1, ignore);
  ASSERT_EQ(one.scores.size(), 3u);
  EXPECT_EQ(analysis::scores_csv(one.scores), analysis::scores_csv(many.scores));
  EXPECT_EQ(one.curves_from, "table.csv");
  EXPECT_THAT(one.remarks, testing::IsEmpty());
  EXPECT_THAT(one.factors, ElementsAre("condition"));
  EXPECT_THAT(one.scores[0].levels, ElementsAre("haptic"));
}

TEST_F(ImportTableTest, RowsOfTrialsMayAlternateAndTrainingIsPassedOver) {
  const std::string head = "subject,trial,condition,phase,time,target_force,applied_force\n";
  std::string rows;
  for (int k = 0; k < kRows; ++k) {
    for (const char* subject : {"A", "B"}) {
      rows += fmt::format("{0},1,haptic,training,{1},,\n{0},1,haptic,test,{1},{2},{3}\n", subject,
                          0.01 * k, std::sin(0.03 * k), std::sin(0.03 * k + 0.1));
    }
  }
  const StudyResult study = import(head + rows);
  ASSERT_EQ(study.scores.size(), 2u);
  EXPECT_GT(study.scores[0].score, 0.0);
  EXPECT_EQ(study.scores[0].score, study.scores[1].score);
}

TEST_F(ImportTableTest, ColumnsMayHaveOtherNames) {
  const StudyResult ours = import(kHead + samples("A,1,haptic", 0.3));
  const StudyResult theirs =
      import("Participant,No,Training,t/s,F*,F\n" + samples("A,1,haptic", 0.3),
             {"subject=Participant", "trial=No", "condition=Training", "time=t/s",
              "target_force=F*", "applied_force=F"});
  EXPECT_EQ(ours.scores.at(0).score, theirs.scores.at(0).score);
  EXPECT_EQ(theirs.scores[0].condition, "haptic");
  EXPECT_THAT(theirs.factors, ElementsAre("Training"));
}

TEST_F(ImportTableTest, SeveralFactorsMakeTheCondition) {
  const std::string head = "subject,trial,training,age,time,target_force,applied_force\n";
  const std::string rows = samples("A,1,haptic,young", 0.3) + samples("B,1,visual,old", 0.1);
  const StudyResult study = import(head + rows, {}, {"training", "age"});
  ASSERT_EQ(study.scores.size(), 2u);
  EXPECT_THAT(study.factors, ElementsAre("training", "age"));
  EXPECT_EQ(study.scores[0].condition, "haptic, young");
  EXPECT_THAT(study.scores[1].levels, ElementsAre("visual", "old"));
  EXPECT_THAT(analysis::scores_csv(study.scores, study.factors),
              HasSubstr("\nA,1,1,1,\"haptic, young\",haptic,young,"));
  const StudyResult single = import(head + rows, {}, {"age"});
  EXPECT_EQ(single.scores[0].condition, "young");
}

TEST_F(ImportTableTest, ARateStandsInPlaceOfTimes) {
  std::string rows;
  for (int k = 0; k < kRows; ++k) {
    const double target = 5.0 + 2.0 * std::sin(3.0 * 0.01 * k);
    rows += fmt::format("A,1,haptic,100,{},{}\n", target, target + 0.3);
  }
  const StudyResult even =
      import("subject,trial,condition,rate,target_force,applied_force\n" + rows);
  const StudyResult timed = import(kHead + samples("A,1,haptic", 0.3));
  EXPECT_NEAR(even.scores.at(0).score, timed.scores.at(0).score, 1e-9);
}

TEST_F(ImportTableTest, BadInputGetsASentence) {
  const std::string good = kHead + samples("A,1,haptic", 0.3);
  EXPECT_THAT(refusal("who,trial,condition,time,target_force,applied_force\n"
                      "A,1,haptic,0,1,1\n"),
              HasSubstr("there is no column 'subject'; name one of who, trial, condition, time, "
                        "target_force, applied_force with --column subject=NAME"));
  EXPECT_THAT(refusal(good, {"subject=Participant"}), HasSubstr("no column 'Participant'"));
  EXPECT_THAT(refusal(good, {"participant=subject"}),
              HasSubstr("--column names 'participant', which no import reads; allowed: subject, "));
  for (const char* form : {"subject", "=a", "subject="}) {
    EXPECT_THAT(refusal(good, {form}), HasSubstr("allowed: COLUMN=NAME")) << form;
  }
  EXPECT_THAT(refusal(good, {"time=a", "time=b"}), HasSubstr("names time twice"));
  EXPECT_THAT(refusal(good, {}, {"condition", "condition"}), HasSubstr("names condition twice"));
  EXPECT_THAT(refusal(good, {}, {"age"}), HasSubstr("no column 'age'"));
  EXPECT_THAT(refusal(good, {"condition=time"}, {"condition"}), HasSubstr("with --factor"));
  EXPECT_THAT(refusal(good + "A,1,haptic,0,1,1\n"),
              HasSubstr("table.csv:302: time is '0'; allowed: above 2.99, the time of line 301"));
  EXPECT_THAT(refusal(good + "A,1,visual,9,1,1\n"),
              HasSubstr("table.csv:302: trial is '1'; allowed: rows of one condition, block and "
                        "repetition in each trial; line 2 of the same"));
  EXPECT_THAT(refusal(good + "A,1,haptic,9,NaN,1\n"), HasSubstr("table.csv:302: target_force"));
  EXPECT_THAT(refusal(good + "A,2,haptic,9,1,1\n"),
              HasSubstr("table.csv:302: is the only row of A, trial 2"));
}

}  // namespace
}  // namespace haptrial::exchange::import_table_test
