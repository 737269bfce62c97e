#include <gsl/gsl_cdf.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_randist.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/psychometric/models/detection.h"
#include "analysis/psychometric/models/magnitude.h"
#include "analysis/psychometric/models/rating.h"
#include "analysis/statistics/base/solvers.h"
#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

double z(double share) { return gsl_cdf_ugaussian_Pinv(share); }

TEST(Detection, IsTheDifferenceOfNormalQuantiles) {
  for (const auto& [hits, alarms] : {std::pair{40.0, 10.0}, {25.0, 25.0}, {12.0, 31.0}}) {
    const auto d = detection({hits, 50.0 - hits, alarms, 50.0 - alarms}, RateCorrection::kNone);
    ASSERT_TRUE(d);
    EXPECT_NEAR(d->d_prime, z(hits / 50.0) - z(alarms / 50.0), 1e-13);
    EXPECT_NEAR(d->criterion, -0.5 * (z(hits / 50.0) + z(alarms / 50.0)), 1e-13);
    EXPECT_NEAR(d->log_beta, 0.5 * (z(alarms / 50) * z(alarms / 50) - z(hits / 50) * z(hits / 50)),
                1e-13);
  }
}

// R 4.2.2: qnorm(H) - qnorm(F), -(qnorm(H) + qnorm(F)) / 2 and (qnorm(F)^2 - qnorm(H)^2) / 2.
TEST(Detection, GivesTheAnswersOfR) {
  struct Case {
    DetectionCounts counts;
    RateCorrection correction;
    double d_prime, criterion, log_beta;
  };
  const Case cases[] = {{{40, 10, 10, 40}, RateCorrection::kNone, 1.6832424671458286, 0.0, 0.0},
                        {{12, 38, 31, 19},
                         RateCorrection::kNone,
                         -1.0117833509394849,
                         0.20041088737034507,
                         -0.20277239918832343},
                        {{49, 1, 1, 49}, RateCorrection::kNone, 4.1074978212636442, 0.0, 0.0},
                        {{20, 0, 0, 25},
                         RateCorrection::kLogLinear,
                         4.0506542275423296,
                         0.044574717123886387,
                         0.1805567663593739}};
  for (const Case& c : cases) {
    const auto d = detection(c.counts, c.correction);
    ASSERT_TRUE(d);
    EXPECT_NEAR(d->d_prime, c.d_prime, 1e-13);
    EXPECT_NEAR(d->criterion, c.criterion, 1e-13);
    EXPECT_NEAR(d->log_beta, c.log_beta, 1e-13);
  }
}

TEST(Detection, CorrectsExtremeRates) {
  const DetectionCounts all{20, 0, 0, 25};
  EXPECT_FALSE(detection(all, RateCorrection::kNone));
  const auto log_linear = detection(all, RateCorrection::kLogLinear);
  EXPECT_NEAR(log_linear->d_prime, z(20.5 / 21.0) - z(0.5 / 26.0), 1e-13);
  const auto extremes = detection(all, RateCorrection::kExtremes);
  EXPECT_NEAR(extremes->d_prime, z(1.0 - 0.5 / 20.0) - z(0.5 / 25.0), 1e-13);
  const auto inner = detection({15, 5, 5, 20}, RateCorrection::kExtremes);
  EXPECT_NEAR(inner->d_prime, z(0.75) - z(0.2), 1e-13);
  EXPECT_FALSE(detection({0, 0, 3, 4}, RateCorrection::kLogLinear));
  EXPECT_THROW(detection({-1, 2, 3, 4}, RateCorrection::kNone), std::invalid_argument);
}

