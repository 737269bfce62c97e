#include "analysis/psychophysics/study/paired_quantities.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "analysis/psychophysics/report/trials_words.h"
#include "analysis/psychophysics/study/trials_study.h"
#include "core/base/random.h"
#include "tests/analysis/psychophysics/study/null_trials.h"

namespace haptrial::analysis::trials {
namespace {

TrialsPlan paired_plan() {
  TrialsPlan plan;
  plan.kind = AnalysisKind::kPaired;
  plan.by = {kItem};
  plan.permutations = 0;
  plan.question = "better";
  plan.paired.first = "first";
  plan.paired.second = "second";
  plan.plan = parse_analysis_plan({"a < b"}, "", "tests");
  return plan;
}

StudyTrial choice(std::size_t session, const char* first, const char* second, bool of_first) {
  StudyTrial trial;
  trial.session = session;
  trial.variables.push_back({"first", 0, kNotKnown, first});
  trial.variables.push_back({"second", 0, kNotKnown, second});
  GivenAnswer answer;
  answer.question = "better";
  answer.text = of_first ? "first" : "second";
  answer.correct = of_first ? 1 : 0;
  trial.answers.push_back(answer);
  return trial;
}

/// Ten people who choose one of three items without preferring any.
TrialsData indifferent(std::uint64_t seed) {
  TrialsData data;
  RandomStream random(seed, "choices");
  for (std::size_t person = 0; person < 10; ++person) {
    StudySession session;
    session.participant = "P" + std::to_string(person);
    data.sessions.push_back(session);
    for (int repetition = 0; repetition < 6; ++repetition) {
      for (const auto& [first, second] : {std::pair("a", "b"), {"a", "c"}, {"b", "c"}}) {
        data.trials.push_back(choice(person, first, second, random.uniform() < 0.5));
      }
    }
  }
  return data;
}

TEST(PairedQuantitiesTest, TestsKeepTheirLevel) {
  constexpr std::size_t kStudies = 2000;
  const TrialsPlan plan = paired_plan();
  const auto band = test::binomial_band(kStudies, 1.0 - 1e-6);
  const auto levels = test::null_levels(kStudies, 2, [&](std::size_t number) {
    TrialsResult result;
    result.plan = plan;
    result.data = indifferent(number + 1);
    result.quantities = paired_quantities(result.data, plan);
    test::NullLevels own;
    for (const NamedTest& test : tests_of(result)) {
      own.note(test.name, true, test.p < 0.05);
    }
    return own;
  });
  EXPECT_GE(levels.size(), 8u);
  for (const test::NullLevel& level : levels) {
    EXPECT_LE(level.found, band.high) << level.test;
  }
}

/// The mean over a participant's items is 0, so that worths of other items have another zero.
TEST(PairedQuantitiesTest, ParticipantsWithoutAllItemsHaveNoValues) {
  TrialsData data = indifferent(1);
  std::erase_if(data.trials, [](const StudyTrial& trial) {
    return trial.session == 3 && (trial.variables[0].word == "c" || trial.variables[1].word == "c");
  });
  const auto found = paired_quantities(data, paired_plan());
  EXPECT_EQ(found[0].missing,
            std::vector<std::string>{"Worth in log odds: no values of P3, because no chain of "
                                     "presented pairs links all items"});
  ASSERT_EQ(found[1].missing.size(), 1u);
  for (const Quantity& each : found) {
    EXPECT_EQ(each.table.means.size(), 9u);
  }
}

TEST(PairedQuantitiesTest, AWorthThatMostTrialsLeaveOpenHasNoInterval) {
  TrialsData data = indifferent(1);
  for (StudyTrial& trial : data.trials) {  // six people always choose a
    if (trial.session < 6 && trial.variables[0].word == "a") {
      trial.answers[0].correct = 1;
    }
  }
  const auto found = paired_quantities(data, paired_plan());
  ASSERT_EQ(found[0].means.size(), 3u);
  ASSERT_FALSE(found[0].means[0]);
  EXPECT_EQ(found[0].means[0].because(),
            "for most participants it was always or never chosen, alone or with others");
  EXPECT_TRUE(found[0].means[1]);
}

/// The item d, which always wins, meets c alone, so that no share of it is compared.
TEST(PairedQuantitiesTest, AWorthAtTheEndOfAChainHasNoIntervalIfItIsOpen) {
  TrialsData data = indifferent(1);
  std::erase_if(data.trials, [](const StudyTrial& trial) {
    return trial.variables[0].word == "a" && trial.variables[1].word == "c";
  });
  for (std::size_t person = 0; person < 10; ++person) {
    for (int repetition = 0; repetition < 6; ++repetition) {
      data.trials.push_back(choice(person, "d", "c", person < 6 || repetition % 2 == 0));
    }
  }
  const auto found = paired_quantities(data, paired_plan());
  ASSERT_EQ(found[0].means.size(), 4u);
  EXPECT_FALSE(found[1].compared);
  EXPECT_FALSE(found[0].means[3]);
  for (std::size_t other = 0; other < 3; ++other) {
    EXPECT_TRUE(found[0].means[other]) << other;
  }
}

TEST(PairedQuantitiesTest, SharesNeedTheSameOpponentsAndWorthsOnlyAChain) {
  TrialsData data = indifferent(1);
  std::erase_if(data.trials, [](const StudyTrial& trial) {
    return trial.variables[0].word == "a" && trial.variables[1].word == "c";
  });
  const auto found = paired_quantities(data, paired_plan());
  EXPECT_EQ(found[0].table.means.size(), 10u);
  EXPECT_TRUE(found[0].missing.empty());
  EXPECT_FALSE(found[1].compared);
  EXPECT_EQ(found[1].missing.size(), 1u);
}

TEST(PairedQuantitiesTest, TrialsWithoutAnOutcomeAreCountedWithTheReason) {
  TrialsData data = indifferent(1);  // 180 trials
  for (std::size_t i = 0; i < 20; ++i) {
    data.trials[i].answers[0].correct = -1;
  }
  data.trials[30].answers.clear();
  TrialsPlan plan = paired_plan();
  const TrialsResult result = analyze(data, plan, {}, 1);
  const std::vector<std::string> lines = summary_lines(result);
  EXPECT_EQ(lines[1],
            "20 of 180 trials are not analysed, because nothing says which answer counts 1; "
            "[analysis] can name it (yes = \"ANSWER\")");
  EXPECT_EQ(lines[2], "1 of 180 trials is not analysed, because they have no answer");
  plan.yes = "first";
  const auto unused = unused_trials(data, plan);
  ASSERT_EQ(unused.size(), 1u);
  EXPECT_EQ(unused[0].count, 1u);
}

TEST(PairedQuantitiesTest, TrialsWithoutAnAnswerOrWithOneItemTwiceDoNotCount) {
  TrialsData data = indifferent(1);
  const auto before = paired_quantities(data, paired_plan());
  data.trials.push_back(choice(0, "a", "a", true));
  data.trials.push_back(choice(0, "a", "b", true));
  data.trials.back().answers.clear();
  const auto after = paired_quantities(data, paired_plan());
  EXPECT_EQ(before[0].table.means, after[0].table.means);
  EXPECT_EQ(before[1].table.means, after[1].table.means);
}

}  // namespace
}  // namespace haptrial::analysis::trials
