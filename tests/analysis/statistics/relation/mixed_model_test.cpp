#include "analysis/statistics/relation/mixed_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "analysis/statistics/relation/regression.h"
#include "analysis/statistics/relation/restricted_likelihood.h"
#include "analysis/statistics/tests/t_tests.h"
#include "analysis/statistics/variance/anova.h"
#include "core/base/random.h"

namespace haptrial::analysis::mixed_model_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::HasSubstr;
using Values = std::vector<double>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Data {
  Values response;
  MatrixXd predictors;
  std::vector<std::size_t> groups;
};

// Groups of different size, two predictors, values that are multiples of 1/64.
Data unbalanced(RandomStream& random, double between) {
  Data data;
  const std::vector<std::size_t> sizes{3, 9, 1, 6, 7, 4, 8};
  std::vector<double> x;
  for (std::size_t g = 0; g < sizes.size(); ++g) {
    const double level = between * random.normal();
    for (std::size_t i = 0; i < sizes[g]; ++i) {
      x.push_back(static_cast<double>(i % 2));
      x.push_back(std::round(64.0 * random.normal()) / 64.0);
      const double value = level + 0.7 * x[x.size() - 2] - x.back() + random.normal();
      data.response.push_back(std::round(64.0 * value) / 64.0);
      data.groups.push_back(g);
    }
  }
  data.predictors = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>(
      x.data(), std::ssize(data.response), 2);
  return data;
}

Defined<MixedModel> fit(const Data& data) {
  return random_intercept_model(data.response, data.predictors, data.groups);
}

TEST(MixedModel, OfABalancedLayoutIsItsAnalysisOfVariance) {
  // REML then has a closed form: within = MSW, between = (MSB - MSW) / n.
  const std::vector<Values> groups{{6, 8, 4, 5}, {8, 12, 9, 11}, {13, 9, 11, 8}, {1, 3, 2, 5}};
  Values response;
  std::vector<std::size_t> names;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const double value : groups[g]) {
      response.push_back(value);
      names.push_back(100 - g);
    }
  }
  const auto a = one_way_anova(groups);
  const double within = a->squares_within / a->df_within;
  const double between = a->squares_between / a->df_between;
  const auto m = random_intercept_model(response, MatrixXd(16, 0), names);
  ASSERT_TRUE(m) << m.because();
  EXPECT_NEAR(m->variance_within, within, 1e-12 * within);
  EXPECT_NEAR(m->variances.front(), (between - within) / 4.0, 1e-11);
  EXPECT_NEAR(m->coefficients[0].estimate, 115.0 / 16.0, 1e-14);
  EXPECT_NEAR(m->coefficients[0].error, std::sqrt(between / 16.0), 1e-13);
  EXPECT_NEAR(m->coefficients[0].df, 3.0, 1e-10);
  EXPECT_EQ(m->groups, std::vector<std::size_t>{4});
}

TEST(MixedModel, OfPairsIsThePairedT) {
  const Values a{5.1, 7.2, 6.3, 9.9, 8.0}, b{4.0, 6.9, 5.2, 9.1, 6.5};
  Values response = a;
  response.insert(response.end(), b.begin(), b.end());
  MatrixXd condition(10, 1);
  condition << VectorXd::Ones(5), VectorXd::Zero(5);
  const auto m = random_intercept_model(response, condition,
                                        std::vector<std::size_t>{0, 1, 2, 3, 4,  //
                                                                 0, 1, 2, 3, 4});
  const auto t = paired_t_test(a, b, Tail::kTwoSided);
  ASSERT_TRUE(m && t);
  EXPECT_NEAR(m->coefficients[1].estimate, t->difference, 1e-14);
  EXPECT_NEAR(m->coefficients[1].t, t->t, 1e-10);
  EXPECT_NEAR(m->coefficients[1].df, t->df, 1e-9);
  EXPECT_NEAR(m->coefficients[1].p, t->p, 1e-11);
}

TEST(MixedModel, WithoutDifferencesBetweenGroupsIsTheRegression) {
  // Groups that differ less than chance would make them: between is 0.
  const Values response{1, 9, 2, 8, 1.5, 8.5, 9.5, 0.75};
  MatrixXd x(8, 1);
  x << 1, 2, 3, 4, 5, 6, 7, 9;
  const auto m =
      random_intercept_model(response, x, std::vector<std::size_t>{0, 0, 1, 1, 2, 2, 3, 3});
  const auto plain = linear_regression(x, response);
  ASSERT_TRUE(m && plain);
  EXPECT_TRUE(m->at_boundary);
  EXPECT_EQ(m->variances.front(), 0.0);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(m->coefficients[k].estimate, plain->coefficients[k].estimate, 1e-13);
    EXPECT_NEAR(m->coefficients[k].p, plain->coefficients[k].p, 1e-13);
  }
}

