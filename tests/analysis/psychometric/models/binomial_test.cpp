#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "analysis/psychometric/models/binomial_mixed.h"
#include "analysis/psychometric/models/binomial_model.h"
#include "analysis/statistics/base/solvers.h"
#include "core/base/random.h"
#include "tests/support/shared_data.h"

namespace haptrial::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

BinomialData levels() {
  BinomialData data{
      {1, 3, 6, 12, 17, 25, 28, 30}, {30, 30, 28, 31, 30, 32, 30, 30}, MatrixXd(8, 2)};
  for (int i = 0; i < 8; ++i) {
    data.predictors.row(i) << i + 1, i % 2;
  }
  return data;
}

void expect_coefficients(const BinomialModel& m, const std::vector<double>& estimates,
                         const std::vector<double>& errors, double tolerance) {
  ASSERT_EQ(m.coefficients.size(), estimates.size());
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    EXPECT_NEAR(m.coefficients[k].estimate, estimates[k], tolerance) << k;
    if (!errors.empty()) {
      EXPECT_NEAR(m.coefficients[k].error, errors[k], tolerance) << k;
    }
  }
}

// R 4.2.2: glm(cbind(y, n - y) ~ x + w, family = binomial(link)), epsilon 1e-15.
TEST(BinomialRegression, GivesTheAnswersOfR) {
  const auto probit = binomial_regression(levels(), BinomialLink::kProbit);
  ASSERT_TRUE(probit);
  expect_coefficients(*probit, {-2.516190806073, 0.559233677230, 0.037251908736},
                      {0.2988505877, 0.0586669512, 0.2068982213}, 1e-9);
  EXPECT_NEAR(probit->log_likelihood, -12.0851297512, 1e-9);
  EXPECT_NEAR(probit->deviance, 2.0893055613, 1e-9);
  const auto logit = binomial_regression(levels(), BinomialLink::kLogit);
  expect_coefficients(*logit, {-4.368535873309, 0.964635953650, 0.078418931720},
                      {0.5773443374, 0.1148634612, 0.3648946286}, 1e-9);
  EXPECT_NEAR(logit->log_likelihood, -12.4321593877, 1e-9);
  EXPECT_NEAR(logit->deviance, 2.7833648343, 1e-9);
}

// At a maximum the slope of the likelihood is 0.
TEST(BinomialRegression, SolvesTheScoreEquations) {
  RandomStream random(4, "binomial regression");
  for (const BinomialLink link : {BinomialLink::kProbit, BinomialLink::kLogit}) {
    for (int run = 0; run < 50; ++run) {
      BinomialData data{{}, {}, MatrixXd(20, 2)};
      for (int i = 0; i < 20; ++i) {
        data.predictors.row(i) << 1000.0 + random.normal(), 1e-3 * random.normal();
        data.trials.push_back(12);
        data.yes.push_back(static_cast<int>(random.below(13)));
      }
      const auto m = binomial_regression(data, link);
      ASSERT_TRUE(m);
      VectorXd beta(3);
      beta << m->coefficients[0].estimate, m->coefficients[1].estimate, m->coefficients[2].estimate;
      const MatrixXd columns = checked_columns(data);
      const BinomialRows rows = binomial_rows(data, link, columns * beta);
      const VectorXd score = columns.transpose() * rows.slope;
      for (int k = 0; k < 3; ++k) {
        EXPECT_LT(std::abs(score[k]),
                  1e-10 * columns.col(k).norm() * rows.slope.norm() + 1e-10 * columns.col(k).norm())
            << run;
      }
    }
  }
}

