#include "analysis/statistics/relation/cross_validated.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::HasSubstr;

struct Data {
  std::vector<double> y;
  MatrixXd x;
  std::vector<std::size_t> who;
};

// Two rows each of `people`; y = slopes' x + noise.
Data made(std::string_view name, std::size_t people, Eigen::Index predictors,
          const VectorXd& slopes, double noise) {
  RandomStream random(5, name);
  Data data;
  data.x = MatrixXd(static_cast<Eigen::Index>(2 * people), predictors);
  for (Eigen::Index i = 0; i < data.x.rows(); ++i) {
    for (Eigen::Index j = 0; j < predictors; ++j) {
      data.x(i, j) = random.normal();
    }
    data.y.push_back(data.x.row(i).head(slopes.size()).dot(slopes) + noise * random.normal());
    data.who.push_back(static_cast<std::size_t>(i) / 2);
  }
  return data;
}

TEST(CrossValidated, RecoversALinearLaw) {
  const VectorXd law = VectorXd::Map(std::vector<double>{2.0, -1.0, 0.5}.data(), 3);
  const Data data = made("law", 40, 3, law, 0.05);
  const auto c = cross_validated_ridge(data.y, data.x, data.who);
  ASSERT_TRUE(c);
  for (Eigen::Index j = 0; j < 3; ++j) {
    EXPECT_NEAR(c->fit.slopes[j] / c->fit.scale[j], law[j], 0.05);
  }
  EXPECT_GT(*c->validated.r, 0.995);
  EXPECT_GT(c->gain, 0.99);
  EXPECT_NEAR(c->validated.rmse, 0.05, 0.03);
  EXPECT_EQ(c->lambda, ridge_penalties().front());
}

// A participant's prediction must not change whatever that participant's own values are; those of
// the others must.
TEST(CrossValidated, APoisonedParticipantDoesNotReachTheirOwnFit) {
  const VectorXd law = VectorXd::Constant(2, 1.0);
  const Data clean = made("poison", 12, 4, law, 0.5);
  Data poisoned = clean;
  constexpr std::size_t kPerson = 7;
  poisoned.y[2 * kPerson] = 900.0;
  poisoned.y[2 * kPerson + 1] = -4000.0;
  const auto a = cross_validated_ridge(clean.y, clean.x, clean.who);
  const auto b = cross_validated_ridge(poisoned.y, poisoned.x, poisoned.who);
  for (Eigen::Index i = 0; i < a->predicted.size(); ++i) {
    if (clean.who[static_cast<std::size_t>(i)] == kPerson) {
      EXPECT_EQ(a->predicted[i], b->predicted[i]);
    } else {
      EXPECT_NE(a->predicted[i], b->predicted[i]);
    }
  }
  EXPECT_EQ(a->lambdas[kPerson], b->lambdas[kPerson]);
  EXPECT_NE(a->resubstituted[2 * kPerson], b->resubstituted[2 * kPerson]);
}

// Nor do the predictors of the one left out shift the standardising: their own rows see a changed
// row only through the law that the others gave.
TEST(CrossValidated, StandardisingSeesNothingOfTheOneLeftOut) {
  const Data clean = made("standard", 10, 3, VectorXd::Constant(3, 1.0), 0.3);
  Data shifted = clean;
  shifted.x(0, 1) += 1e4;  // participant 0; row 1 is the same participant's other
  const auto a = cross_validated_ridge(clean.y, clean.x, clean.who);
  const auto b = cross_validated_ridge(shifted.y, shifted.x, shifted.who);
  EXPECT_EQ(a->predicted[1], b->predicted[1]);
  EXPECT_GT(std::abs(b->predicted[0] - a->predicted[0]), 100.0);
}

// Ten predictors that say nothing about 15 participants: the fit to all looks good, what is
// predicted for others does not.
TEST(CrossValidated, NothingIsFoundInNoise) {
  double gain = 0.0, resubstituted = 0.0, promising = 0.0;
  constexpr int kRuns = 60;
  for (int run = 0; run < kRuns; ++run) {
    const Data data = made("null " + std::to_string(run), 15, 10, VectorXd::Zero(10), 1.0);
    const auto c = cross_validated_ridge(data.y, data.x, data.who);
    ASSERT_TRUE(c);
    gain += c->gain / kRuns;
    resubstituted += *c->resubstitution.r / kRuns;
    promising += c->gain > 0.2 ? 1.0 / kRuns : 0.0;
  }
  EXPECT_LT(gain, 0.02);
  EXPECT_GT(gain, -0.3);
  EXPECT_GT(resubstituted, 0.3);
  EXPECT_LT(promising, 0.1);
}

// As lambda goes to 0 ridge becomes least squares; as it grows the slopes vanish.
TEST(Ridge, LiesBetweenLeastSquaresAndTheMean) {
  const Data data = made("limits", 20, 3, VectorXd::Constant(3, 2.0), 1.0);
  const VectorXd y = VectorXd::Map(data.y.data(), static_cast<Eigen::Index>(data.y.size()));
  MatrixXd design(data.x.rows(), 4);
  design << VectorXd::Ones(data.x.rows()), data.x;
  const VectorXd least = design.colPivHouseholderQr().solve(y);
  const RidgeFit close = ridge_regression(y, data.x, 1e-12);
  EXPECT_LT((close.predict(data.x) - design * least).norm(), 1e-8);
  const RidgeFit far = ridge_regression(y, data.x, 1e12);
  EXPECT_LT((far.predict(data.x).array() - y.mean()).matrix().norm(), 1e-8);
}

TEST(Ridge, APredictorThatDoesNotVaryHasNoSay) {
  const Data data = made("constant", 10, 2, VectorXd::Constant(1, 1.0), 0.1);
  MatrixXd wider(data.x.rows(), 3);
  wider << data.x, VectorXd::Constant(data.x.rows(), 0.1);
  const VectorXd y = VectorXd::Map(data.y.data(), static_cast<Eigen::Index>(data.y.size()));
  const RidgeFit a = ridge_regression(y, data.x, 0.1), b = ridge_regression(y, wider, 0.1);
  wider.col(2).setConstant(77.0);
  EXPECT_LT((a.predict(data.x) - b.predict(wider)).norm(), 1e-12);
  EXPECT_THROW(ridge_regression(y, data.x, 0.0), std::invalid_argument);
  EXPECT_THROW(ridge_regression(y.head(3), data.x, 1.0), std::invalid_argument);
}

TEST(CrossValidated, SaysWhyThereIsNone) {
  Data data = made("why", 6, 2, VectorXd::Constant(1, 1.0), 0.1);
  const std::vector<std::size_t> three{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2};
  EXPECT_THAT(cross_validated_ridge(data.y, data.x, three).because(), HasSubstr("four"));
  EXPECT_THAT(cross_validated_ridge(data.y, MatrixXd(12, 0), data.who).because(),
              HasSubstr("nothing to predict from"));
  const std::vector<double> equal(12, 3.0);
  EXPECT_THAT(cross_validated_ridge(equal, data.x, data.who).because(), HasSubstr("not vary"));
  data.x(3, 1) = std::numeric_limits<double>::infinity();
  EXPECT_THAT(cross_validated_ridge(data.y, data.x, data.who).because(), HasSubstr("finite"));
  EXPECT_THROW(cross_validated_ridge(equal, MatrixXd(3, 1), data.who), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis
