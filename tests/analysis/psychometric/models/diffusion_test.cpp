// The diffusion model of two choices beside rtdists 0.11-5 (reference/decisions.R) and its laws.
#include "analysis/psychometric/models/diffusion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/analysis/psychometric/models/simulated_choices.h"

namespace haptrial::analysis::diffusion_test {
namespace {

using testing::HasSubstr;

TEST(DiffusionTest, DensitiesAreThoseOfRtdists) {
  struct Case {
    Diffusion model;
    bool upper;
    double time, density;
  };
  const std::vector<Case> cases{{{1.0, 1.5, 0.3, 0.5}, true, 0.8, 0.7685207367315},
                                {{1.0, 1.5, 0.3, 0.5}, false, 0.8, 0.1714801550643},
                                {{-2.0, 0.8, 0.2, 0.3}, true, 0.25, 0.2561436293301},
                                {{0.5, 2.5, 0.4, 0.6}, false, 3.0, 0.0208890724981},
                                {{3.0, 1.0, 0.1, 0.5}, true, 0.15, 5.2410019421204},
                                {{0.0, 1.0, 0.0, 0.5}, true, 0.5, 0.2664226763649}};
  for (const Case& each : cases) {
    EXPECT_NEAR(diffusion_density(each.model, each.upper, each.time), each.density,
                1e-9 * each.density);
  }
  EXPECT_EQ(diffusion_density(cases[0].model, true, 0.3), 0.0);
}

TEST(DiffusionTest, DensitiesHaveTheSharesAndTheMeanOfTheirLaw) {
  for (const Diffusion& model : {Diffusion{1.2, 1.4, 0.25, 0.5}, Diffusion{-0.7, 1.0, 0.1, 0.35},
                                 Diffusion{0.0, 2.0, 0.2, 0.7}}) {
    constexpr double kStep = 5e-4;
    double share = 0.0, all = 0.0, mean = 0.0;
    for (double t = model.non_decision + 0.5 * kStep; t < 40.0; t += kStep) {
      const double upper = diffusion_density(model, true, t);
      const double lower = diffusion_density(model, false, t);
      share += kStep * upper;
      all += kStep * (upper + lower);
      mean += kStep * (upper + lower) * (t - model.non_decision);
    }
    EXPECT_NEAR(all, 1.0, 1e-6);
    EXPECT_NEAR(share, diffusion_share(model), 1e-6);
    const double a = model.boundary, z = model.start * a, v = model.drift;
    EXPECT_NEAR(mean, v == 0.0 ? z * (a - z) : (a * share - z) / v, 1e-5);  // Wald's identity
  }
}

std::vector<TimedChoice> choices_of_r() {
  std::ifstream file(std::string(HAPTRIAL_SOURCE_DIR) +
                     "/tests/analysis/psychometric/models/reference/decisions.csv");
  std::vector<TimedChoice> choices;
  std::string line;
  for (std::getline(file, line); std::getline(file, line);) {
    choices.push_back({line[0] == '1', std::stod(line.substr(2))});
  }
  return choices;
}

TEST(DiffusionTest, TheFitIsTheOneOfRtdists) {
  const auto choices = choices_of_r();
  ASSERT_EQ(choices.size(), 120U);
  const auto fit = fit_diffusion(choices, {});
  ASSERT_TRUE(fit) << fit.because();
  EXPECT_NEAR(fit->drift.value, 1.40186, 1e-4);
  EXPECT_NEAR(fit->boundary.value, 1.46646, 1e-4);
  EXPECT_NEAR(fit->non_decision.value, 0.280010, 1e-4);
  EXPECT_NEAR(fit->log_likelihood, -33.107377694758, 1e-6);
  EXPECT_NEAR(fit->drift.low, 1.0967, 4e-3);
  EXPECT_NEAR(fit->drift.high, 1.7080, 4e-3);
}

struct Held {
  int drift{0}, boundary{0}, non_decision{0}, far{0}, fits{0};
  double drift_sum{0.0}, boundary_sum{0.0}, non_decision_sum{0.0};
};

bool holds(const DiffusionEstimate& e, double truth) { return e.low <= truth && truth <= e.high; }

Held fitted_observers(const Diffusion& truth, std::size_t trials, int first, int last) {
  Held held;
  for (int i = first; i < last; ++i) {
    RandomStream random(11, "observer " + std::to_string(i));
    const auto fit = fit_diffusion(test::simulated_choices(truth, trials, random), {});
    if (!fit) {
      continue;
    }
    ++held.fits;
    held.drift += holds(fit->drift, truth.drift) ? 1 : 0;
    held.boundary += holds(fit->boundary, truth.boundary) ? 1 : 0;
    held.non_decision += holds(fit->non_decision, truth.non_decision) ? 1 : 0;
    held.far += fit->distance > 1.36 / std::sqrt(static_cast<double>(trials)) ? 1 : 0;
    held.drift_sum += fit->drift.value - truth.drift;
    held.boundary_sum += fit->boundary.value - truth.boundary;
    held.non_decision_sum += fit->non_decision.value - truth.non_decision;
  }
  return held;
}

Held fitted_on_two_threads(const Diffusion& truth, std::size_t trials, int observers) {
  Held first, second;
  {
    const std::jthread half([&] { first = fitted_observers(truth, trials, 0, observers / 2); });
    second = fitted_observers(truth, trials, observers / 2, observers);
  }
  return {first.drift + second.drift,
          first.boundary + second.boundary,
          first.non_decision + second.non_decision,
          first.far + second.far,
          first.fits + second.fits,
          first.drift_sum + second.drift_sum,
          first.boundary_sum + second.boundary_sum,
          first.non_decision_sum + second.non_decision_sum};
}

TEST(DiffusionTest, IntervalsOfManyObserversHoldTheTruth) {
  constexpr int kObservers = 300;
  constexpr int kLeast = 271, kMost = 296;  // 99.9 % of binomial counts of 300 at 0.95
  const Held held = fitted_on_two_threads({2.0, 1.2, 0.3, 0.5}, 200, kObservers);
  EXPECT_EQ(held.fits, kObservers);
  for (const int count : {held.drift, held.boundary, held.non_decision}) {
    EXPECT_GE(count, kLeast);
    EXPECT_LE(count, kMost);
  }
  EXPECT_LE(held.far, kObservers / 20);
  EXPECT_NEAR(held.drift_sum / held.fits, 0.0, 0.05);
  EXPECT_NEAR(held.boundary_sum / held.fits, 0.0, 0.025);
  EXPECT_NEAR(held.non_decision_sum / held.fits, 0.0, 0.002);
}

// The table of docs/algorithms/decisions.md.
TEST(DiffusionTest, CoverageIsThatOfThePage) {
  if (std::getenv("HAPTRIAL_EVERY_STUDY") == nullptr) {
    GTEST_SKIP() << "takes minutes without HAPTRIAL_EVERY_STUDY";
  }
  struct Case {
    Diffusion truth;
    std::size_t trials;
  };
  for (const auto& [truth, trials] :
       {Case{{1.0, 1.5, 0.3, 0.5}, 100}, Case{{1.0, 1.5, 0.3, 0.5}, 200},
        Case{{1.0, 1.5, 0.3, 0.5}, 400}, Case{{0.0, 1.5, 0.3, 0.5}, 200},
        Case{{2.0, 1.2, 0.3, 0.5}, 200}, Case{{2.0, 2.0, 0.4, 0.5}, 200}}) {
    const Held h = fitted_on_two_threads(truth, trials, 1000);
    std::printf("| %g | %g | %g | %zu | %d | %.1f %% | %.1f %% | %.1f %% | %.3f | %.3f | %.4f |\n",
                truth.drift, truth.boundary, truth.non_decision, trials, h.fits,
                100.0 * h.drift / h.fits, 100.0 * h.boundary / h.fits,
                100.0 * h.non_decision / h.fits, h.drift_sum / h.fits, h.boundary_sum / h.fits,
                h.non_decision_sum / h.fits);
    for (const int count : {h.drift, h.boundary, h.non_decision}) {
      EXPECT_GE(count, 0.93 * h.fits);
      EXPECT_LE(count, 0.97 * h.fits);
    }
  }
}

TEST(DiffusionTest, AStatedShareOfGuessesKeepsThemFromTheParameters) {
  RandomStream random(3, "guesses");
  const Diffusion truth{1.5, 1.4, 0.3, 0.5};
  auto choices = test::simulated_choices(truth, 1000, random);
  for (std::size_t i = 0; i < choices.size(); i += 20) {
    choices[i] = {random.uniform() < 0.5, random.uniform(0.05, 4.0)};
  }
  const auto without = fit_diffusion(choices, {});
  const auto with = fit_diffusion(choices, {.contaminants = 0.05});
  ASSERT_TRUE(without && with);
  EXPECT_LT(without->non_decision.value, 0.2);
  EXPECT_TRUE(holds(with->drift, truth.drift));
  EXPECT_TRUE(holds(with->boundary, truth.boundary));
  EXPECT_TRUE(holds(with->non_decision, truth.non_decision));
}

TEST(DiffusionTest, TimesOfAnotherKindAreFarFromTheModel) {
  std::vector<TimedChoice> choices;
  for (int i = 0; i < 200; ++i) {
    choices.push_back({i % 5 != 0, i % 2 == 0 ? 0.4 + 1e-4 * i : 2.0 + 1e-4 * i});
  }
  const auto fit = fit_diffusion(choices, {});
  ASSERT_TRUE(fit) << fit.because();
  EXPECT_GT(fit->distance, 1.36 / std::sqrt(200.0));
}

TEST(DiffusionTest, AnswersThatDoNotTellAreNotDefined) {
  std::vector<TimedChoice> choices(39, {true, 0.5});
  EXPECT_THAT(fit_diffusion(choices, {}).because(), HasSubstr("fewer than 40"));
  choices.resize(60, {true, 0.6});
  EXPECT_THAT(fit_diffusion(choices, {}).because(), HasSubstr("all answers are of one kind"));
  choices.front() = {false, 0.0};
  EXPECT_THAT(fit_diffusion(choices, {}).because(), HasSubstr("not above 0"));
  EXPECT_THROW(fit_diffusion(choices, {.start = 1.0}), std::invalid_argument);
  EXPECT_THROW(fit_diffusion(choices, {.contaminants = 1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis::diffusion_test
