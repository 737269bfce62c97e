// QUEST+ as a definition states it: the same as psi where it is psi, Bayes' rule over the levels
// that were applied where it is not.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/base/random.h"
#include "core/psychometric/procedure/quest_plus.h"
#include "protocols/psychophysics/sequence/trial_sequence.h"
#include "tests/protocols/psychophysics/definition/small_definition.h"

namespace haptrial::protocols {
namespace {

using psychometric::QuestPlus;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

const char* const kPsi = R"([procedure]
kind = "psi"
variable = "level"
levels = { from = 310.0, to = 600.0, count = 30 }
threshold = { from = 320.0, to = 580.0, count = 27 }
width = { from = 20.0, to = 200.0, count = 10, spacing = "log" }
lapse = [0.0, 0.02, 0.05]
function = "norm"
stop = { trials = 60 }
)";

const char* const kSameGrids = R"([procedure]
kind = "quest_plus"
stop = { trials = 60 }
[procedure.stimulus]
level = { from = 310.0, to = 600.0, count = 30 }
[procedure.parameters]
threshold = { from = 320.0, to = 580.0, count = 27 }
width = { from = 20.0, to = 200.0, count = 10, spacing = "log" }
lapse = [0.0, 0.02, 0.05]
)";

std::string after_kind(std::string text, const std::string& more) {
  const std::string kind = "kind = \"quest_plus\"\n";
  return text.insert(text.find(kind) + kind.size(), more);
}

std::unique_ptr<psychometric::Procedure> procedure_of(const std::string& text) {
  TrialsDefinition d;
  read_small(small_trials(text), d);
  return d.tracks.front().begin(1, "track");
}

TEST(QuestDefinitionTest, OfOneDimensionItSuggestsWhatPsiSuggests) {
  const auto psi = procedure_of(kPsi);
  // The width of a normal distribution is that from 5 % to 95 %.
  const auto named = procedure_of(after_kind(kSameGrids, "function = \"norm\"\n"));
  const auto formula = procedure_of(after_kind(
      kSameGrids,
      "probability = \"0.5 + (0.5 - $lapse) * normcdf(3.2897072539029444 * ($level - $threshold) "
      "/ $width)\"\n"));
  RandomStream random(4, "answers");
  int trials = 0;
  while (!psi->finished()) {
    ASSERT_EQ(named->next(), psi->next()) << trials;
    ASSERT_EQ(formula->next(), psi->next()) << trials;
    const psychometric::Level level = psi->next();
    const double answer = random.uniform() < 0.5 + 0.48 / (1.0 + std::exp((450 - level[0]) / 20.0));
    for (auto* each : {psi.get(), named.get(), formula.get()}) {
      each->report(answer, level);
    }
    ++trials;
  }
  EXPECT_EQ(trials, 60);
  EXPECT_TRUE(named->finished());
  EXPECT_NEAR(formula->estimates().front().value, psi->estimates().front().value, 1e-9);
}

// Right answers get rarer towards 450: a comparison below a standard.
TEST(QuestDefinitionTest, AFunctionThatFallsFindsItsThreshold) {
  const auto named = procedure_of(after_kind(kSameGrids, "function = \"neg_norm\"\n"));
  const auto formula = procedure_of(after_kind(
      kSameGrids,
      "probability = \"0.5 + (0.5 - $lapse) * normcdf(3.2897072539029444 * ($threshold - $level) "
      "/ $width)\"\n"));
  std::string text = kPsi;
  text.replace(text.find("\"norm\""), 6, "\"neg_norm\"");
  const auto psi = procedure_of(text);
  RandomStream random(4, "answers");
  while (!psi->finished()) {
    const psychometric::Level level = psi->next();
    ASSERT_EQ(named->next(), level);
    ASSERT_EQ(formula->next(), level);
    const double answer = random.uniform() < 0.5 + 0.48 / (1.0 + std::exp((level[0] - 450) / 20.0));
    for (auto* each : {psi.get(), named.get(), formula.get()}) {
      each->report(answer, level);
    }
  }
  EXPECT_NEAR(psi->estimates().front().value, 450.0, 30.0);
  EXPECT_NEAR(formula->estimates().front().value, psi->estimates().front().value, 1e-9);
}