TEST(BinomialRegression, SaysWhyThereIsNone) {
  BinomialData apart{{0, 0, 10, 10}, {10, 10, 10, 10}, MatrixXd(4, 1)};
  apart.predictors << 1, 2, 3, 4;
  const auto none = binomial_regression(apart, BinomialLink::kProbit);
  ASSERT_FALSE(none);
  EXPECT_NE(none.because().find("separate"), std::string::npos) << none.because();
  BinomialData same = levels();
  same.predictors.col(1) = 2.0 * same.predictors.col(0).array() + 1.0;
  const auto tied = binomial_regression(same, BinomialLink::kLogit);
  ASSERT_FALSE(tied);
  EXPECT_NE(tied.because().find("follows"), std::string::npos) << tied.because();
  BinomialData wrong = levels();
  wrong.yes[0] = 31;
  EXPECT_THROW(binomial_regression(wrong, BinomialLink::kLogit), std::invalid_argument);
}

// The point of equality of a line is where its share is 1/2, and the JND leads to 3/4.
TEST(BinomialRegression, FindsThePointOfEquality) {
  BinomialData data = levels();
  data.predictors.conservativeResize(8, 1);
  for (const BinomialLink link : {BinomialLink::kProbit, BinomialLink::kLogit}) {
    const auto m = binomial_regression(data, link);
    const auto e = equality_point(*m, link, VectorXd::Unit(2, 0), VectorXd::Unit(2, 1));
    ASSERT_TRUE(e);
    const auto share = [&](double x) {
      const double eta = m->coefficients[0].estimate + m->coefficients[1].estimate * x;
      return link == BinomialLink::kProbit ? 0.5 * std::erfc(-eta / std::sqrt(2.0))
                                           : 1.0 / (1.0 + std::exp(-eta));
    };
    EXPECT_NEAR(share(e->point), 0.5, 1e-12);
    EXPECT_NEAR(share(e->point + e->jnd), 0.75, 1e-12);
    // The error is that of the intercept of the same model with its origin at the point.
    BinomialData moved = data;
    moved.predictors.array() -= e->point;
    const auto there = binomial_regression(moved, link);
    EXPECT_NEAR(e->point_error,
                there->coefficients[0].error / std::abs(there->coefficients[1].estimate), 1e-8);
  }
}

struct People {
  BinomialData data;
  std::vector<std::size_t> participants;
};

/// Twelve people, six levels of 20 trials.
People twelve() {
  const std::vector<int> yes{0, 0,  1,  5,  12, 17, 0, 2,  10, 18, 20, 20, 1, 4, 9, 14, 18, 19,
                             0, 0,  3,  11, 18, 20, 8, 13, 17, 19, 20, 20, 0, 0, 1, 8,  18, 20,
                             0, 3,  10, 17, 20, 20, 0, 2,  7,  13, 18, 20, 0, 0, 4, 13, 19, 20,
                             7, 11, 15, 17, 19, 20, 0, 0,  1,  4,  11, 18, 0, 3, 9, 16, 19, 20};
  People people{{yes, std::vector<int>(72, 20), MatrixXd(72, 1)}, {}};
  for (int i = 0; i < 72; ++i) {
    people.data.predictors(i, 0) = i % 6 + 1;
    people.participants.push_back(static_cast<std::size_t>(i / 6));
  }
  return people;
}

// R 4.2.2, lme4 1.1-31: glmer(cbind(yes, n - yes) ~ x + (1 + x | person), binomial("probit")),
// errors of vcov(use.hessian = FALSE). The modes of the random effects are those of tolPwrss =
// 1e-13, as with the default of 1e-7 the logarithm of the likelihood lacks 1.5e-4; bobyqa and
// Nelder_Mead began anew at each other's end three times. Its optimum is good to about 1e-6.
TEST(BinomialMixedModel, GivesTheAnswersOfLme4) {
  const People people = twelve();
  const std::vector<std::size_t> both{0, 1};
  const auto m =
      binomial_mixed_model(people.data, BinomialLink::kProbit, people.participants, both);
  ASSERT_TRUE(m) << m.because();
  expect_coefficients(m->fixed, {-3.470307906, 0.987548732}, {0.45040045, 0.08189602}, 1e-4);
  EXPECT_NEAR(m->fixed.log_likelihood, -105.74665973, 1e-6);
  EXPECT_GE(m->fixed.log_likelihood, -105.74665973 - 1e-8);
  EXPECT_NEAR(m->random_covariance(0, 0), 2.070148175, 1e-3);
  EXPECT_NEAR(m->random_covariance(0, 1), -0.297525582, 1e-3);
  EXPECT_NEAR(m->random_covariance(1, 1), 0.055308506, 1e-3);
  EXPECT_FALSE(m->at_boundary);
  EXPECT_EQ(m->parameters, 5);
}

