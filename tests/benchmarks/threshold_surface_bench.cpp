// A threshold over a second variable, found without a formula (ThresholdSurface) and by QUEST+ with
// the true formula: mean error along the threshold by trials, how often the 95 % intervals hold the
// truth, and the time of a trial. bench_threshold_surface [OBSERVERS], 100 by default.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <vector>

#include "core/base/random.h"
#include "core/psychometric/function/sigmoid.h"
#include "core/psychometric/procedure/quest_plus.h"
#include "core/psychometric/procedure/threshold_surface.h"

namespace haptrial::psychometric {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSpread = 0.1, kLapse = 0.02;
constexpr int kTrials = 120, kTold = 20;
constexpr std::array kPlaces{0.0, 0.3, 0.5, 0.8, 1.0};  // of the second variable, from 0 to 1

struct Shape {
  const char* name;
  double base, gain;  // threshold = base + gain * form(b)
  double (*form)(double b);
};
const std::array kShapes{
    Shape{"straight", 0.35, 0.3, [](double b) { return b; }},
    Shape{"bow", 0.6, -0.25, [](double b) { return std::sin(std::numbers::pi * b); }},
    Shape{"parabola", 0.3, 0.3, [](double b) { return b * b; }}};

struct Observer {
  const Shape* shape;
  double guess;
  double threshold(double b) const { return shape->base + shape->gain * shape->form(b); }
  double probability(const Level& level) const {
    const double z = (level[0] - threshold(level[1])) / kSpread;
    return guess + (1.0 - guess - kLapse) * sigmoid(Sigmoid::kGaussian, z);
  }
};

std::vector<double> even(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(from + (to - from) * i / (count - 1));
  }
  return values;
}

struct Found {
  std::array<double, kTrials / kTold> error{};
  int held{0}, told{0};
  double seconds{0.0};
};

Found by_surface(const Observer& observer, int observers) {
  SurfaceParameters p;
  p.variables = {{"a", even(0.0, 1.0, 21), true}, {"b", even(0.0, 1.0, 11), false}};
  p.guess = observer.guess;
  p.lapse = kLapse;
  p.trials = kTrials;
  std::vector<Level> others;
  for (const double b : kPlaces) {
    others.push_back({b});
  }
  Found found;
  for (int i = 0; i < observers; ++i) {
    RandomStream random(static_cast<std::uint64_t>(i), "answers");
    ThresholdSurface surface(p);
    for (int trial = 1; trial <= kTrials; ++trial) {
      const Level level = surface.next();
      const bool yes = random.uniform() < observer.probability(level);
      const auto begun = Clock::now();
      surface.report(yes ? 1.0 : 0.0, level);
      found.seconds += std::chrono::duration<double>(Clock::now() - begun).count();
      if (trial % kTold != 0) {
        continue;
      }
      const auto thresholds = surface.thresholds(others);
      for (std::size_t k = 0; k < others.size(); ++k) {
        const double truth = observer.threshold(kPlaces[k]);  // the target is halfway up
        const auto& [median, low, high] = thresholds[k];
        found.error[static_cast<std::size_t>(trial / kTold - 1)] +=
            std::abs(std::clamp(median, 0.0, 1.0) - truth) / (kPlaces.size() * observers);
        found.held += trial == kTrials && low <= truth && truth <= high ? 1 : 0;
        found.told += trial == kTrials ? 1 : 0;
      }
    }
  }
  return found;
}

/// Base, gain and spread are asked for; none of their values is the truth.
std::shared_ptr<const QuestTables> tables_of(const Observer& observer) {
  QuestDefinition d;
  d.stimulus = {{"a", even(0.0, 1.0, 21), {}, false}, {"b", even(0.0, 1.0, 11), {}, false}};
  d.parameters = {{"base", even(0.103, 0.795, 41), {}, false},
                  {"gain", even(-0.391, 0.461, 41), {}, false},
                  {"spread", {0.052, 0.074, 0.105, 0.148, 0.21}, {}, false}};
  const double guess = observer.guess;
  const auto form = observer.shape->form;
  d.model = [guess, form](const double* at, const double* p, double* probability) {
    const double z = (at[0] - p[0] - p[1] * form(at[1])) / p[2];
    probability[1] = guess + (1.0 - guess - kLapse) * sigmoid(Sigmoid::kGaussian, z);
    probability[0] = 1.0 - probability[1];
  };
  return std::make_shared<const QuestTables>(std::move(d));
}

Found by_quest(const Observer& observer, int observers) {
  const auto tables = tables_of(observer);
  Found found;
  for (int i = 0; i < observers; ++i) {
    RandomStream random(static_cast<std::uint64_t>(i), "answers");
    QuestPlus quest(tables, {kTrials, 0.0});
    for (int trial = 1; trial <= kTrials; ++trial) {
      const Level level = quest.next();
      const bool yes = random.uniform() < observer.probability(level);
      quest.report(yes ? 1.0 : 0.0, level);
      const auto estimates = quest.estimates();
      for (std::size_t k = 0; trial % kTold == 0 && k < kPlaces.size(); ++k) {
        const double told =
            estimates[0].value + estimates[1].value * observer.shape->form(kPlaces[k]);
        found.error[static_cast<std::size_t>(trial / kTold - 1)] +=
            std::abs(told - observer.threshold(kPlaces[k])) / (kPlaces.size() * observers);
      }
    }
  }
  return found;
}

void print(const char* name, const Found& found) {
  fmt::print("  {:<22}", name);
  for (const double each : found.error) {
    fmt::print("{:8.4f}", each);
  }
  if (found.told > 0) {
    fmt::print("   {:.1f} % held", 100.0 * found.held / found.told);
  }
  fmt::print("\n");
}

}  // namespace
}  // namespace haptrial::psychometric

int main(int argc, char** argv) {
  using namespace haptrial::psychometric;
  const int observers = argc > 1 ? std::atoi(argv[1]) : 100;
  fmt::print("mean error of the threshold after {}, {}, ... {} trials, in a range of 1\n", kTold,
             2 * kTold, kTrials);
  double seconds = 0.0;
  int trials = 0;
  for (const double guess : {0.0, 0.5}) {
    for (const Shape& shape : kShapes) {
      const Observer observer{&shape, guess};
      fmt::print("{}, guess rate {}\n", shape.name, guess);
      const Found surface = by_surface(observer, observers);
      print("surface", surface);
      print("QUEST+, true formula", by_quest(observer, observers));
      seconds += surface.seconds;
      trials += observers * kTrials;
    }
  }
  fmt::print("{:.2f} ms a trial\n", 1e3 * seconds / trials);
  return 0;
}