const char* const kPlane = R"toml([experiment]
protocol = "trials"
name = "plane"
[design]
participants = 1
[fields.pull]
type = "constant"
force = ["$x", "$y", 0.0]
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 0.2 }
[response]
question = "Did it pull?"
choices = [{ value = "yes" }, { value = "no" }]
[procedure]
kind = "quest_plus"
probability = "normcdf((sqrt($x ^ 2 + ($gain * $y) ^ 2) - $threshold) / 0.15)"
counts = "$answer == 1"
stop = { trials = 150 }
[procedure.stimulus]
x = { from = 0.0, to = 2.0, count = 8, resolution = 0.1 }
y = { from = 0.0, to = 2.0, count = 8 }
[procedure.parameters]
threshold = { from = 0.4, to = 1.6, count = 25, prior = { mean = 1.0, sd = 0.4 } }
gain = { values = [0.4, 0.6, 0.8, 1.0, 1.2, 1.4], prior = [1, 1, 1, 1, 1, 2] }
)toml";

double probability(double x, double y, double threshold, double gain) {
  const double z = (std::hypot(x, gain * y) - threshold) / 0.15;
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

/// Bayes' rule, written out.
class Posterior {
 public:
  Posterior() {
    const std::vector<double> gains{0.4, 0.6, 0.8, 1.0, 1.2, 1.4};
    for (int i = 0; i < 25; ++i) {
      const double threshold = 0.4 + 1.2 * i / 24.0;
      for (const double gain : gains) {
        const double z = (threshold - 1.0) / 0.4;
        cells_.push_back({threshold, gain, std::exp(-0.5 * z * z) * (gain > 1.3 ? 2.0 : 1.0)});
      }
    }
  }
  void learn(double x, double y, bool yes) {
    for (Cell& cell : cells_) {
      const double p = probability(x, y, cell.threshold, cell.gain);
      cell.weight *= yes ? p : 1.0 - p;
    }
  }
  double mean(bool of_gain) const {
    double sum = 0.0, all = 0.0;
    for (const Cell& cell : cells_) {
      sum += cell.weight * (of_gain ? cell.gain : cell.threshold);
      all += cell.weight;
    }
    return sum / all;
  }

 private:
  struct Cell {
    double threshold, gain, weight;
  };
  std::vector<Cell> cells_;
};

TEST(QuestDefinitionTest, OfTwoDimensionsItFindsTheObserverByTheLevelsThatWereApplied) {
  TrialsDefinition d;
  read_small(kPlane, d);
  TrialSequence sequence(d, {0, "", 7, 11});
  RandomStream random(5, "observer");
  Posterior posterior;
  constexpr double kThreshold = 0.8, kGain = 1.2;
  int rounded = 0;
  while (const auto next = sequence.next()) {
    ASSERT_EQ(next->applied.size(), 2U);
    const double x = next->applied[0], y = next->applied[1];
    ASSERT_EQ(next->values.levels[0], std::pair(std::string("x"), x));
    ASSERT_EQ(next->values.levels[1], std::pair(std::string("y"), y));
    EXPECT_NEAR(x, 0.1 * std::round(x / 0.1), 1e-12);
    EXPECT_EQ(y, next->asked[1]);
    rounded += x != next->asked[0] ? 1 : 0;
    const bool yes = random.uniform() < probability(x, y, kThreshold, kGain);
    posterior.learn(x, y, yes);
    sequence.conclude(true, yes ? 1.0 : 0.0, yes);
  }
  EXPECT_GT(rounded, 10) << "else nothing is shown about what it learns from";
  const auto found = sequence.running().front().procedure->estimates();
  ASSERT_GE(found.size(), 2U);
  EXPECT_THAT(found[0].name, HasSubstr("threshold"));
  EXPECT_THAT(found[1].name, HasSubstr("gain"));
  EXPECT_NEAR(found[0].value, posterior.mean(false), 1e-9);
  EXPECT_NEAR(found[1].value, posterior.mean(true), 1e-9);
  // The truth lies within three of the posterior's own standard deviations, which are small.
  EXPECT_NEAR(found[0].value, kThreshold, 3.0 * *found[0].deviation);
  EXPECT_NEAR(found[1].value, kGain, 3.0 * *found[1].deviation);
  EXPECT_LT(*found[0].deviation, 0.05) << "of the prior 0.3";
  EXPECT_LT(*found[1].deviation, 0.1) << "of the prior 0.35";
}

TEST(QuestDefinitionTest, MoreThanTwoAnswersHaveAFormulaEach) {
  std::string text = kPlane;
  const std::string one =
      text.substr(text.find("probability"), text.find("counts") - text.find("probability"));
  text.replace(text.find(one), one.size(),
               "probability = [\"0.25 * $gain / 1.4\", \"0.25 * $threshold / 1.6\"]\n");
  text.replace(text.find("$answer == 1"), 12, "$x > 1 ? 2 : $answer - 1");
  TrialsDefinition d;
  EXPECT_NO_THROW(read_small(text, d));
  const auto procedure = d.tracks.front().begin(1, "track");
  EXPECT_NO_THROW(procedure->report(2.0, procedure->next()));
  EXPECT_THROW(procedure->report(3.0, procedure->next()), std::invalid_argument);
}

std::string changed(const std::string& what, const std::string& instead) {
  std::string text = kPlane;
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), instead);
}