// The same with (1 | person), binomial("logit").
TEST(BinomialMixedModel, GivesTheAnswersOfLme4ForIntercepts) {
  const People people = twelve();
  const std::vector<std::size_t> intercept{0};
  const auto m =
      binomial_mixed_model(people.data, BinomialLink::kLogit, people.participants, intercept);
  ASSERT_TRUE(m) << m.because();
  expect_coefficients(m->fixed, {-5.581637060, 1.640391464}, {0.53048501, 0.08399362}, 1e-4);
  EXPECT_NEAR(m->fixed.log_likelihood, -115.05479458, 1e-6);
  EXPECT_NEAR(m->random_covariance(0, 0), 2.30147702, 1e-3);
}

// Nine people, tactile speed with and without vibration: faster ~ speed * vibration +
// (1 + speed | subject), probit. lme4's answers.
TEST(BinomialMixedModel, GivesTheAnswersOfLme4ForSpeedAndVibration) {
  const auto file = test::shared_data("psychometric/vibro_exp3.csv");
  if (!file) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds psychometric/vibro_exp3.csv";
  }
  std::ifstream in(*file);
  std::string line;
  std::getline(in, line);
  BinomialData data;
  std::vector<std::size_t> participants;
  std::vector<double> speeds, vibrations;
  std::map<std::string, std::size_t> names;
  while (std::getline(in, line)) {
    std::vector<std::string> fields;
    std::istringstream row(line);
    for (std::string field; std::getline(row, field, ',');) {
      std::erase(field, '"');
      fields.push_back(field);
    }
    ASSERT_EQ(fields.size(), 5u) << line;
    speeds.push_back(std::stod(fields[0]));
    vibrations.push_back(std::stoi(fields[1]) > 0 ? 1.0 : 0.0);
    data.yes.push_back(std::stoi(fields[2]));
    data.trials.push_back(data.yes.back() + std::stoi(fields[3]));
    participants.push_back(names.try_emplace(fields[4], names.size()).first->second);
  }
  ASSERT_EQ(names.size(), 9u);
  data.predictors.resize(std::ssize(speeds), 3);
  for (Eigen::Index i = 0; i < std::ssize(speeds); ++i) {
    const auto k = static_cast<std::size_t>(i);
    data.predictors.row(i) << speeds[k], vibrations[k], speeds[k] * vibrations[k];
  }
  const std::vector<std::size_t> both{0, 1}, intercept{0};
  const auto m = binomial_mixed_model(data, BinomialLink::kProbit, participants, both);
  ASSERT_TRUE(m) << m.because();
  expect_coefficients(m->fixed, {-2.0173981, 0.2355326, 0.3809770, -0.0410865}, {}, 1e-4);
  EXPECT_NEAR(m->fixed.log_likelihood, -284.4187119, 1e-4);
  EXPECT_TRUE(m->at_boundary);  // lme4: correlation -1
  EXPECT_NEAR(m->random_covariance(0, 1) /
                  std::sqrt(m->random_covariance(0, 0) * m->random_covariance(1, 1)),
              -1.0, 1e-4);
  const auto logit = binomial_mixed_model(data, BinomialLink::kLogit, participants, both);
  ASSERT_TRUE(logit) << logit.because();
  expect_coefficients(logit->fixed, {-3.506826617, 0.410795499, 0.700130493, -0.077952274}, {},
                      1e-4);
  EXPECT_NEAR(logit->fixed.log_likelihood, -281.55109689, 1e-4);
  // logLik of (1 | subject): -302.3743143, its variance at 0.
  const auto smaller = binomial_mixed_model(data, BinomialLink::kProbit, participants, intercept);
  ASSERT_TRUE(smaller) << smaller.because();
  EXPECT_NEAR(smaller->fixed.log_likelihood, -302.3743143, 1e-4);
  // x * c + (x * c | subject) of the standardised speed x and c = vibration - 1/2, where each
  // person's slope changes in a way of its own: a singular fit in lme4, too.
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    sum += data.trials[i] * speeds[i];
    squares += data.trials[i] * speeds[i] * speeds[i];
    count += data.trials[i];
  }
  const double mean = sum / count, deviation = std::sqrt(squares / count - mean * mean);
  for (Eigen::Index i = 0; i < std::ssize(speeds); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double x = (speeds[k] - mean) / deviation, c = vibrations[k] - 0.5;
    data.predictors.row(i) << x, c, x * c;
  }
  const std::vector<std::size_t> all{0, 1, 2, 3};
  const auto full = binomial_mixed_model(data, BinomialLink::kProbit, participants, all);
  ASSERT_TRUE(full) << full.because();
  expect_coefficients(full->fixed, {0.000222, 1.075369, 0.033186, -0.199356}, {}, 1e-3);
  EXPECT_NEAR(full->fixed.log_likelihood, -284.180321, 1e-3);
  // lme4's error is that of the Hessian over variances, too.
  EXPECT_NEAR(full->fixed.coefficients[3].error / 0.0554677, 1.0, 0.05);
}