// The likelihood from the full covariance matrix, in two dimensions and without any profiling.
double full_likelihood(const Data& data, double between, double within) {
  const Eigen::Index n = std::ssize(data.response);
  MatrixXd v = within * MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const bool same =
          data.groups[static_cast<std::size_t>(i)] == data.groups[static_cast<std::size_t>(j)];
      v(i, j) += same ? between : 0.0;
    }
  }
  MatrixXd x(n, 3);
  x << VectorXd::Ones(n), data.predictors;
  const VectorXd y = VectorXd::Map(data.response.data(), n);
  const MatrixXd inverse = v.inverse();
  const MatrixXd a = x.transpose() * inverse * x;
  const VectorXd r = y - x * a.inverse() * x.transpose() * inverse * y;
  const double df = static_cast<double>(n - 3);
  return -0.5 * (df * std::log(2.0 * M_PI) + std::log(v.determinant()) + std::log(a.determinant()) +
                 r.dot(inverse * r));
}

TEST(MixedModel, IsTheMaximumOfTheFullLikelihood) {
  RandomStream random(1, "full likelihood");
  const Data data = unbalanced(random, 1.5);
  const auto m = fit(data);
  ASSERT_TRUE(m) << m.because();
  ASSERT_FALSE(m->at_boundary);
  const double best = full_likelihood(data, m->variances.front(), m->variance_within);
  EXPECT_NEAR(m->log_likelihood, best, 1e-11);
  for (const double step : {-0.01, 0.01}) {
    EXPECT_LT(full_likelihood(data, m->variances.front() * (1.0 + step), m->variance_within), best);
    EXPECT_LT(full_likelihood(data, m->variances.front(), m->variance_within * (1.0 + step)), best);
  }
}

TEST(MixedModel, DegreesOfFreedomFollowFromTheCurvatureOfTheLikelihood) {
  // Satterthwaite's with derivatives by differences, of the likelihood in (between, within).
  RandomStream random(2, "curvature");
  const Data data = unbalanced(random, 1.0);
  const auto m = fit(data);
  const double b = m->variances.front(), w = m->variance_within;
  const double hb = 2e-3 * b, hw = 2e-3 * w;
  const auto at = [&](double i, double j) { return full_likelihood(data, b + i * hb, w + j * hw); };
  Eigen::Matrix2d information;
  information(0, 0) = -(at(1, 0) - 2.0 * at(0, 0) + at(-1, 0)) / (hb * hb);
  information(1, 1) = -(at(0, 1) - 2.0 * at(0, 0) + at(0, -1)) / (hw * hw);
  information(0, 1) = information(1, 0) =
      -(at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4.0 * hb * hw);
  const Eigen::Index n = std::ssize(data.response);
  const auto variances = [&](double between, double within) -> VectorXd {
    MatrixXd v = within * MatrixXd::Identity(n, n);
    MatrixXd x(n, 3);
    x << VectorXd::Ones(n), data.predictors;
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        v(i, j) +=
            data.groups[static_cast<std::size_t>(i)] == data.groups[static_cast<std::size_t>(j)]
                ? between
                : 0.0;
      }
    }
    return MatrixXd((x.transpose() * v.inverse() * x).inverse()).diagonal();
  };
  const VectorXd by_between = (variances(b + hb, w) - variances(b - hb, w)) / (2.0 * hb);
  const VectorXd by_within = (variances(b, w + hw) - variances(b, w - hw)) / (2.0 * hw);
  const VectorXd found = variances(b, w);
  const Eigen::Matrix2d spread = information.inverse();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Eigen::Vector2d gradient(by_between[k], by_within[k]);
    const double df = 2.0 * found[k] * found[k] / gradient.dot(spread * gradient);
    EXPECT_NEAR(m->coefficients[static_cast<std::size_t>(k)].df / df, 1.0, 1e-4);
  }
}

TEST(MixedModel, DoesNotMindOffsetNamesOrOrder) {
  RandomStream random(3, "offset");
  Data data = unbalanced(random, 2.0);
  const auto plain = fit(data);
  for (auto& value : data.response) {
    value += 1e12;
  }
  data.predictors.col(1).array() += 1e12;
  for (auto& group : data.groups) {
    group = 1000 - 7 * group;
  }
  std::reverse(data.response.begin(), data.response.end());
  std::reverse(data.groups.begin(), data.groups.end());
  data.predictors = data.predictors.colwise().reverse().eval();
  const auto moved = fit(data);
  ASSERT_TRUE(moved) << moved.because();
  for (const std::size_t k : {1u, 2u}) {
    EXPECT_NEAR(moved->coefficients[k].estimate, plain->coefficients[k].estimate, 1e-11);
    EXPECT_NEAR(moved->coefficients[k].df, plain->coefficients[k].df, 1e-8);
    EXPECT_NEAR(moved->coefficients[k].p, plain->coefficients[k].p, 1e-11);
  }
  EXPECT_NEAR(moved->variances.front(), plain->variances.front(), 1e-10);
  EXPECT_NEAR(moved->log_likelihood, plain->log_likelihood, 1e-10);
}

