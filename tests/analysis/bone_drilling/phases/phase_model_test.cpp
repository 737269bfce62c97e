#include "analysis/bone_drilling/phases/phase_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/bone_drilling/phases/phase_labels.h"
#include "tests/analysis/bone_drilling/phases/made_actions.h"
#include "tests/support/message_of.h"

namespace haptrial::analysis::drilling::phase_model_test {
namespace {

const std::vector<std::string> kNames{"open", "deepen", "finish"};

/// Shuffles the labels of every procedure among its actions.
std::vector<PhaseCase> shuffled(std::vector<PhaseCase> cases, RandomStream& random) {
  for (PhaseCase& each : cases) {
    for (std::size_t n = each.phase.size(); n > 1; --n) {
      std::swap(each.phase[n - 1], each.phase[random.below(n)]);
    }
  }
  return cases;
}

TEST(PhaseModelTest, MeansDeviationsAndSharesAreThoseOfTheLabelledActions) {
  const auto cases = test::made_cases(1.0, 1);
  const auto model = learn_phases(cases, kNames);
  ASSERT_TRUE(model);
  for (int phase = 0; phase < 3; ++phase) {
    double sum = 0.0, squares = 0.0, count = 0.0, diamond = 0.0;
    for (const PhaseCase& each : cases) {
      for (std::size_t t = 0; t < each.actions.size(); ++t) {
        if (each.phase[t] == phase) {
          const double depth = each.actions[t].numbers[0];
          sum += depth;
          squares += depth * depth;
          count += 1.0;
          diamond += each.actions[t].words[0] == "diamond at work" ? 1.0 : 0.0;
        }
      }
    }
    EXPECT_NEAR(model->mean(phase, 0), sum / count, 1e-9);
    EXPECT_NEAR(model->deviation(phase, 0), std::sqrt(squares / count - std::pow(sum / count, 2)),
                1e-9);
    const auto at =
        std::find(model->words[0].words.begin(), model->words[0].words.end(), "diamond at work") -
        model->words[0].words.begin();
    EXPECT_NEAR(std::exp(model->words[0].log_share(phase, at)), (diamond + 0.5) / (count + 1.5),
                1e-9);
  }
  EXPECT_TRUE((model->deviation.col(4).array() > 0.0).all()) << "a number that never varies";
}

TEST(PhaseModelTest, ParticipantsLeftOutAreRecognised) {
  const auto accuracy = left_out_accuracy(test::made_cases(1.0, 2), kNames);
  ASSERT_TRUE(accuracy);
  EXPECT_GT(accuracy->right(), 0.95);
  EXPECT_GT(accuracy->kappa(), 0.9);
  EXPECT_LT(accuracy->chance(), 0.7);
  EXPECT_DOUBLE_EQ(accuracy->ticks.sum(), 6.0 * 60.0 * 1000.0);
}

TEST(PhaseModelTest, ActionsThatAreAlikeAreNotToldApart) {
  double kappas = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    kappas += left_out_accuracy(test::made_cases(0.0, seed), kNames)->kappa() / 10.0;
  }
  EXPECT_NEAR(kappas, 0.0, 0.12);
}

TEST(PhaseModelTest, ShuffledLabelsAreRecognisedLessOftenThanTrueOnes) {
  const auto cases = test::made_cases(1.0, 3);
  const double real = left_out_accuracy(cases, kNames)->right();
  RandomStream random(1, "shuffles");
  for (int round = 0; round < 19; ++round) {
    const auto accuracy = left_out_accuracy(shuffled(cases, random), kNames);
    EXPECT_LT(accuracy->right(), real);
    EXPECT_NEAR(accuracy->kappa(), 0.0, 0.3);
  }
}

TEST(PhaseModelTest, PhasesAreFoundWithoutLabels) {
  const auto cases = test::made_cases(1.0, 4);
  const auto model = find_phases(cases, 3, 1);
  ASSERT_TRUE(model);
  EXPECT_EQ(model->phases, std::vector<std::string>({"phase 1", "phase 2", "phase 3"}));
  // Which of the found phases is which is not known: each counts for the label it mostly has.
  Eigen::Matrix3d seen = Eigen::Matrix3d::Zero();
  for (const PhaseCase& each : cases) {
    const std::vector<int> found = phases_of(*model, each.actions);
    for (std::size_t t = 0; t < found.size(); ++t) {
      seen(found[t], each.phase[t]) += 1.0;
    }
  }
  EXPECT_GT(seen.rowwise().maxCoeff().sum() / seen.sum(), 0.9) << seen;
  const auto again = find_phases(cases, 3, 1);
  EXPECT_EQ(again->mean, model->mean);
}

TEST(PhaseModelTest, AWordThatNobodyHeardIsNoImpossibility) {
  const auto model = learn_phases(test::made_cases(1.0, 5), kNames);
  Action strange;
  strange.words = {"saw at work", "cochlea", "still"};
  const Eigen::MatrixXd emission = emission_of(*model, std::span(&strange, 1));
  EXPECT_TRUE(emission.allFinite());
  EXPECT_EQ(phases_of(*model, {}).size(), 0u);
}

TEST(PhaseModelTest, OtherToolsOrAnotherBoneAreRefused) {
  const auto cases = test::made_cases(1.0, 5);
  const PhaseModel model = *learn_phases(cases, kNames);
  const auto refusal = [&](ActionWord which, const char* word) {
    std::vector<Action> actions = cases[0].actions;
    for (Action& action : actions) {
      action.word(which) = word;
    }
    return test::message_of([&] { require_known_words(model, actions); });
  };
  EXPECT_THAT(refusal(ActionWord::kTool, "saw at work"),
              testing::HasSubstr("none of the tools of this procedure (saw at work)"));
  EXPECT_THAT(
      refusal(ActionWord::kStructure, "alveolar nerve"),
      testing::HasSubstr("none of the vital structures of this procedure (alveolar nerve)"));
  std::vector<Action> far = cases[0].actions;
  for (Action& action : far) {
    action.word(ActionWord::kStructure) = "none";
  }
  far.front().word(ActionWord::kTool) = "suction";
  EXPECT_NO_THROW(require_known_words(model, far)) << "a new tool among known ones";
}

TEST(PhaseModelTest, TooLittleIsSaid) {
  auto cases = test::made_cases(1.0, 6, 2);
  const auto missing = learn_phases(cases, {"open", "deepen", "finish", "close"});
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.because(), testing::HasSubstr("phase \"close\" has 0 strokes"));
  cases.resize(1);
  cases[0].actions.resize(7);
  EXPECT_FALSE(find_phases(cases, 2, 1));
  EXPECT_FALSE(left_out_accuracy(cases, kNames));
}

}  // namespace
}  // namespace haptrial::analysis::drilling::phase_model_test