TEST(Detection, HasAnIntervalThatHoldsTheTruth) {
  RandomStream random(2, "detection");
  constexpr int kRuns = 2000;
  int held = 0;
  for (int run = 0; run < kRuns; ++run) {
    DetectionCounts c;
    for (int t = 0; t < 100; ++t) {
      (random.normal() + 1.2 > 0.5 ? c.hits : c.misses) += 1.0;
      (random.normal() > 0.5 ? c.false_alarms : c.correct_rejections) += 1.0;
    }
    const auto d = detection(c, RateCorrection::kLogLinear);
    held += d->low <= 1.2 && 1.2 <= d->high ? 1 : 0;
  }
  EXPECT_GE(held, static_cast<int>(0.93 * kRuns));
  EXPECT_LE(held, static_cast<int>(0.97 * kRuns));
}

TEST(Detection, OfAForcedChoice) {
  for (const double share : {0.3, 0.5, 0.75, 0.99}) {
    EXPECT_NEAR(*forced_choice_d_prime(share, 2), std::sqrt(2.0) * z(share), 1e-10);
  }
  // Without sensitivity each of m alternatives is right by chance; and of three the integral of
  // phi(x - d) Phi(x)^2 is a probability of two dependent normal values, 1/3 + asin terms at d = 0.
  for (const int m : {2, 3, 4, 8}) {
    EXPECT_NEAR(forced_choice_share(0.0, m), 1.0 / m, 1e-12);
    EXPECT_NEAR(*forced_choice_d_prime(1.0 / m, m), 0.0, 1e-10);
    EXPECT_NEAR(forced_choice_share(*forced_choice_d_prime(0.7, m), m), 0.7, 1e-12);
  }
  // Drawn, not integrated.
  RandomStream random(8, "forced choice");
  const double d_prime = *forced_choice_d_prime(0.7, 4);
  int right = 0;
  constexpr int kTrials = 200000;
  for (int t = 0; t < kTrials; ++t) {
    const double signal = d_prime + random.normal();
    bool largest = true;
    for (int other = 0; other < 3; ++other) {
      largest = random.normal() < signal && largest;
    }
    right += largest ? 1 : 0;
  }
  EXPECT_NEAR(right / double(kTrials), 0.7, 4.0 * std::sqrt(0.21 / kTrials));
  EXPECT_FALSE(forced_choice_d_prime(1.0, 2));
  EXPECT_THROW(forced_choice_share(1.0, 1), std::invalid_argument);
}

/// The same share another way round: the signal beats the largest of the m - 1 others, whose
/// density is (m - 1) phi(y) Phi(y)^(m - 2).
double share_over_the_largest(double d_prime, int m) {
  struct Choice {
    double d_prime;
    int m;
  } choice{d_prime, m};
  gsl_function function{[](double y, void* c) {
                          const auto& at = *static_cast<const Choice*>(c);
                          return (at.m - 1) * gsl_ran_ugaussian_pdf(y) *
                                 std::pow(gsl_cdf_ugaussian_P(y), at.m - 2) *
                                 gsl_cdf_ugaussian_P(at.d_prime - y);
                        },
                        &choice};
  gsl_integration_workspace* space = gsl_integration_workspace_alloc(1000);
  double share = 0.0, error = 0.0;
  gsl_integration_qagi(&function, 0.0, 1e-13, 1000, space, &share, &error);
  gsl_integration_workspace_free(space);
  return share;
}

TEST(Detection, OfAForcedChoiceIsThatOfThePublishedTable) {
  struct Row {
    int alternatives;
    double share, d_prime;
  };
  // Values of Hacker and Ratcliff 1979 to two digits; the integral confirms each here.
  const Row rows[] = {{2, 0.76, 1.00}, {3, 0.75, 1.43}, {4, 0.75, 1.68}};
  for (const Row& row : rows) {
    const double d_prime = *forced_choice_d_prime(row.share, row.alternatives);
    EXPECT_NEAR(d_prime, row.d_prime, 0.006) << row.alternatives;
    EXPECT_NEAR(share_over_the_largest(row.d_prime, row.alternatives), row.share, 0.002);
  }
  for (const int m : {2, 3, 4, 8, 32, 1000}) {
    for (const double d : {-1.0, 0.3, 1.0, 2.5, 5.0}) {
      EXPECT_NEAR(forced_choice_share(d, m), share_over_the_largest(d, m), 1e-11) << m << ", " << d;
    }
  }
}