TEST(MixedModel, FindsTheVariancesThatMadeTheData) {
  RandomStream random(2006, "recovery");
  double between = 0.0, within = 0.0;
  constexpr int kStudies = 200;
  for (int i = 0; i < kStudies; ++i) {
    const auto m = fit(unbalanced(random, 2.0));
    between += m->variances.front() / kStudies;
    within += m->variance_within / kStudies;
  }
  EXPECT_NEAR(between, 4.0, 4.0 * 4.0 * std::sqrt(2.0 / 6.0 / kStudies));  // four standard errors
  EXPECT_NEAR(within, 1.0, 4.0 * std::sqrt(2.0 / 30.0 / kStudies));
}

TEST(MixedModel, SaysWhyItIsNotDefined) {
  RandomStream random(5, "bad");
  const Data good = unbalanced(random, 1.0);
  Data bad = good;
  bad.response[3] = kNan;
  EXPECT_THAT(fit(bad).because(), HasSubstr("finite"));
  bad = good;
  bad.predictors(2, 1) = kNan;
  EXPECT_THAT(fit(bad).because(), HasSubstr("finite"));
  bad = good;
  bad.predictors.col(0).setConstant(3.0);
  EXPECT_THAT(fit(bad).because(), HasSubstr("predictor 1 does not vary"));
  bad = good;
  bad.predictors.col(0) = 2.0 * bad.predictors.col(1).array() + 1.0;
  EXPECT_THAT(fit(bad).because(), HasSubstr("linear combination"));
  bad = good;
  bad.groups.assign(bad.groups.size(), 4);
  EXPECT_THAT(fit(bad).because(), HasSubstr("only one group"));
  for (std::size_t i = 0; i < bad.groups.size(); ++i) {
    bad.groups[i] = i;
  }
  EXPECT_THAT(fit(bad).because(), HasSubstr("single value"));
  bad = good;
  for (std::size_t i = 0; i < bad.response.size(); ++i) {
    bad.response[i] = 0.1 * static_cast<double>(bad.groups[i]);
  }
  EXPECT_THAT(fit(bad).because(), HasSubstr("nothing varies"));
  EXPECT_THAT(random_intercept_model(Values{}, MatrixXd(0, 0), {}).because(),
              HasSubstr("no values"));
  EXPECT_THAT(random_intercept_model(Values{1, 2, 4}, MatrixXd::Random(3, 2),
                                     std::vector<std::size_t>{0, 0, 1})
                  .because(),
              HasSubstr("coefficients"));
  bad.response.pop_back();
  EXPECT_THROW(fit(bad), std::invalid_argument);
}

// One predictor is the same for all of a group, and one degree of freedom is left within groups.
TEST(MixedModelTest, FiveValuesInThreeGroupsSuffice) {
  const Values response{1.25, 0.5, 2.0, 3.5, 0.75};
  MatrixXd predictors(5, 2);
  predictors << 0, 1.5, 0, -0.25, 1, 0.5, 1, 2.0, 0, -1.0;
  const auto model =
      random_intercept_model(response, predictors, std::vector<std::size_t>{0, 0, 1, 1, 2});
  EXPECT_TRUE(model) << model.because();
}

// Each participant under one condition only: whose is the difference?
TEST(MixedModelTest, ConditionsThatGoWithGroupsAreUndefined) {
  RandomStream random(11, "nested");
  for (int i = 0; i < 500; ++i) {
    Values response;
    MatrixXd predictors(6, 1);
    for (int row = 0; row < 6; ++row) {
      predictors(row, 0) = row < 3 ? 0.0 : 1.0;
      response.push_back(1.5 + 0.3 * random.normal() + (row < 3 ? 0.0 : random.normal()));
    }
    const std::vector<std::size_t> groups{0, 0, 0, 1, 1, 1};
    const auto model = random_intercept_model(response, predictors, groups);
    ASSERT_FALSE(model) << i;
    ASSERT_EQ(model.because(), "groups and predictors go together") << i;
  }
}

}  // namespace
}  // namespace haptrial::analysis::mixed_model_test
