// Every procedure with observers of known threshold, and every procedure fed with what another
// session recorded.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "core/psychometric/function/response_observer.h"
#include "core/psychometric/procedure/listed.h"
#include "core/psychometric/procedure/pest.h"
#include "core/psychometric/procedure/psi_definition.h"
#include "core/psychometric/procedure/quest_plus.h"
#include "core/psychometric/procedure/staircase.h"
#include "core/psychometric/procedure/staircase_chain.h"

namespace haptrial::psychometric {
namespace {

using Made = std::unique_ptr<Procedure>;

PsychometricParameters two_intervals(double threshold) {
  PsychometricParameters p;
  p.sigmoid = Sigmoid::kGaussian;
  p.threshold = threshold;
  p.width = width_of_rate(p.sigmoid, 1.0);
  p.guess = 0.5;
  return p;
}

StaircaseParameters staircase_parameters() {
  StaircaseParameters p;
  p.start = 3.0;
  p.low = -6.0;
  p.high = 6.0;
  p.steps = {{1.0, 1.0, 0}, {0.5, 0.5, 2}};
  p.stop_reversals = 10;
  p.stop_trials = 80;
  p.skip = 2;
  return p;
}

PestParameters pest_parameters() {
  PestParameters p;
  p.start = 3.0;
  p.low = -6.0;
  p.high = 6.0;
  p.first_step = 1.0;
  p.smallest_step = 0.1;
  p.largest_step = 2.0;
  p.stop_trials = 400;
  return p;
}

std::shared_ptr<const QuestTables> psi_tables(bool marginal) {
  PsiParameters p;
  p.function = two_intervals(0.0);
  for (int i = 0; i <= 40; ++i) {
    p.levels.push_back(-5.0 + 0.25 * i);
    p.threshold.values.push_back(-4.0 + 0.2 * i);
  }
  for (double sigma : {0.5, 0.7, 1.0, 1.4, 2.0}) {
    p.width.values.push_back(width_of_rate(p.function.sigmoid, 1.0 / sigma));
  }
  if (marginal) {
    p.lapse.values = {0.0, 0.02, 0.04};
    p.lapse.nuisance = true;
  }
  return std::make_shared<QuestTables>(psi_definition(p));
}

/// Level that a device applies if its levels are multiples of the quantum.
Level quantised(Level level, double quantum) {
  if (quantum > 0.0) {
    level[0] = quantum * std::round(level[0] / quantum);
  }
  return level;
}

/// Runs to the end. @return what was recorded
std::vector<Outcome> run(Procedure& procedure, ResponseObserver& observer, double quantum) {
  std::vector<Outcome> outcomes;
  while (!procedure.finished()) {
    const Level level = quantised(procedure.next(), quantum);
    const double answer = observer.answer(level[0]);
    outcomes.push_back({answer, level});
    procedure.report(answer, level);
  }
  return outcomes;
}

struct Spread {
  double mean{0.0}, deviation{0.0};
};

Spread spread_of(const std::vector<double>& values) {
  Spread s;
  const auto n = static_cast<double>(values.size());
  for (double value : values) {
    s.mean += value / n;
  }
  for (double value : values) {
    s.deviation += (value - s.mean) * (value - s.mean) / (n - 1.0);
  }
  s.deviation = std::sqrt(s.deviation);
  return s;
}

/// First estimates of many sessions.
std::vector<double> estimates_of(int sessions, double threshold,
                                 const std::function<Made()>& make) {
  std::vector<double> values;
  for (int i = 0; i < sessions; ++i) {
    ResponseObserver observer({two_intervals(threshold), 0.0, 0.0}, static_cast<std::uint64_t>(i),
                              "observer");
    const Made procedure = make();
    run(*procedure, observer, 0.0);
    const auto estimates = procedure->estimates();
    if (!estimates.empty()) {
      values.push_back(estimates[0].value);
    }
  }
  return values;
}

// The exact prediction is the target: it has the bias that steps of this size bring.
TEST(ConvergenceTest, AStaircaseGivesWhatTheChainPredicts) {
  const auto parameters = staircase_parameters();
  const PsychometricFunction psi(two_intervals(0.7));
  const auto predicted = predict_staircase(parameters, psi, psi.level_for(std::sqrt(0.5)));
  const auto values =
      estimates_of(4000, 0.7, [&] { return std::make_unique<Staircase>(parameters); });
  const Spread found = spread_of(values);
  EXPECT_NEAR(found.mean, predicted.mean, 4.0 * predicted.deviation / std::sqrt(4000.0));
  EXPECT_NEAR(found.deviation / predicted.deviation, 1.0, 4.0 / std::sqrt(2.0 * 4000.0));
}

TEST(ConvergenceTest, PestEndsNearItsTarget) {
  auto parameters = pest_parameters();
  const auto tracks = estimates_of(1000, 0.7, [&] { return std::make_unique<Pest>(parameters); });
  EXPECT_GT(tracks.size(), 990u);  // the others reach 400 trials
  const Spread found = spread_of(tracks);
  const PsychometricFunction psi(two_intervals(0.7));
  // Taylor and Creelman find no bias beyond a fraction of the spread.
  EXPECT_NEAR(found.mean, psi.level_for(0.75), 0.5 * found.deviation);
  EXPECT_LT(found.deviation, 1.0);
}

/// The mean of the posterior over sessions, and how often ± 2 deviations hold the truth.
void expect_unbiased(bool marginal) {
  const auto tables = psi_tables(marginal);
  std::vector<double> values;
  int held = 0;
  constexpr int kSessions = 200;
  RandomStream random(7, "thresholds");
  for (int i = 0; i < kSessions; ++i) {
    // Thresholds from the prior: then the posterior is calibrated, whatever was presented.
    const double threshold = -4.0 + 0.2 * static_cast<double>(random.below(41));
    auto function = two_intervals(threshold);
    const auto& widths = tables->definition().parameters[1].values;
    function.width = widths[random.below(widths.size())];
    const auto& lapses = tables->definition().parameters[3].values;
    function.lapse = lapses[random.below(lapses.size())];
    ResponseObserver observer({function, 0.0, 0.0}, static_cast<std::uint64_t>(i), "observer");
    QuestPlus quest(tables, {60, 0.0});
    run(quest, observer, 0.0);
    const Estimate estimate = quest.estimates()[0];
    values.push_back((estimate.value - threshold) / *estimate.deviation);
    // The posterior's probability of thresholds below the truth is uniform; here its outer 10 %.
    const auto shares = quest.marginal(0);
    double below = 0.0;
    for (std::size_t t = 0; t < shares.size(); ++t) {
      const double value = tables->definition().parameters[0].values[t];
      below += value < threshold - 1e-9             ? shares[t]
               : std::abs(value - threshold) < 1e-9 ? shares[t] * random.uniform()
                                                    : 0.0;
    }
    held += below > 0.05 && below < 0.95;
  }
  const Spread found = spread_of(values);
  EXPECT_NEAR(found.mean, 0.0, 4.0 / std::sqrt(1.0 * kSessions));
  EXPECT_NEAR(found.deviation, 1.0, 0.2);
  EXPECT_NEAR(held, 0.9 * kSessions, 4.0 * std::sqrt(0.09 * kSessions));  // binomial
}

TEST(ConvergenceTest, PsiKnowsHowMuchItKnows) { expect_unbiased(false); }
TEST(ConvergenceTest, MarginalPsiKnowsHowMuchItKnows) { expect_unbiased(true); }

TEST(ConvergenceTest, SharesOfConstantStimuliAreThoseOfTheFunction) {
  ConstantStimuli procedure({{-1.0, 0.0, 1.0, 2.0}, 5000, false}, 1, "levels");
  ResponseObserver observer({two_intervals(0.7), 0.0, 0.0}, 1, "observer");
  run(procedure, observer, 0.0);
  const PsychometricFunction psi(two_intervals(0.7));
  for (double level : {-1.0, 0.0, 1.0, 2.0}) {
    double right = 0.0;
    for (const Outcome& outcome : procedure.outcomes()) {
      right += outcome.applied[0] == level ? outcome.answer : 0.0;
    }
    const double p = psi(level);
    EXPECT_NEAR(right / 5000.0, p, 4.0 * std::sqrt(p * (1.0 - p) / 5000.0));
  }
}

// A session that was broken off at any trial goes on as it would have gone on.
TEST(ReplayTest, RecordedOutcomesGiveTheSameNextLevels) {
  const auto tables = psi_tables(false);
  const auto marginal = psi_tables(true);
  const std::vector<std::function<Made()>> makers{
      [] { return std::make_unique<Staircase>(staircase_parameters()); },
      [] { return std::make_unique<Pest>(pest_parameters()); },
      [] {
        return std::make_unique<ConstantStimuli>(ListParameters{{0.0, 0.5, 1.0}, 20, true}, 5,
                                                 "levels");
      },
      [&] {
        return std::make_unique<QuestPlus>(tables, QuestStop{40, 0.0});
      },
      [&] {
        return std::make_unique<QuestPlus>(marginal, QuestStop{20, 0.0});
      }};
  for (std::size_t m = 0; m < makers.size(); ++m) {
    const Made whole = makers[m]();
    ResponseObserver observer({two_intervals(0.7), 0.2, 0.0}, 11, "observer");
    const auto outcomes = run(*whole, observer, 0.03);
    ASSERT_GT(outcomes.size(), 10u);
    const std::size_t half = outcomes.size() / 2;
    const Made resumed = makers[m]();
    replay(*resumed, std::span(outcomes).first(half));
    const Made other = makers[m]();
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      ASSERT_EQ(quantised(other->next(), 0.03), outcomes[i].applied);
      if (i >= half) {
        ASSERT_EQ(resumed->next(), other->next()) << "procedure " << m << ", trial " << i;
        resumed->report(outcomes[i].answer, outcomes[i].applied);
      }
      other->report(outcomes[i].answer, outcomes[i].applied);
    }
    EXPECT_TRUE(resumed->finished());
    const auto a = resumed->estimates();
    const auto b = whole->estimates();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].value, b[i].value);
      EXPECT_EQ(a[i].deviation, b[i].deviation);
    }
  }
}

}  // namespace
}  // namespace haptrial::psychometric
