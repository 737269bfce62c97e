// Mixed models with several random intercepts, crossed and nested; beside lmerTest:
// mixed_terms_reference.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "analysis/statistics/relation/mixed_contrast.h"
#include "analysis/statistics/relation/mixed_model.h"
#include "analysis/statistics/relation/regression.h"
#include "analysis/statistics/relation/restricted_likelihood.h"
#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Values = std::vector<double>;

// Groups of unequal size, crossed and nested, some cells empty.
struct Crossed {
  Values response;
  MatrixXd predictors;
  std::vector<std::vector<std::size_t>> terms;
};

/// @param deviations  of the intercepts of each term; the residual has 1.
Crossed crossed(RandomStream& random, const std::vector<double>& deviations) {
  const std::vector<std::size_t> sizes{3, 9, 1, 6, 7, 4, 8};
  Crossed made{{}, MatrixXd(38, 2), std::vector<std::vector<std::size_t>>(3)};
  std::map<std::size_t, double> levels[3];
  Eigen::Index row = 0;
  for (std::size_t subject = 0; subject < sizes.size(); ++subject) {
    for (std::size_t i = 0; i < sizes[subject]; ++i, ++row) {
      made.predictors.row(row) << static_cast<double>(i % 2), random.normal();
      double value = 0.7 * made.predictors(row, 0) - made.predictors(row, 1) + random.normal();
      const std::size_t groups[3]{subject, i * i % 5, 100 * subject + i / 3};
      for (std::size_t k = 0; k < 3; ++k) {
        made.terms[k].push_back(groups[k]);
        value += levels[k].try_emplace(groups[k], deviations[k] * random.normal()).first->second;
      }
      made.response.push_back(value);
    }
  }
  return made;
}

RestrictedLikelihood likelihood_of(const Crossed& made) {
  std::vector<Grouping> terms;
  for (const auto& term : made.terms) {
    terms.push_back(grouping_of(term));
  }
  return {made.predictors, VectorXd::Map(made.response.data(), std::ssize(made.response)), terms};
}

TEST(RestrictedLikelihood, SlopeAndHessianAreThoseOfTheCriterion) {
  RandomStream random(4, "slope");
  const Crossed made = crossed(random, {1.0, 0.5, 0.7});
  const RestrictedLikelihood likelihood = likelihood_of(made);
  for (const double size : {0.01, 0.5, 3.0, 40.0}) {
    const VectorXd rho = size * Eigen::Vector3d(1.0, 0.3, 2.0);
    const auto here = likelihood.at(rho);
    EXPECT_NEAR(here.criterion, likelihood.value(rho).criterion, 1e-12);
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double h = 1e-4 * rho[k];
      const auto up = likelihood.at(rho + h * VectorXd::Unit(3, k));
      const auto down = likelihood.at(rho - h * VectorXd::Unit(3, k));
      const double slope = (up.criterion - down.criterion) / (2.0 * h);
      EXPECT_NEAR(here.slope[k], slope, 1e-6 * (1.0 + std::abs(slope)));
      const VectorXd column = (up.slope - down.slope) / (2.0 * h);
      EXPECT_LT((here.hessian.col(k) - column).norm(), 1e-6 * (1.0 + column.norm()));
    }
  }
}

