// Records of sessions come back, trial by trial, and stand in the tidy table.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "analysis/files/csv.h"
#include "analysis/psychophysics/data/page_scores.h"
#include "analysis/psychophysics/data/read_trials.h"
#include "analysis/psychophysics/data/trials_csv.h"
#include "analysis/psychophysics/data/trials_data.h"
#include "tests/analysis/psychophysics/simulated_trials.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis::trials::read_trials_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A practice trial, one that was aborted, its second attempt, and a catch trial.
TrialsData hand_made() {
  TrialsData data;
  data.sessions = {{"P01.h5", "P01", "left", "simulated", true, false}};
  StudyTrial practice;
  practice.trial = 1;
  practice.block = -1;
  practice.practice = true;
  practice.condition = "familiarisation";
  practice.answers = {{"stiffer", 1.0, "first", 1, 0.75}};
  StudyTrial aborted;
  aborted.trial = 1;
  aborted.block = 1;
  aborted.condition = "main";
  aborted.completed = false;
  aborted.levels = {{"from above", "level", 333.0, 330.0, kNotKnown}};
  StudyTrial again = aborted;
  again.completed = true;
  again.attempt = 2;
  again.levels.front().outcome = 1.0;
  again.answers = {{"stiffer", 2.0, "second", 1, 0.5}, {"sure", 4.0, "", -1, 1.25}};
  again.variables = {{"stiffness", 1, 300.0, ""},
                     {"stiffness", 2, 330.0, ""},
                     {"field", 0, kNotKnown, "curl, \"soft\""}};
  again.stages = {{"press", 1, true, false, 12}, {"press", 2, true, true, 20, 12}};
  StudyTrial probe = aborted;
  probe.trial = 2;
  probe.completed = true;
  probe.probe = "catch";
  probe.levels.clear();
  data.trials = {practice, aborted, again, probe};
  return data;
}

std::string table_of(const TrialsData& data) {
  std::string text;
  trials_csv(data, [&](const std::string& piece) { text += piece; });
  return text;
}

class ReadTrials : public testing::Test {
 protected:
  ReadTrials() {
    test::write_sessions(hand_made(), folder_.path(), 20);
    data_ = read_trials(
        {folder_.path() / "P01.h5"}, [](const std::string&) { return "left"; }, 1);
  }
  test::TemporaryFolder folder_;
  TrialsData data_;
};

TEST_F(ReadTrials, EveryPassComesBackInItsOrder) {
  ASSERT_EQ(data_.trials.size(), 4u);
  EXPECT_TRUE(data_.trials[0].practice);
  EXPECT_FALSE(data_.trials[0].counts());
  EXPECT_FALSE(data_.trials[1].completed);
  EXPECT_FALSE(data_.trials[1].counts());
  EXPECT_TRUE(data_.trials[2].counts());
  EXPECT_EQ(data_.trials[2].attempt, 2);
  EXPECT_EQ(data_.trials[3].probe, "catch");
  EXPECT_EQ(data_.trials[2].probe, "");
  EXPECT_EQ(data_.session_of(data_.trials[0]).group, "left");
  EXPECT_TRUE(data_.simulated());
}

TEST_F(ReadTrials, AnswersVariablesLevelsAndStagesBelongToTheirPass) {
  const StudyTrial& trial = data_.trials[2];
  ASSERT_EQ(trial.answers.size(), 2u);
  EXPECT_EQ(answer_to(trial, "sure")->value, 4.0);
  EXPECT_EQ(answer_to(trial, "")->text, "second");
  EXPECT_EQ(answer_to(trial, "")->correct, 1);
  EXPECT_NEAR(answer_to(trial, "")->reaction_time, 0.5, 1e-9);
  EXPECT_EQ(answer_to(trial, "missing"), nullptr);
  EXPECT_EQ(variable_of(trial, "stiffness", 2)->value, 330.0);
  EXPECT_EQ(variable_of(trial, "stiffness"), nullptr);
  EXPECT_EQ(factor_level(data_, trial, "field"), "curl, \"soft\"");
  EXPECT_EQ(factor_level(data_, trial, "group"), "left");
  ASSERT_EQ(trial.levels.size(), 1u);
  EXPECT_EQ(trial.levels[0].asked, 333.0);
  EXPECT_EQ(trial.levels[0].applied, 330.0);
  EXPECT_EQ(trial.levels[0].outcome, 1.0);
  ASSERT_EQ(trial.stages.size(), 2u);
  EXPECT_EQ(trial.stages[0].ticks, 12u);
  EXPECT_EQ(trial.stages[1].ticks, 20u);
  EXPECT_GT(trial.saturated, 0.0);
  EXPECT_FALSE(trial.stages[0].at_limit);
  EXPECT_TRUE(trial.stages[1].at_limit);
  EXPECT_THAT(data_.trials[3].levels, IsEmpty());
}