TEST(QuestDefinitionTest, MistakesHaveTheirSentence) {
  EXPECT_THAT(problems_of_trials(kPlane), IsEmpty());
  EXPECT_THAT(problems_of_trials(changed("$gain * $y", "$gian * $y")),
              Contains(HasSubstr("names gian; allowed: x, y, threshold, gain")));
  EXPECT_THAT(problems_of_trials(changed("normcdf(", "2 * normcdf(")),
              Contains(HasSubstr("procedure.probability cannot be used as stated")));
  EXPECT_THAT(problems_of_trials(changed("counts =", "function = \"norm\"\ncounts =")),
              Contains(HasSubstr("state probability, a formula, or function, a sigmoid")));
  EXPECT_THAT(problems_of_trials(changed("1, 1, 1, 2]", "1, 1, 2]")),
              Contains(HasSubstr("procedure.parameters.gain.prior is a list of 5; allowed: 6, a "
                                 "weight for each value")));
  EXPECT_THAT(problems_of_trials(changed("count = 25", "count = 2000")), IsEmpty());
  EXPECT_THAT(
      problems_of_trials(changed(
          "count = 8 }\n[procedure.parameters]",
          "count = 800 }\n[procedure.parameters]\nother = { from = 0, to = 1, count = 200 }")),
      Contains(HasSubstr("pairs of values together; allowed: at most 1e+07")));
  EXPECT_THAT(problems_of_trials(changed("\nx = {", "\nx2 = 1.0\nx = {")), IsEmpty());
  EXPECT_THAT(problems_of_trials(changed("gain = {", "x = [1.0]\ngain = {")),
              Contains(HasSubstr("procedure.parameters.x is a variable of the stimulus, too")));
  EXPECT_THAT(problems_of_trials(std::string(kPlane) + "[factors]\ny = [1, 2]\n"),
              Contains(HasSubstr("sets \"y\", which is a factor")));
}

TEST(QuestDefinitionTest, LevelsOutsideOfTheDeviceAreFoundInEveryDimension) {
  EXPECT_THAT(
      problems_of_trials(changed("y = { from = 0.0, to = 2.0", "y = { from = 0.0, to = 20.0")),
      Contains(HasSubstr("fields.pull asks for 20.0998 N")));
}

}  // namespace
}  // namespace haptrial::protocols