// The trapezoids under a curve of five ratings, worked by hand from the cumulative shares.
TEST(Rating, AreaIsThatUnderThePoints) {
  const RatingCounts counts{{40, 30, 20, 10}, {10, 15, 30, 45}};
  const auto roc = rating_roc(counts);
  ASSERT_TRUE(roc);
  // (F, H): (0, 0), (.1, .45), (.3, .75), (.6, .9), (1, 1)
  const double area = 0.1 * 0.225 + 0.2 * 0.6 + 0.3 * 0.825 + 0.4 * 0.95;
  EXPECT_NEAR(roc->area, area, 1e-12);
  ASSERT_EQ(roc->curve.size(), 5u);
  EXPECT_NEAR(roc->curve[2].true_positives, 0.75, 1e-12);
  ASSERT_TRUE(roc->interval);
  EXPECT_LT(roc->interval->low, area);
  EXPECT_GT(roc->interval->high, area);
}

// Shares that a binormal observer gives exactly: the fit finds the observer.
TEST(Rating, FindsABinormalObserver) {
  const std::vector<double> criteria{-0.5, 0.2, 0.9, 1.6};
  const double mean = 1.3, sd = 1.25;
  RatingCounts counts;
  double last_noise = 0.0, last_signal = 0.0;
  const double trials = 1e8;
  for (std::size_t k = 0; k <= criteria.size(); ++k) {
    const double noise = k < 4 ? gsl_cdf_ugaussian_P(criteria[k]) : 1.0;
    const double signal = k < 4 ? gsl_cdf_ugaussian_P((criteria[k] - mean) / sd) : 1.0;
    counts.noise.push_back(static_cast<int>(std::lround(trials * (noise - last_noise))));
    counts.signal.push_back(static_cast<int>(std::lround(trials * (signal - last_signal))));
    last_noise = noise;
    last_signal = signal;
  }
  const auto fit = binormal_roc(counts);
  ASSERT_TRUE(fit) << fit.because();
  EXPECT_NEAR(fit->a, mean / sd, 1e-6);
  EXPECT_NEAR(fit->b, 1.0 / sd, 1e-6);
  EXPECT_NEAR(fit->area, gsl_cdf_ugaussian_P(mean / std::sqrt(1.0 + sd * sd)), 1e-7);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(fit->criteria[k], criteria[k], 1e-6);
  }
  EXPECT_EQ(fit->df, 2);
  EXPECT_NEAR(fit->deviance, 0.0, 1e-4);
}

// A search without derivatives finds nothing likelier.
TEST(Rating, IsTheLargestLikelihood) {
  const RatingCounts counts{{174, 172, 104, 92, 41, 8}, {46, 57, 66, 101, 154, 173}};
  const auto fit = binormal_roc(counts);
  ASSERT_TRUE(fit) << fit.because();
  const auto minus = [&](std::span<const double> p) {
    double sum = 0.0, last_noise = 0.0, last_signal = 0.0;
    for (std::size_t k = 0; k < 6; ++k) {
      const double noise = k < 5 ? gsl_cdf_ugaussian_P(p[2 + k]) : 1.0;
      const double signal = k < 5 ? gsl_cdf_ugaussian_P(p[1] * p[2 + k] - p[0]) : 1.0;
      sum -= counts.noise[k] * std::log(noise - last_noise) +
             counts.signal[k] * std::log(signal - last_signal);
      last_noise = noise;
      last_signal = signal;
    }
    return sum;
  };
  const std::vector<double> start{1.0, 1.0, -0.5, 0.2, 0.7, 1.3, 2.1};
  const Minimum other = find_minimum(minus, start, std::vector<double>(7, 0.1));
  EXPECT_GE(fit->log_likelihood, -other.value - 1e-9);
  EXPECT_NEAR(fit->log_likelihood, -other.value, 1e-6);
  EXPECT_NEAR(fit->a, other.at[0], 1e-3);
  EXPECT_FALSE(binormal_roc({{10, 0, 0}, {0, 0, 10}}));
  EXPECT_THROW(rating_roc({{1, 2}, {1}}), std::invalid_argument);
}