// Two conditions that do not differ, people who differ in intercept and slope: the model with both
// random finds a difference about as often as it may, regression of all trials far more often.
TEST(BinomialMixedModel, KeepsItsLevelWherePooledTrialsDoNot) {
  RandomStream random(11, "binomial mixed");
  constexpr int kRuns = 100;
  int mixed = 0, pooled = 0;
  for (int run = 0; run < kRuns; ++run) {
    // The group of a participant is the condition.
    BinomialData data{{}, {}, MatrixXd(12 * 5, 2)};
    std::vector<std::size_t> participants;
    for (int person = 0; person < 12; ++person) {
      const double a = 0.8 * random.normal(), b = 1.0 + 0.2 * random.normal();
      for (int i = 0; i < 5; ++i) {
        const double x = i - 2.0;
        data.predictors.row(5 * person + i) << x, person % 2;
        int yes = 0;
        for (int t = 0; t < 20; ++t) {
          yes += random.uniform() < 0.5 * std::erfc(-(a + b * x) / std::sqrt(2.0)) ? 1 : 0;
        }
        data.yes.push_back(yes);
        data.trials.push_back(20);
        participants.push_back(static_cast<std::size_t>(person));
      }
    }
    const std::vector<std::size_t> both{0, 1};
    const auto m = binomial_mixed_model(data, BinomialLink::kProbit, participants, both);
    ASSERT_TRUE(m) << run << ": " << m.because();
    mixed += m->fixed.coefficients[2].p < 0.05 ? 1 : 0;
    const auto all = binomial_regression(data, BinomialLink::kProbit);
    pooled += all->coefficients[2].p < 0.05 ? 1 : 0;
  }
  // A normal test, with a variance of maximum likelihood that lacks the factor 12/10, of what has
  // Student's distribution with ten degrees of freedom: 10 %; binomial bound of 99 %.
  EXPECT_LE(mixed, 18);
  EXPECT_GE(pooled, 40);
  RecordProperty("mixed", mixed);
  RecordProperty("pooled", pooled);
}

}  // namespace
}  // namespace haptrial::analysis