// Several lowest places, flat ones and ones at 0 are among these.
TEST(MixedTerms, NoOtherVariancesAreLikelier) {
  RandomStream random(6, "search");
  const std::vector<double> sizes{0.0, 0.1, 0.5, 2.0, 20.0};
  int at_boundary = 0;
  for (int study = 0; study < 300; ++study) {
    const auto size = [&] { return sizes[random.below(sizes.size())]; };
    const Crossed made = crossed(random, {size(), size(), size()});
    const auto m = mixed_model(made.response, made.predictors, made.terms);
    ASSERT_TRUE(m) << study << ": " << m.because();
    at_boundary += m->at_boundary ? 1 : 0;
    const RestrictedLikelihood likelihood = likelihood_of(made);
    const Eigen::Vector3d found(m->variances[0], m->variances[1], m->variances[2]);
    const auto best = likelihood.at(found / m->variance_within);
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double scale = std::max(best.rho[k], 1e-3);
      if (best.rho[k] > 0.0) {
        EXPECT_NEAR(best.slope[k] * scale, 0.0, 1e-9) << study;
      } else {
        EXPECT_GE(best.slope[k], 0.0) << study;
      }
    }
    for (int other = 0; other < 50; ++other) {
      Eigen::Vector3d rho;
      for (double& each : rho) {
        each = random.below(4) == 0 ? 0.0 : std::pow(10.0, random.uniform(-3.0, 4.0));
      }
      ASSERT_GE(likelihood.value(rho).criterion, best.criterion - 1e-9) << study;
    }
  }
  EXPECT_GT(at_boundary, 30);
  EXPECT_LT(at_boundary, 270);
}

// A term at 0 is as if it were not there: so does lmerTest.
TEST(MixedTerms, AtTheBoundaryIsTheModelWithoutTheTerm) {
  RandomStream random(7, "boundary");
  int found = 0;
  for (int study = 0; study < 50; ++study) {
    const Crossed made = crossed(random, {1.0, 0.0, 0.5});
    const auto whole = mixed_model(made.response, made.predictors, made.terms);
    ASSERT_TRUE(whole) << whole.because();
    if (whole->variances[1] > 0.0 || whole->variances[0] == 0.0 || whole->variances[2] == 0.0) {
      continue;
    }
    ++found;
    const auto less = mixed_model(made.response, made.predictors, {made.terms[0], made.terms[2]});
    ASSERT_TRUE(less) << less.because();
    EXPECT_TRUE(whole->at_boundary);
    EXPECT_FALSE(less->at_boundary);
    EXPECT_NEAR(whole->log_likelihood, less->log_likelihood, 1e-10);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(whole->coefficients[k].error / less->coefficients[k].error, 1.0, 1e-9);
      EXPECT_NEAR(whole->coefficients[k].df / less->coefficients[k].df, 1.0, 1e-8);
    }
  }
  EXPECT_GT(found, 10);
}

TEST(MixedTerms, WithoutTermsIsTheRegression) {
  RandomStream random(8, "regression");
  const Crossed data = crossed(random, {0.0, 0.0, 0.0});
  const auto m = mixed_model(data.response, data.predictors, {});
  const auto plain = linear_regression(data.predictors, data.response);
  ASSERT_TRUE(m && plain);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(m->coefficients[k].estimate, plain->coefficients[k].estimate, 1e-13);
    EXPECT_NEAR(m->coefficients[k].df, plain->coefficients[k].df, 1e-11);
    EXPECT_NEAR(m->coefficients[k].p, plain->coefficients[k].p, 1e-13);
  }
  const auto test = joint_test(*m, MatrixXd::Identity(3, 3).bottomRows(2));
  EXPECT_NEAR(test->f / plain->f, 1.0, 1e-12);
  EXPECT_NEAR(test->p, plain->p, 1e-13);
}

TEST(MixedTerms, SaysWhichTermsCannotBeToldApart) {
  RandomStream random(9, "terms");
  const Crossed made = crossed(random, {1.0, 0.5, 0.7});
  auto terms = made.terms;
  const auto reason = [&] { return mixed_model(made.response, made.predictors, terms).because(); };
  for (auto& group : terms[1]) {
    group = 0;
  }
  EXPECT_EQ(reason(), "random term 2: there is only one group");
  for (std::size_t i = 0; i < terms[1].size(); ++i) {
    terms[1][i] = i;
  }
  EXPECT_EQ(reason(), "random term 2: every group has a single value");
  for (std::size_t i = 0; i < terms[1].size(); ++i) {
    terms[1][i] = 99 - terms[0][i];
  }
  EXPECT_EQ(reason(), "two random terms group the observations alike");
  // Two groups that are the two levels of the first predictor.
  for (std::size_t i = 0; i < terms[1].size(); ++i) {
    terms[1][i] = made.predictors(static_cast<Eigen::Index>(i), 0) > 0.5 ? 1 : 0;
  }
  EXPECT_EQ(reason(), "random term 2: groups and predictors go together");
  terms[1].pop_back();
  EXPECT_THROW(reason(), std::invalid_argument);
}