// Estimates that follow power laws exactly, each participant in a modulus of their own.
TEST(PowerLaw, FindsExponentAndModuli) {
  const std::vector<double> exponents{0.8, 1.0, 1.2}, moduli{2.0, 10.0, 50.0};
  std::vector<MagnitudeTrial> trials;
  for (std::size_t person = 0; person < 3; ++person) {
    for (const double level : {1.0, 2.0, 4.0, 8.0}) {
      const double exact = moduli[person] * std::pow(level, exponents[person]);
      // Two repeats with the geometric mean `exact`.
      trials.push_back({person, level, exact * 1.1});
      trials.push_back({person, level, exact / 1.1});
    }
  }
  const auto law = power_law(trials);
  ASSERT_TRUE(law) << law.because();
  EXPECT_NEAR(law->exponent, 1.0, 1e-12);
  EXPECT_NEAR(law->error, 0.2 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(*law->high - 1.0, gsl_cdf_tdist_Pinv(0.975, 2.0) * 0.2 / std::sqrt(3.0), 1e-9);
  for (std::size_t person = 0; person < 3; ++person) {
    EXPECT_NEAR(law->exponents[person], exponents[person], 1e-12);
  }
  // The modulus is the ratio of geometric means: at level sqrt 8 the person's value.
  const double together = std::cbrt(2.0 * 10.0 * 50.0 * std::pow(8.0, 1.5));
  EXPECT_NEAR(law->moduli[0], 2.0 * std::pow(8.0, 0.4) / together, 1e-12);
  ASSERT_EQ(law->levels.size(), 4u);
  EXPECT_NEAR(law->levels[1].mean, 10.0 * 2.0, 1e-10);
  EXPECT_NEAR(law->constant, 10.0, 1e-10);
  EXPECT_NEAR(law->r_squared, 1.0, 1e-12);
}

// Participants with one exponent who miss levels: equalisation leaves means on one line.
TEST(PowerLaw, EqualisesModuliWithLevelsMissing) {
  std::vector<MagnitudeTrial> trials;
  for (const double level : {1.0, 2.0, 4.0}) {
    trials.push_back({7, level, 3.0 * std::sqrt(level)});
  }
  for (const double level : {4.0, 8.0, 16.0}) {
    trials.push_back({9, level, 100.0 * std::sqrt(level)});
  }
  const auto law = power_law(trials);
  ASSERT_TRUE(law) << law.because();
  EXPECT_NEAR(law->exponent, 0.5, 1e-12);
  EXPECT_NEAR(law->moduli[1] / law->moduli[0], 100.0 / 3.0, 1e-9);
  EXPECT_NEAR(law->r_squared, 1.0, 1e-12);
  trials.erase(trials.begin() + 2);
  EXPECT_FALSE(power_law(trials));  // no level in common
  EXPECT_FALSE(power_law(std::vector<MagnitudeTrial>{{1, 1.0, 2.0}}));
  EXPECT_FALSE(power_law(std::vector<MagnitudeTrial>{{1, 1.0, 2.0}, {1, 2.0, 0.0}}));
}

// Logarithms 0, 1, 1 at three levels an octave apart: residuals -1/6, 1/3, -1/6.
TEST(PowerLaw, SaysHowWellEachExponentIsKnown) {
  const double e = std::exp(1.0), octave = std::log(2.0);
  const auto law = power_law(std::vector<MagnitudeTrial>{{1, 1.0, 1.0}, {1, 2.0, e}, {1, 4.0, e}});
  ASSERT_TRUE(law) << law.because();
  const PersonalLine& line = law->lines.at(0);
  EXPECT_NEAR(law->exponents[0], 0.5 / octave, 1e-12);
  EXPECT_NEAR(line.r_squared, 0.75, 1e-12);
  EXPECT_NEAR(line.deviation, std::sqrt(1.0 / 6.0), 1e-12);
  EXPECT_NEAR(line.high - law->exponents[0],
              gsl_cdf_tdist_Pinv(0.975, 1.0) * std::sqrt(1.0 / 12.0) / octave, 1e-9);
}

struct JudgedTask {
  DiscriminationTask task;
  double share, d_prime;
};

/// dprime.oddity(), dprime.ABX(method = "diff") and dprime.SD(method = "IO") of R's psyphy 0.2-3.
constexpr JudgedTask kJudgedTasks[] = {
    {DiscriminationTask::kOddity, 0.36, 0.545390},
    {DiscriminationTask::kOddity, 0.60, 1.975585},
    {DiscriminationTask::kOddity, 0.80, 3.128594},
    {DiscriminationTask::kOddity, 0.95, 4.800714},
    {DiscriminationTask::kAbx, 0.52, 0.472318},
    {DiscriminationTask::kAbx, 0.75, 2.020038},
    {DiscriminationTask::kAbx, 0.97, 4.625318},
    {DiscriminationTask::kSameDifferent, 0.52, 0.506694},
    {DiscriminationTask::kSameDifferent, 0.75, 2.103592},
    {DiscriminationTask::kSameDifferent, 0.97, 4.328008},
    {DiscriminationTask::kOneInterval, 0.75, 1.348980},  // 2 qnorm(0.75) of R
    {DiscriminationTask::kOneInterval, 0.40, -0.506694},
};

TEST(DiscriminationTaskTest, AgreesWithPsyphy) {
  for (const JudgedTask& each : kJudgedTasks) {
    EXPECT_NEAR(*task_d_prime(each.task, each.share, 3), each.d_prime, 1e-4) << each.share;
  }
}

/// Observers who compare noisy stimuli are as often right as is computed.
TEST(DiscriminationTaskTest, SimulatedObserversAreAsOftenRight) {
  constexpr int kTrials = 100'000;
  constexpr double kD = 1.5;
  RandomStream random(1, "observers");
  int odd = 0, abx = 0, same = 0, one = 0;
  for (int i = 0; i < kTrials; ++i) {
    const double a = random.normal(), b = random.normal(), x = kD + random.normal();
    odd += std::abs(a - b) < std::min(std::abs(a - x), std::abs(b - x)) ? 1 : 0;
    const double other = kD + random.normal(), as_other = kD + random.normal();
    abx += std::abs(as_other - other) < std::abs(as_other - a) ? 1 : 0;
    const auto is_high = [](double value) { return value > kD / 2.0; };
    same += is_high(a) == is_high(b) ? 1 : 0;
    one += is_high(x) ? 1 : 0;
  }
  const auto expect = [&](int right, DiscriminationTask task) {
    EXPECT_NEAR(static_cast<double>(right) / kTrials, task_share(task, kD, 3), 0.005);
  };
  expect(odd, DiscriminationTask::kOddity);
  expect(abx, DiscriminationTask::kAbx);
  expect(same, DiscriminationTask::kSameDifferent);
  expect(one, DiscriminationTask::kOneInterval);
}

TEST(DiscriminationTaskTest, ChanceIsNoSensitivity) {
  for (const auto& [task, chance] : {std::pair(DiscriminationTask::kOddity, 1.0 / 3.0),
                                     {DiscriminationTask::kAbx, 0.5},
                                     {DiscriminationTask::kSameDifferent, 0.5}}) {
    EXPECT_NEAR(task_share(task, 0.0, 3), chance, 1e-12);
    EXPECT_EQ(*task_d_prime(task, chance - 0.1, 3), 0.0);
    EXPECT_FALSE(task_d_prime(task, 1.0, 3));
  }
}

}  // namespace
}  // namespace haptrial::analysis
