#include "analysis/psychometric/models/paired_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Citations between four journals of statistics (Agresti 2002, Categorical Data Analysis, §10.6),
/// fitted by R's glm() with either link.
TEST(PairedComparisonTest, AgreesWithR) {
  MatrixXd wins(4, 4);
  wins << 0, 730, 498, 221, 33, 0, 68, 17, 320, 813, 0, 142, 284, 276, 325, 0;
  const auto logit = worths(wins, PairedModel::kBradleyTerry, 0.0);
  const auto probit = worths(wins, PairedModel::kThurstone, 0.0);
  ASSERT_TRUE(logit && probit);
  EXPECT_TRUE(logit->isApprox(
      Eigen::Vector4d(0.7899220527, -2.1591504441, 0.3103522829, 1.0588761085), 1e-9));
  EXPECT_TRUE(probit->isApprox(
      Eigen::Vector4d(0.4513724684, -1.2233212089, 0.1614592046, 0.6104895358), 1e-9));
}

TEST(PairedComparisonTest, TwoItemsHaveTheOddsOfTheirChoices) {
  MatrixXd wins = MatrixXd::Zero(2, 2);
  wins(0, 1) = 30.0;
  wins(1, 0) = 10.0;
  const auto found = worths(wins, PairedModel::kBradleyTerry, 0.0);
  EXPECT_NEAR((*found)[0] - (*found)[1], std::log(3.0), 1e-10);
  const auto added = worths(wins, PairedModel::kBradleyTerry, 0.5);
  EXPECT_NEAR((*added)[0] - (*added)[1], std::log(30.5 / 10.5), 1e-10);
}

TEST(PairedComparisonTest, AnItemThatAlwaysWinsHasNoEndUnlessChoicesAreAdded) {
  MatrixXd wins = MatrixXd::Zero(3, 3);
  wins(0, 1) = wins(0, 2) = 4.0;
  wins(1, 2) = wins(2, 1) = 2.0;
  EXPECT_FALSE(worths(wins, PairedModel::kBradleyTerry, 0.0));
  EXPECT_FALSE(worths(wins, PairedModel::kThurstone, 0.0));
  const auto added = worths(wins, PairedModel::kThurstone, 0.5);
  ASSERT_TRUE(added);
  EXPECT_GT((*added)[0], 0.5);
  EXPECT_NEAR((*added)[1], (*added)[2], 1e-10);
  EXPECT_NEAR(added->sum(), 0.0, 1e-10);
}

/// Pairs of a chain are independent, so that each has the odds of its own choices.
TEST(PairedComparisonTest, ChoicesAreAddedToPresentedPairsAlone) {
  MatrixXd wins = MatrixXd::Zero(3, 3);
  wins(0, 1) = 5.0;
  wins(1, 0) = 15.0;
  wins(1, 2) = 4.0;
  wins(2, 1) = 16.0;
  const auto found = worths(wins, PairedModel::kBradleyTerry, 0.5);
  ASSERT_TRUE(found);
  EXPECT_NEAR((*found)[1] - (*found)[0], std::log(15.5 / 5.5), 1e-10);
  EXPECT_NEAR((*found)[2] - (*found)[1], std::log(16.5 / 4.5), 1e-10);
}

TEST(PairedComparisonTest, ItemsThatNoChainOfPairsLinksHaveNoWorths) {
  MatrixXd wins = MatrixXd::Zero(4, 4);
  wins(0, 1) = wins(1, 0) = 3.0;
  wins(2, 3) = wins(3, 2) = 5.0;
  for (const double added : {0.0, 0.5}) {
    const auto found = worths(wins, PairedModel::kBradleyTerry, added);
    ASSERT_FALSE(found);
    EXPECT_EQ(found.because(), "no chain of presented pairs links all items");
  }
}

TEST(PairedComparisonTest, ManyChoicesFindTheWorthsOfASimulatedPerson) {
  const VectorXd truth = (VectorXd(5) << -1.2, -0.5, 0.0, 0.4, 1.3).finished();
  MatrixXd wins = MatrixXd::Zero(5, 5);
  RandomStream random(1, "choices");
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < i; ++k) {
      for (int trial = 0; trial < 4000; ++trial) {
        const bool first = truth[i] - truth[k] + random.normal() > 0.0;
        ++(first ? wins(i, k) : wins(k, i));
      }
    }
  }
  const auto found = worths(wins, PairedModel::kThurstone, 0.5);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - truth).cwiseAbs().maxCoeff(), 0.05);
}

}  // namespace
}  // namespace haptrial::analysis
