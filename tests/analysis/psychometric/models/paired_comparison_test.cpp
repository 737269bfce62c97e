#include "analysis/psychometric/models/paired_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Citations between four journals of statistics (Agresti 2002, Categorical Data Analysis, §10.6):
/// the largest penalised likelihood (Firth 1993), which R's optim() finds. So many choices leave
/// hardly any bias, so that R's glm() with a probit link is near, too.
TEST(PairedComparisonTest, AgreesWithR) {
  MatrixXd wins(4, 4);
  wins << 0, 730, 498, 221, 33, 0, 68, 17, 320, 813, 0, 142, 284, 276, 325, 0;
  const auto logit = worths(wins, PairedModel::kBradleyTerry);
  const auto probit = worths(wins, PairedModel::kThurstone);
  ASSERT_TRUE(logit && probit);
  EXPECT_TRUE(
      logit->isApprox(Eigen::Vector4d(0.78873152, -2.15565031, 0.30965625, 1.05726254), 1e-7));
  EXPECT_TRUE(probit->isApprox(
      Eigen::Vector4d(0.4513724684, -1.2233212089, 0.1614592046, 0.6104895358), 2e-3));
}

/// The first item was chosen in 17 of 20 trials, each other one seldom; by R's optim().
TEST(PairedComparisonTest, FewChoicesAgreeWithR) {
  MatrixXd wins(4, 4);
  wins << 0, 6, 5, 6, 0, 0, 4, 2, 1, 2, 0, 6, 0, 4, 0, 0;
  const auto found = worths(wins, PairedModel::kBradleyTerry);
  ASSERT_TRUE(found);
  EXPECT_TRUE(
      found->isApprox(Eigen::Vector4d(1.85827489, -0.68068348, -0.09100304, -1.08658837), 1e-6));
}

/// With one pair the bias is taken away by half a choice of either item (Haldane 1956).
TEST(PairedComparisonTest, TwoItemsHaveTheOddsOfTheirChoices) {
  MatrixXd wins = MatrixXd::Zero(2, 2);
  wins(0, 1) = 30.0;
  wins(1, 0) = 10.0;
  const auto found = worths(wins, PairedModel::kBradleyTerry);
  EXPECT_NEAR((*found)[0] - (*found)[1], std::log(30.5 / 10.5), 1e-10);
}

/// Ford (1957): worths are bounded if chains of choices lead both ways between all items.
TEST(PairedComparisonTest, ChoicesOneWayAcrossACutLeaveWorthsOpen) {
  MatrixXd wins = MatrixXd::Zero(4, 4);
  const auto open = [&] {
    const Eigen::ArrayX<bool> found = open_worths(wins);
    return std::vector<bool>(found.begin(), found.end());
  };
  wins(0, 1) = wins(1, 0) = wins(2, 3) = wins(3, 2) = 3.0;
  wins(2, 1) = 6.0;  // one half always wins, where the halves meet
  EXPECT_EQ(open(), std::vector<bool>(4, true));
  wins(1, 2) = 1.0;
  EXPECT_EQ(open(), std::vector<bool>(4, false));
  wins(2, 3) = 0.0;  // the last one always wins
  EXPECT_EQ(open(), (std::vector<bool>{false, false, false, true}));
}

TEST(PairedComparisonTest, AnItemThatAlwaysWinsHasAnEnd) {
  MatrixXd wins = MatrixXd::Zero(3, 3);
  wins(0, 1) = wins(0, 2) = 4.0;
  wins(1, 2) = wins(2, 1) = 2.0;
  for (const PairedModel model : {PairedModel::kBradleyTerry, PairedModel::kThurstone}) {
    const auto found = worths(wins, model);
    ASSERT_TRUE(found);
    EXPECT_GT((*found)[0], 0.5);
    EXPECT_NEAR((*found)[1], (*found)[2], 1e-10);
    EXPECT_NEAR(found->sum(), 0.0, 1e-10);
  }
}

/// One trial for each pair of a chain, and items that lose to all before them, are the hardest.
TEST(PairedComparisonTest, WorthsSettleWithOneTrialOfEachPair) {
  for (const PairedModel model : {PairedModel::kBradleyTerry, PairedModel::kThurstone}) {
    for (const Eigen::Index reach : {1, 11}) {
      MatrixXd wins = MatrixXd::Zero(12, 12);
      for (Eigen::Index i = 0; i < 12; ++i) {
        for (Eigen::Index k = i + 1; k < std::min<Eigen::Index>(12, i + reach + 1); ++k) {
          wins(i, k) = 1.0;
        }
      }
      const auto found = worths(wins, model);
      ASSERT_TRUE(found) << found.because();
      for (Eigen::Index i = 1; i < 12; ++i) {
        EXPECT_GT((*found)[i - 1], (*found)[i]);
      }
    }
  }
}

/// Pairs of a chain are independent, so that each has the odds of its own choices.
TEST(PairedComparisonTest, PairsOfAChainHaveTheirOwnOdds) {
  MatrixXd wins = MatrixXd::Zero(3, 3);
  wins(0, 1) = 5.0;
  wins(1, 0) = 15.0;
  wins(1, 2) = 4.0;
  wins(2, 1) = 16.0;
  const auto found = worths(wins, PairedModel::kBradleyTerry);
  ASSERT_TRUE(found);
  EXPECT_NEAR((*found)[1] - (*found)[0], std::log(15.5 / 5.5), 1e-10);
  EXPECT_NEAR((*found)[2] - (*found)[1], std::log(16.5 / 4.5), 1e-10);
}

TEST(PairedComparisonTest, ItemsThatNoChainOfPairsLinksHaveNoWorths) {
  MatrixXd wins = MatrixXd::Zero(4, 4);
  wins(0, 1) = wins(1, 0) = 3.0;
  wins(2, 3) = wins(3, 2) = 5.0;
  const auto found = worths(wins, PairedModel::kBradleyTerry);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.because(), "no chain of presented pairs links all items");
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
  const auto found = worths(wins, PairedModel::kThurstone);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - truth).cwiseAbs().maxCoeff(), 0.05);
}

/// Six trials of each pair, as an experiment has; half a choice added to each pair made 1.5
/// to 1.23.
TEST(PairedComparisonTest, MeansOverPeopleWithFewTrialsHaveHardlyAnyBias) {
  constexpr int kPeople = 3000;
  const Eigen::Vector4d truth(-1.5, -0.5, 0.5, 1.5);
  RandomStream random(2, "choices");
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  for (int person = 0; person < kPeople; ++person) {
    MatrixXd wins = MatrixXd::Zero(4, 4);
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < i; ++k) {
        for (int trial = 0; trial < 6; ++trial) {
          const bool first = random.uniform() < 1.0 / (1.0 + std::exp(truth[k] - truth[i]));
          ++(first ? wins(i, k) : wins(k, i));
        }
      }
    }
    mean += *worths(wins, PairedModel::kBradleyTerry) / kPeople;
  }
  EXPECT_LT((mean - truth).cwiseAbs().maxCoeff(), 0.07);
}

}  // namespace
}  // namespace haptrial::analysis
