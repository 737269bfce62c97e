// Sheets of curves: who judges cannot see whose they are, and what is read back is what was given.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "analysis/force_training/judge/judged_curves.h"
#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Recalls of participants P0, P1, ... with parts that vary without a pattern.
std::vector<JudgedRecall> some_recalls(int people, int trials) {
  std::vector<JudgedRecall> recalls;
  for (int person = 0; person < people; ++person) {
    for (int trial = 1; trial <= trials; ++trial) {
      JudgedRecall recall{fmt::format("P{}.h5", person), fmt::format("P{}", person), trial, {}};
      recall.detail.time.duration = 1.0;
      const int number = person * trials + trial;
      for (int i = 0; i < 50; ++i) {
        recall.detail.target.push_back(std::sin(0.1 * i));
        recall.detail.applied.push_back(std::sin(0.1 * i + 0.01 * number));
      }
      recall.detail.score.alignment_cost = 1.0 + std::sin(12.9 * number);
      recall.detail.score.rms_force = 1.0 + std::sin(78.2 * number);
      recall.detail.score.rms_slope = 1.0 + std::sin(43.7 * number);
      recalls.push_back(std::move(recall));
    }
  }
  return recalls;
}

class JudgingTest : public testing::Test {
 protected:
  JudgingTest() {
    options_.curves = 20;
    options_.repeated = 0.25;
    const auto all = some_recalls(5, 6);
    for (const std::size_t place : shuffled_recalls(all.size(), options_)) {
      recalls_.push_back(all[place]);
    }
    key_ = read_judging_key(file("key.csv", judging_key(recalls_, options_)));
  }
  std::filesystem::path file(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  /// The table as a judge fills it in. @param judgement  of the place of a curve
  template <class Judge>
  std::string filled(Judge&& judgement) const {
    std::string text = "sheet,curve,judgement\n";
    for (const SheetCurve& each : key_) {
      text += fmt::format("{},{},{}\n", each.sheet, each.curve, judgement(each));
    }
    return text;
  }
  std::string refused(const std::string& text) {
    try {
      read_judgements(file("judge.csv", text), key_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  SheetOptions options_;
  std::vector<JudgedRecall> recalls_;
  std::vector<SheetCurve> key_;
  test::TemporaryFolder folder_;
};

TEST_F(JudgingTest, AQuarterOfTheCurvesComesTwice) {
  std::set<std::pair<std::string, int>> different;
  for (const JudgedRecall& recall : recalls_) {
    different.emplace(recall.session, recall.trial);
  }
  EXPECT_EQ(recalls_.size(), 25U);
  EXPECT_EQ(different.size(), 20U);
  for (const SheetCurve& each : key_) {
    if (each.first > 0) {
      const SheetCurve& first = key_[static_cast<std::size_t>(each.first) - 1];
      EXPECT_EQ(first.session, each.session);
      EXPECT_EQ(first.trial, each.trial);
      EXPECT_EQ(first.first, 0);
    }
  }
  EXPECT_EQ(shuffled_recalls(30, options_), shuffled_recalls(30, options_));
  SheetOptions other = options_;
  other.seed = 2;
  EXPECT_NE(shuffled_recalls(30, options_), shuffled_recalls(30, other));
}

TEST_F(JudgingTest, SheetsAndTableNameNobody) {
  const auto sheets = judging_sheets(recalls_, options_, false);
  EXPECT_EQ(sheets.size(), 3U);
  for (const std::string& sheet : sheets) {
    EXPECT_THAT(sheet, Not(HasSubstr(".h5")));
    for (int person = 0; person < 5; ++person) {
      EXPECT_THAT(sheet, Not(HasSubstr(fmt::format(">P{}", person))));
    }
  }
  EXPECT_THAT(judging_table(recalls_, options_),
              HasSubstr("sheet,curve,judgement\n" + key_[0].sheet + ",1,\n"));
  EXPECT_THAT(sheets[2], HasSubstr("Sheet " + key_.back().sheet));
}

TEST_F(JudgingTest, JudgementsOfOtherSheetsAreRefused) {
  const auto four = [](const SheetCurve&) { return 4; };
  EXPECT_EQ(refused(filled(four)), "");
  const std::string own = key_[0].sheet;
  std::vector<JudgedRecall> others = recalls_;
  others.back().detail.score.rms_force += 1e-9;  // another study of the same design
  key_ = read_judging_key(file("other.csv", judging_key(others, options_)));
  const std::string text = filled(four);
  key_ = read_judging_key(file("key.csv", judging_key(recalls_, options_)));
  EXPECT_THAT(refused(text), HasSubstr("judge.csv:2: sheet is 's"));
  EXPECT_THAT(refused(text), HasSubstr("allowed: " + own + ", as on the sheets of this study"));
}

TEST_F(JudgingTest, TheKeyHoldsTheParts) {
  ASSERT_EQ(key_.size(), recalls_.size());
  for (std::size_t i = 0; i < key_.size(); ++i) {
    EXPECT_EQ(key_[i].alignment_cost, recalls_[i].detail.score.alignment_cost);
    EXPECT_EQ(key_[i].rms_force, recalls_[i].detail.score.rms_force);
    EXPECT_EQ(key_[i].rms_slope, recalls_[i].detail.score.rms_slope);
  }
}

TEST_F(JudgingTest, RefusesWhatIsNoCompleteTable) {
  const auto four = [](const SheetCurve&) { return 4; };
  EXPECT_EQ(refused(filled(four)), "");
  EXPECT_THAT(refused(filled([](const SheetCurve& each) { return each.curve == 3 ? 8 : 4; })),
              HasSubstr("judgement is '8'; allowed: whole numbers from 1 to 7"));
  const std::string again = key_[0].sheet + ",1,4\n";
  EXPECT_THAT(refused("sheet,curve,judgement\n" + again), HasSubstr("curve 2 is missing"));
  EXPECT_THAT(refused(filled(four) + again), HasSubstr("each number of a curve once"));
}

TEST_F(JudgingTest, AgreementIsThatOfTheTables) {
  std::vector<double> steady, wavering;
  for (const SheetCurve& each : key_) {
    const int of_curve = each.first > 0 ? each.first : each.curve;
    steady.push_back(1.0 + of_curve % 7);
    wavering.push_back(each.first > 0 ? 8.0 - steady.back() : steady.back());
  }
  const Judging judging = judging_of(key_, {"steady", "wavering"}, {steady, wavering}, 1);
  ASSERT_EQ(judging.judges.size(), 2U);
  EXPECT_EQ(judging.judges[0].repeated, 5U);
  EXPECT_EQ(judging.judges[0].difference, 0.0);
  double difference = 0.0;
  for (std::size_t i = 0; i < key_.size(); ++i) {
    difference += key_[i].first > 0 ? std::abs(8.0 - 2.0 * steady[i]) / 5.0 : 0.0;
  }
  EXPECT_NEAR(judging.judges[1].difference, difference, 1e-12);
}

TEST_F(JudgingTest, TheReportShowsNoSharesOfDice) {
  std::vector<double> judged;
  for (const SheetCurve& each : key_) {
    judged.push_back(1.0 + each.curve * each.curve % 7);
  }
  const Judging judging = judging_of(key_, {"dice"}, {judged}, 1);
  ASSERT_TRUE(judging.skill);
  ASSERT_FALSE(judging.skill->predicts);
  const std::string report = to_markdown(judging_report(judging, true));
  EXPECT_THAT(report, HasSubstr("do not determine the shares"));
  EXPECT_THAT(report, HasSubstr("there is one judge"));
  EXPECT_THAT(report, Not(HasSubstr("| share |")));
}

/// The shares that `judge fit` writes are those that `analyze --shares` scores by.
TEST_F(JudgingTest, WrittenSharesAreReadBackIntoTheScore) {
  SkillFit skill;
  skill.shares = {JudgedShare{0.5, 0.4, 0.6}, {0.3, 0.2, 0.4}, {0.2, 0.1, 0.3}};
  ScoreParameters own;
  own.samples = 321;
  const ScoreParameters read = with_shares_of(file("shares.toml", judged_weights(skill)), own);
  EXPECT_EQ(read.cost_share, 0.5);
  EXPECT_EQ(read.force_share, 0.3);
  EXPECT_EQ(read.slope_share, 0.2);
  EXPECT_EQ(read.samples, 321) << "the rest of the score stays";
  try {
    with_shares_of(file("typing.toml", "[analysis]\ncost_share = 1\nforce_share = 1\n"), own);
    ADD_FAILURE() << "a missing share is read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("slope_share"));
  }
}

}  // namespace
}  // namespace haptrial::analysis