TEST(MixedContrast, OfOneRowTheJointTestIsTheSquareOfT) {
  RandomStream random(10, "contrast");
  const Crossed made = crossed(random, {1.0, 0.5, 0.7});
  const auto m = mixed_model(made.response, made.predictors, made.terms);
  ASSERT_TRUE(m);
  const Eigen::Vector3d weights(0.0, 2.0, -1.0);
  const auto one = contrast(*m, weights);
  const auto joint = joint_test(*m, weights.transpose());
  ASSERT_TRUE(one && joint);
  EXPECT_NEAR(joint->f, one->t * one->t, 1e-12 * joint->f);
  EXPECT_NEAR(joint->df_denominator, one->df, 1e-11 * one->df);
  EXPECT_NEAR(joint->p, one->p, 1e-12);
  MatrixXd twice(2, 3);  // a row that says nothing new is no further degree of freedom
  twice << weights.transpose(), -3.0 * weights.transpose();
  const auto same = joint_test(*m, twice);
  EXPECT_EQ(same->df_numerator, 1.0);
  EXPECT_NEAR(same->p, one->p, 1e-12);
  EXPECT_FALSE(contrast(*m, VectorXd::Zero(3)));
  EXPECT_FALSE(joint_test(*m, MatrixXd::Zero(2, 3)));
  EXPECT_THROW(contrast(*m, VectorXd::Zero(2)), std::invalid_argument);
  EXPECT_THROW(joint_test(*m, MatrixXd::Zero(2, 4)), std::invalid_argument);
}

// lme4's y ~ c + (1 | s) + (0 + c | s) with c = -1/2 and 1/2, by lmerTest 3.1-3.
TEST(MixedTerms, ATermOfParticipantAndConditionIsARandomSlope) {
  const Values y{0.69, 0.82, 1.49, 1.08, 0.52, 0.37, 2.58, 2,    1.91, 1.81, 2.88,
                 2.82, 0.82, 0.4,  1.21, 1.19, 2.32, 2.33, 2.22, 2.64, 2,    1.49,
                 2.19, 2.9,  1.89, 1.45, 3.28, 2.28, 2.93, 1.88, 3.38, 3.9};
  MatrixXd condition(32, 1);
  std::vector<std::vector<std::size_t>> terms(2);
  for (std::size_t i = 0; i < y.size(); ++i) {
    condition(static_cast<Eigen::Index>(i), 0) = i / 2 % 2 == 0 ? -0.5 : 0.5;
    terms[0].push_back(i / 4);
    terms[1].push_back(i / 2);
  }
  const auto model = mixed_model(y, condition, terms);
  ASSERT_TRUE(model) << model.because();
  EXPECT_NEAR(model->coefficients[1].estimate, 0.900625, 1e-9);
  EXPECT_NEAR(model->coefficients[1].error, 0.185764246, 1e-6);
  EXPECT_NEAR(model->coefficients[1].df, 7.0, 1e-3);
  EXPECT_NEAR(model->coefficients[1].p, 0.0018601, 1e-6);
  EXPECT_NEAR(2.0 * model->variances[1], 0.143519789, 1e-5);  // variance of the slopes
  EXPECT_NEAR(model->variances[0] + 0.5 * model->variances[1], 0.524399189, 1e-4);
}

}  // namespace
}  // namespace haptrial::analysis