TEST_F(ReadTrials, TheTidyTableHasARowForEveryPass) {
  const CsvTable table = CsvTable::parse(table_of(data_), "trials.csv");
  ASSERT_EQ(table.rows(), 4u);
  const auto of = [&](std::size_t row, const char* column) {
    return std::string(table.text(row, table.column(column)));
  };
  EXPECT_THAT((std::vector{of(0, "counted"), of(1, "counted"), of(2, "counted"), of(3, "counted")}),
              ElementsAre("0", "0", "1", "1"));
  EXPECT_EQ(of(0, "practice"), "1");
  EXPECT_EQ(of(1, "status"), "aborted");
  EXPECT_EQ(of(2, "applied"), "330");
  EXPECT_EQ(of(2, "outcome"), "1");
  EXPECT_EQ(of(1, "outcome"), "");
  EXPECT_EQ(of(2, "stiffer.text"), "second");
  EXPECT_EQ(of(2, "sure.correct"), "");
  EXPECT_EQ(of(2, "stiffness.2"), "330");
  EXPECT_EQ(of(2, "field"), "curl, \"soft\"");
  EXPECT_EQ(of(2, "press.1.s"), "0.012");
  EXPECT_EQ(of(3, "probe"), "catch");
  EXPECT_EQ(of(3, "track"), "");
}

/// Longer than a piece: nothing is lost where one ends.
TEST(TrialsCsv, IsTheSameInPieces) {
  TrialsData data = hand_made();
  const std::vector<StudyTrial> trials = data.trials;
  while (data.trials.size() < 40'000) {
    data.trials.insert(data.trials.end(), trials.begin(), trials.end());
  }
  std::size_t pieces = 0;
  trials_csv(data, [&](const std::string&) { ++pieces; });
  EXPECT_GT(pieces, 2U);
  const CsvTable table = CsvTable::parse(table_of(data), "trials.csv");
  ASSERT_EQ(table.rows(), data.trials.size());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    ASSERT_EQ(table.text(row, table.column("field")), row % 4 == 2 ? "curl, \"soft\"" : "");
  }
}

TEST(TrialsCsv, NoColumnStandsTwice) {
  TrialsData data = hand_made();
  data.trials[2].variables.push_back({"trial", 0, 5.0, ""});
  const CsvTable table = CsvTable::parse(table_of(data), "trials.csv");
  EXPECT_EQ(table.text(2, table.column("trial")), "1");
  EXPECT_EQ(table.text(2, table.column("trial_")), "5");
}

}  // namespace

// Words are texts, however many there are and whoever adds them.

namespace {

TEST(WordTest, IsItsText) {
  EXPECT_TRUE(Word().empty());
  EXPECT_EQ(Word(), Word(""));
  const Word stiffer("stiffer");
  EXPECT_EQ(stiffer.text(), "stiffer");
  EXPECT_EQ(stiffer, Word(std::string("stiffer")));
  EXPECT_FALSE(stiffer == Word("softer"));
  EXPECT_TRUE(stiffer == "stiffer");
  EXPECT_FALSE(stiffer == std::string("stiff"));
  EXPECT_FALSE(stiffer.empty());
}

TEST(WordTest, ThreadsAddTheSameWordsAndReadThemMeanwhile) {
  constexpr int kCount = 20'000;  // more than a block of them
  std::vector<std::vector<Word>> found(4);
  std::vector<std::thread> threads;
  for (std::vector<Word>& own : found) {
    threads.emplace_back([&own] {
      for (int i = 0; i < kCount; ++i) {
        own.emplace_back("word " + std::to_string(i));
        EXPECT_EQ(own[static_cast<std::size_t>(i / 2)].text(), "word " + std::to_string(i / 2));
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    ASSERT_EQ(found[0][i].text(), "word " + std::to_string(i));
    ASSERT_EQ(found[0][i], found[3][i]);
  }
}

}  // namespace

namespace {

TEST(PageScoresTest, MeansAreOverParticipantsForEachTime) {
  const std::vector<PageScore> scores{{"P01", "", "load", "session 1, before", "raw", 20.0},
                                      {"P01", "", "load", "session 2, before", "raw", 50.0},
                                      {"P02", "", "load", "session 1, before", "raw", 40.0},
                                      {"P02", "", "load", "session 1, before", "raw", 60.0}};
  const auto found = summaries_of(scores);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].count, 2u);
  EXPECT_NEAR(found[0].mean, 35.0, 1e-12);  // 20 and the mean of 40 and 60
  EXPECT_NEAR(found[0].deviation, 15.0 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(found[1].count, 1u);
  EXPECT_NEAR(found[1].mean, 50.0, 1e-12);
  EXPECT_TRUE(std::isnan(found[1].deviation));
}

}  // namespace
}  // namespace haptrial::analysis::trials::read_trials_test
