#include "tests/analysis/psychometric/fit/surface_counts.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "analysis/psychometric/fit/contour.h"
#include "analysis/psychometric/fit/surface_fit.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/psychometric/procedure/quest_plus.h"

namespace haptrial::test {
namespace {

using namespace analysis;
using psychometric::QuestDefinition;

std::vector<double> even(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(from + (to - from) * i / (count - 1));
  }
  return values;
}

/// The answers of an observer to what QUEST+ presents.
std::vector<SurfaceTrial> asked(const std::shared_ptr<const psychometric::QuestTables>& tables,
                                const std::vector<double>& truth, int trials,
                                RandomStream& random) {
  psychometric::QuestPlus quest(tables, {trials, 0.0});
  std::vector<SurfaceTrial> all;
  std::array<double, 2> p{};
  while (!quest.finished()) {
    const psychometric::Level level = quest.next();
    tables->definition().model(level.data(), truth.data(), p.data());
    const bool one = random.uniform() < p[1];
    quest.report(one ? 1.0 : 0.0, level);
    all.push_back({level, one ? 1u : 0u});
  }
  return all;
}

/// One observer. @returns counts of 1 at most
SurfaceCounts count_one(const std::shared_ptr<const psychometric::QuestTables>& tables,
                        std::uint64_t number) {
  constexpr int kTrials = 120;
  RandomStream random(number, "surface observer");
  const std::vector<double> truth{0.5 + random.uniform(), 0.7 + 0.6 * random.uniform(),
                                  0.1 + 0.2 * random.uniform()};
  const SurfaceFit fit = fit_surface(tables->definition(), asked(tables, truth, kTrials, random));
  SurfaceCounts counts;
  counts.observers = 1;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const SurfaceParameter& p = fit.parameters[k];
    counts.held[k] = p.low <= truth[k] && truth[k] <= p.high ? 1 : 0;
    counts.error[k] = p.mean - truth[k];
  }
  const ContourPoint at_zero = ThresholdMap(tables->definition(), fit, 0.5).points(5).front();
  const double second = truth[0] / truth[1];  // where x is 0
  if (at_zero.low == at_zero.low && at_zero.high == at_zero.high) {
    counts.contours = 1;
    counts.contours_held = at_zero.low <= second && second <= at_zero.high ? 1 : 0;
  }
  return counts;
}

}  // namespace

QuestDefinition ellipse() {
  QuestDefinition d;
  d.stimulus = {{"x", even(0.0, 2.0, 8), {}, false}, {"y", even(0.0, 2.0, 8), {}, false}};
  d.parameters = {{"threshold", even(0.5, 1.5, 11), {}, false},
                  {"gain", even(0.7, 1.3, 7), {}, false},
                  {"spread", {0.1, 0.2, 0.3}, {}, false}};
  d.model = [](const double* s, const double* p, double* probability) {
    const double z = (std::hypot(s[0], p[1] * s[1]) - p[0]) / p[2];
    probability[1] = 0.01 + 0.98 * 0.5 * std::erfc(-z / std::sqrt(2.0));
    probability[0] = 1.0 - probability[1];
  };
  return d;
}

SurfaceCounts count_surfaces(int observers, int threads) {
  const auto tables = std::make_shared<const psychometric::QuestTables>(ellipse());
  std::vector<SurfaceCounts> each(static_cast<std::size_t>(observers));
  parallel_for(each.size(), threads, [&](std::size_t i) { each[i] = count_one(tables, i); });
  SurfaceCounts sum;
  for (const SurfaceCounts& one : each) {
    sum.observers += 1;
    sum.contours += one.contours;
    sum.contours_held += one.contours_held;
    for (std::size_t k = 0; k < sum.held.size(); ++k) {
      sum.held[k] += one.held[k];
      sum.error[k] += one.error[k] / observers;
    }
  }
  return sum;
}

}  // namespace haptrial::test
