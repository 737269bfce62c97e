#include "core/deformable/calibration/annealing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace haptrial::deformable {
namespace {

using Cost = std::function<double(const std::vector<double>&)>;

/// Searches until `evaluations` costs are known. @returns every point that was asked for
std::vector<std::vector<double>> search(Annealing& annealing, const Cost& cost, long evaluations) {
  std::vector<std::vector<double>> asked;
  while (annealing.evaluations() < evaluations) {
    std::vector<double> costs;
    for (const auto& point : annealing.ask()) {
      asked.push_back(point);
      costs.push_back(cost(point));
    }
    annealing.tell(costs);
  }
  return asked;
}

/// Corana et al. 1987: 10^5 holes in each direction, the deepest at 0; gradients are of no use.
double corana(const std::vector<double>& x) {
  const double scale[] = {1.0, 1000.0, 10.0, 100.0};
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double hole = 0.2 * std::floor(std::abs(x[i] / 0.2) + 0.49999) *
                        (x[i] > 0.0   ? 1.0
                         : x[i] < 0.0 ? -1.0
                                      : 0.0);
    const double side = hole > 0.0 ? 1.0 : hole < 0.0 ? -1.0 : 0.0;
    sum += std::abs(x[i] - hole) < 0.05
               ? 0.15 * (hole - 0.05 * side) * (hole - 0.05 * side) * scale[i]
               : scale[i] * x[i] * x[i];
  }
  return sum;
}

TEST(AnnealingTest, FindsTheDeepestOfManyHoles) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Annealing annealing(std::vector<SearchRange>(4, {-1000.0, 1000.0}), seed);
    search(annealing, corana, 20000);
    found += annealing.best_cost() == 0.0;
  }
  EXPECT_GE(found, 9);
}

TEST(AnnealingTest, FindsAMinimumThatDependsOnOneDirectionMoreThanOnOthers) {
  const Cost bowl = [](const std::vector<double>& x) {
    return std::hypot(1e3 * (x[0] - 0.3), x[1] + 2.0, 10.0 * (x[2] - 5.0));
  };
  Annealing annealing({{-1.0, 1.0}, {-10.0, 10.0}, {0.0, 50.0}}, 3);
  search(annealing, bowl, 6000);
  EXPECT_NEAR(annealing.best()[0], 0.3, 1e-3);
  EXPECT_NEAR(annealing.best()[1], -2.0, 0.1);
  EXPECT_NEAR(annealing.best()[2], 5.0, 0.05);
}

TEST(AnnealingTest, AsksInsideOfItsRanges) {
  Annealing annealing({{2.0, 3.0}, {-1.0, 0.0}}, 5);
  const auto asked = search(
      annealing, [](const std::vector<double>& x) { return x[0] - x[1]; }, 2000);
  for (const auto& x : asked) {
    ASSERT_TRUE(x[0] >= 2.0 && x[0] <= 3.0 && x[1] >= -1.0 && x[1] <= 0.0);
  }
  EXPECT_NEAR(annealing.best_cost(), 2.0, 1e-3) << "the corner";
}

/// Nine tenths of the square are unstable.
TEST(AnnealingTest, UnstablePointsAreNeverTaken) {
  const Cost cost = [](const std::vector<double>& x) {
    return x[0] < 0.9 ? std::numeric_limits<double>::infinity() : std::hypot(x[0] - 0.95, x[1]);
  };
  Annealing annealing({{0.0, 1.0}, {-1.0, 1.0}}, 7, {.samples = 3});
  search(annealing, cost, 3000);
  EXPECT_LT(annealing.best_cost(), 1e-3);
}

TEST(AnnealingTest, GoesOnByItsRecordedCosts) {
  Annealing whole(std::vector<SearchRange>(4, {-1000.0, 1000.0}), 11, {.batch = 4});
  const auto asked = search(whole, corana, 1500);
  Annealing first(std::vector<SearchRange>(4, {-1000.0, 1000.0}), 11, {.batch = 4});
  search(first, corana, 700);
  Annealing second(std::vector<SearchRange>(4, {-1000.0, 1000.0}), 11, {.batch = 4});
  const long before = first.evaluations();
  search(second, corana, before);  // by the record
  const auto rest = search(second, corana, 1500);
  ASSERT_EQ(rest.size() + static_cast<std::size_t>(before), asked.size());
  EXPECT_TRUE(std::equal(rest.rbegin(), rest.rend(), asked.rbegin()));
}

TEST(AnnealingTest, RefusesWhatIsNoSearch) {
  EXPECT_THROW(Annealing({}, 1), std::invalid_argument);
  EXPECT_THROW(Annealing({{1.0, 1.0}}, 1), std::invalid_argument);
  EXPECT_THROW(Annealing({{0.0, 1.0}}, 1, {.samples = 0}), std::invalid_argument);
  Annealing annealing({{0.0, 1.0}}, 1);
  EXPECT_THROW(annealing.tell(std::vector<double>{1.0}), std::invalid_argument);
  annealing.ask();
  EXPECT_THROW(annealing.tell(std::vector<double>(100, std::nan(""))), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::deformable
