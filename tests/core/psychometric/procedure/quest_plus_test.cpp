#include "core/psychometric/procedure/quest_plus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "core/base/random.h"
#include "core/psychometric/procedure/psi_definition.h"
#include "tests/support/message_of.h"

namespace haptrial::psychometric {
namespace {

/// Two stimulus dimensions, three parameters, three outcomes by a softmax.
QuestDefinition three_outcomes(bool nuisance) {
  QuestDefinition d;
  d.stimulus = {{"a", {-1.0, 0.0, 1.5}, {}, false}, {"b", {0.5, 2.0}, {}, false}};
  d.parameters = {{"u", {-2.0, -0.5, 0.5, 1.0}, {1.0, 2.0, 3.0, 1.0}, false},
                  {"v", {0.2, 1.0, 1.7}, {}, nuisance},
                  {"w", {0.0, 0.4}, {}, false}};
  d.outcomes = 3;
  d.model = [](const double* s, const double* p, double* out) {
    const double e1 = std::exp(p[1] * (s[0] - p[0]));
    const double e2 = std::exp(s[1] * p[2] - p[0] * s[0]);
    out[0] = 1.0 / (1.0 + e1 + e2);
    out[1] = e1 * out[0];
    out[2] = 1.0 - out[0] - out[1];
  };
  return d;
}

double entropy_of(const std::vector<double>& shares) {
  double entropy = 0.0;
  for (double p : shares) {
    entropy -= p > 0.0 ? p * std::log(p) : 0.0;
  }
  return entropy;
}

/// The expected entropy as it is defined: Bayes' rule for each outcome, then the entropy of the
/// posterior over what is no nuisance. Nothing of the tables takes part.
double expected_entropy(const QuestDefinition& d, const QuestTables& grid,
                        const std::vector<double>& prior, std::size_t stimulus) {
  const auto s = grid.stimulus(stimulus);
  double expected = 0.0;
  for (std::size_t o = 0; o < d.outcomes; ++o) {
    std::map<std::vector<double>, double> shares;
    double probability = 0.0;
    for (std::size_t c = 0; c < prior.size(); ++c) {
      const auto p = grid.parameters(c);
      std::vector<double> out(d.outcomes);
      d.model(s.data(), p.data(), out.data());
      std::vector<double> known;
      for (std::size_t i = 0; i < p.size(); ++i) {
        if (!d.parameters[i].nuisance) {
          known.push_back(p[i]);
        }
      }
      shares[known] += prior[c] * out[o];
      probability += prior[c] * out[o];
    }
    std::vector<double> posterior;
    for (const auto& share : shares) {
      posterior.push_back(share.second / probability);
    }
    expected += probability * entropy_of(posterior);
  }
  return expected;
}

std::vector<double> random_posterior(std::size_t cells, RandomStream& random) {
  std::vector<double> p(cells);
  double sum = 0.0;
  for (double& value : p) {
    value = std::exp(3.0 * random.normal());
    sum += value;
  }
  for (double& value : p) {
    value /= sum;
  }
  return p;
}

TEST(SelectionTest, InformationIsWhatTheExpectedEntropyFallsBy) {
  const auto definition = three_outcomes(false);
  const QuestTables tables(definition);
  ASSERT_EQ(tables.stimuli(), 6u);
  ASSERT_EQ(tables.cells(), 24u);
  RandomStream random(1, "posterior");
  for (int i = 0; i < 50; ++i) {
    const auto posterior = random_posterior(tables.cells(), random);
    for (std::size_t s = 0; s < tables.stimuli(); ++s) {
      EXPECT_NEAR(information(tables, posterior, s),
                  entropy_of(posterior) - expected_entropy(definition, tables, posterior, s),
                  1e-13);
    }
  }
}

TEST(SelectionTest, MarginalInformationIsMinusTheExpectedEntropyOfTheOthers) {
  const auto definition = three_outcomes(true);
  const QuestTables tables(definition);
  RandomStream random(2, "posterior");
  for (int i = 0; i < 50; ++i) {
    const auto posterior = random_posterior(tables.cells(), random);
    for (std::size_t s = 0; s < tables.stimuli(); ++s) {
      EXPECT_NEAR(marginal_information(tables, posterior, s),
                  -expected_entropy(definition, tables, posterior, s), 1e-13);
    }
  }
}

PsiParameters wide_psi() {
  PsiParameters p;
  p.function.sigmoid = Sigmoid::kGaussian;
  p.function.guess = 0.5;
  for (int i = 0; i < 61; ++i) {
    p.levels.push_back(-3.0 + 0.1 * i);
    p.threshold.values.push_back(-3.0 + 0.1 * i);
  }
  p.width.values = {0.5, 1.0, 1.6, 2.5, 4.0};
  p.lapse.values = {0.0, 0.02, 0.05};
  return p;
}

/// Sharpens a posterior as many trials do: most cells have next to nothing.
void sharpen(std::vector<double>& posterior, double power) {
  double sum = 0.0;
  const double most = *std::max_element(posterior.begin(), posterior.end());
  for (double& weight : posterior) {
    sum += weight = std::pow(weight / most, power);
  }
  for (double& weight : posterior) {
    weight /= sum;
  }
}

// Single precision, and cells that are left out, only narrow the choice: what is chosen is the best
// in double precision, with every instruction set.
TEST(SelectionTest, SinglePrecisionDoesNotChangeTheChoice) {
  const QuestTables tables(psi_definition(wide_psi()));
  RandomStream random(3, "posterior");
  for (int i = 0; i < 200; ++i) {
    auto posterior = random_posterior(tables.cells(), random);
    if (i == 0) {
      posterior = tables.prior();
    } else if (i >= 100) {
      sharpen(posterior, i - 98.0);
    }
    double most = 0.0;
    for (std::size_t s = 0; s < tables.stimuli(); ++s) {
      most = std::max(most, information(tables, posterior, s));
    }
    for (InstructionSet set : available_instruction_sets()) {
      StimulusSelection selection(tables, set);
      const std::size_t best = selection.best(tables, posterior);
      EXPECT_GE(information(tables, posterior, best), most - 1e-15) << i << " " << name_of(set);
    }
  }
}

TEST(SelectionTest, RowSumsGiveTheSameBitsAndKeepTheirErrorBound) {
  constexpr std::size_t kGroups = 3 * kBlock + 5;
  constexpr std::size_t kCells = kGroups * kColumns;
  RandomStream random(4, "rows");
  std::vector<float> rows(2 * kCells);
  std::vector<float> weights(kCells);
  for (float& value : rows) {
    value = static_cast<float>(random.uniform());
  }
  for (float& value : weights) {
    value = static_cast<float>(std::exp(5.0 * random.normal()));
  }
  std::vector<std::uint32_t> groups;  // all but every fifth
  for (std::uint32_t g = 0; g < kGroups; ++g) {
    if (g % 5 != 3) {
      groups.push_back(g * kColumns);
    }
  }
  const GroupedWeights grouped{weights.data(), groups};
  double expected[2];
  row_sums(InstructionSet::kBaseline)(rows.data(), 2, kCells, grouped, expected);
  for (std::size_t r = 0; r < 2; ++r) {
    double exact = 0.0;
    for (std::size_t c = 0; c < kCells; ++c) {
      exact +=
          (c / kColumns) % 5 != 3 ? static_cast<double>(rows[r * kCells + c]) * weights[c] : 0.0;
    }
    EXPECT_NEAR(expected[r] / exact, 1.0, kSumError);
  }
  for (InstructionSet set : available_instruction_sets()) {
    double sums[2];
    row_sums(set)(rows.data(), 2, kCells, grouped, sums);
    EXPECT_EQ(sums[0], expected[0]) << name_of(set);
    EXPECT_EQ(sums[1], expected[1]) << name_of(set);
  }
}

TEST(QuestPlusTest, ThePosteriorIsBayesRule) {
  const auto definition = three_outcomes(false);
  const auto tables = std::make_shared<QuestTables>(definition);
  QuestPlus quest(tables, {10, 0.0});
  std::vector<double> expected = tables->prior();
  // The outcomes are on the grid, then off it.
  const std::vector<Outcome> outcomes{{2.0, quest.next()}, {0.0, {0.3, 1.1}}, {1.0, {-4.0, 0.0}}};
  for (const Outcome& outcome : outcomes) {
    double sum = 0.0;
    for (std::size_t c = 0; c < expected.size(); ++c) {
      double out[3];
      definition.model(outcome.applied.data(), tables->parameters(c).data(), out);
      expected[c] *= out[static_cast<int>(outcome.answer)];
      sum += expected[c];
    }
    for (double& p : expected) {
      p /= sum;
    }
    quest.report(outcome.answer, outcome.applied);
  }
  for (std::size_t c = 0; c < expected.size(); ++c) {
    EXPECT_NEAR(quest.posterior()[c], expected[c], 1e-14);
  }
  EXPECT_NEAR(quest.entropy(), entropy_of(expected), 1e-13);
}

TEST(QuestPlusTest, PriorsMarginalsAndEstimates) {
  const QuestPlus quest(std::make_shared<QuestTables>(three_outcomes(false)), {10, 0.0});
  const std::vector<double> prior{1.0 / 7, 2.0 / 7, 3.0 / 7, 1.0 / 7};
  const auto u = quest.marginal(0);
  for (std::size_t i = 0; i < prior.size(); ++i) {
    EXPECT_NEAR(u[i], prior[i], 1e-15);
  }
  const auto estimates = quest.estimates();
  ASSERT_EQ(estimates.size(), 6u);
  EXPECT_EQ(estimates[0].name, "u, mean of the posterior");
  const double mean = (-2.0 - 1.0 + 1.5 + 1.0) / 7.0;
  EXPECT_NEAR(estimates[0].value, mean, 1e-14);
  const double square = (4.0 + 2.0 * 0.25 + 3.0 * 0.25 + 1.0) / 7.0;
  EXPECT_NEAR(estimates[0].deviation.value(), std::sqrt(square - mean * mean), 1e-14);
  EXPECT_FALSE(estimates[0].interval);
  EXPECT_EQ(estimates[0].remark, "not told by the answers");
  EXPECT_EQ(estimates[3].value, 0.5);  // mode of u
}

/// Somebody who never answers 1: how far the threshold lies beyond the list, nothing tells.
TEST(QuestPlusTest, AnIntervalThatTheListOfValuesEndsIsOpen) {
  PsiParameters p = wide_psi();
  QuestPlus quest(std::make_shared<QuestTables>(psi_definition(p)), {40, 0.0});
  while (!quest.finished()) {
    quest.report(0.0, Level(quest.next()));
  }
  const Estimate threshold = quest.estimates().front();
  ASSERT_TRUE(threshold.interval);
  EXPECT_TRUE(std::isinf(threshold.interval->high));
  EXPECT_TRUE(std::isfinite(threshold.interval->low));
  EXPECT_LT(threshold.interval->low, threshold.value);
  EXPECT_EQ(threshold.remark, "cut off by its list of values");
}

TEST(QuestPlusTest, StopsByTrialsOrEntropy) {
  const auto tables = std::make_shared<QuestTables>(psi_definition(wide_psi()));
  QuestPlus by_trials(tables, {2, 0.0});
  by_trials.report(1, by_trials.next());
  EXPECT_FALSE(by_trials.finished());
  by_trials.report(0, by_trials.next());
  EXPECT_TRUE(by_trials.finished());
  QuestPlus by_entropy(tables, {0, 4.0});
  int trials = 0;
  while (!by_entropy.finished() && trials < 1000) {
    EXPECT_GT(by_entropy.entropy(), 4.0);
    by_entropy.report(by_entropy.next()[0] > 0.3, by_entropy.next());
    ++trials;
  }
  EXPECT_LE(by_entropy.entropy(), 4.0);
  EXPECT_LT(trials, 1000);
}

/// People slip, and a slip of the finger must not end a session.
TEST(QuestPlusTest, AnImpossibleAnswerLeavesThePosterior) {
  QuestDefinition d;
  d.stimulus = {{"x", {0.0, 1.0}, {}, false}};
  d.parameters = {{"p", {0.2, 0.7}, {}, false}};
  d.model = [](const double* s, const double* p, double* out) {
    out[1] = s[0] > 0.5 ? p[0] : 0.0;
    out[0] = 1.0 - out[1];
  };
  QuestPlus quest(std::make_shared<QuestTables>(d), {5, 0.0});
  EXPECT_EQ(quest.next(), Level{1.0});
  quest.report(1, {0.0});
  EXPECT_EQ(quest.posterior(), (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(quest.trials(), 1);
}

TEST(QuestPlusTest, DefinitionsOutOfBoundsAreNamed) {
  const auto message = [](auto&& change) {
    auto d = three_outcomes(false);
    change(d);
    return test::message_of<std::invalid_argument>([&] { QuestTables tables(d); });
  };
  const auto names = [&](const char* name, auto&& change) {
    EXPECT_NE(message(change).find(name), std::string::npos) << name << ": " << message(change);
  };
  names("stimulus", [](auto& d) { d.stimulus.clear(); });
  names("values of v", [](auto& d) { d.parameters[1].values = {}; });
  names("values of a", [](auto& d) { d.stimulus[0].values = {NAN}; });
  names("prior of u", [](auto& d) { d.parameters[0].prior = {1.0}; });
  names("prior of u", [](auto& d) { d.parameters[0].prior = {0.0, 0.0, 0.0, 0.0}; });
  names("nuisance", [](auto& d) {
    for (auto& p : d.parameters) {
      p.nuisance = true;
    }
  });
  names("outcomes", [](auto& d) { d.outcomes = 1; });
  names("are 0.4, 0.4, 0.4 for a = -1", [](auto& d) {
    d.model = [](const double*, const double*, double* out) { out[0] = out[1] = out[2] = 0.4; };
  });
}

}  // namespace
}  // namespace haptrial::psychometric
