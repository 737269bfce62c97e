// Time of one trial of QUEST+ (Bayes' rule and the choice of the next stimulus), and of the parts
// of simulated sessions, on one core. Times are processor time of this thread.
//
//     bench_psychometric

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "core/psychometric/function/response_observer.h"
#include "core/psychometric/procedure/psi_definition.h"
#include "core/psychometric/procedure/quest_plus.h"
#include "core/psychometric/procedure/staircase.h"
#include "core/psychometric/procedure/staircase_chain.h"

namespace {

using namespace haptrial::psychometric;

double now() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::vector<double> range(double first, double last, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(first + (last - first) * i / std::max(1, count - 1));
  }
  return values;
}

PsiParameters grid(int levels, int thresholds, int widths, int lapses) {
  PsiParameters p;
  p.function.sigmoid = Sigmoid::kGumbel;
  p.function.guess = 0.5;
  p.levels = range(-40.0, 0.0, levels);
  p.threshold.values = range(-40.0, 0.0, thresholds);
  p.width.values = range(4.0, 12.0, widths);
  p.lapse.values = range(0.0, 0.04, lapses);
  return p;
}

ObserverParameters observer_parameters() {
  ObserverParameters p;
  p.function.sigmoid = Sigmoid::kGumbel;
  p.function.threshold = -17.3;
  p.function.width = 7.0;
  p.function.guess = 0.5;
  p.function.lapse = 0.02;
  return p;
}

void quest_plus(const char* what, const PsiParameters& parameters, int trials) {
  const double begin = now();
  const auto tables = std::make_shared<QuestTables>(psi_definition(parameters));
  const double ready = now() - begin;
  std::vector<double> times;
  std::size_t compared = 0;
  for (int session = 0; session < 5; ++session) {
    QuestPlus quest(tables, {trials, 0.0});
    ResponseObserver observer(observer_parameters(), static_cast<std::uint64_t>(session), "bench");
    while (!quest.finished()) {
      const Level level = quest.next();
      const int answer = observer.answer(level[0]);
      const double from = now();
      quest.report(answer, level);
      times.push_back(now() - from);
      compared = std::max(compared, quest.compared());
    }
  }
  std::sort(times.begin(), times.end());
  std::printf(
      "%-34s %9zu cells  tables %7.1f ms  trial: median %8.1f us, 95 %% %8.1f us, "
      "slowest %8.1f us; at most %zu compared\n",
      what, tables->cells() * tables->stimuli(), 1e3 * ready, 1e6 * times[times.size() / 2],
      1e6 * times[times.size() * 95 / 100], 1e6 * times.back(), compared);
}

StaircaseParameters staircase() {
  StaircaseParameters p;
  p.low = -40.0;
  p.high = 0.0;
  p.start = -5.0;
  p.steps = {{4.0, 4.0, 0}, {2.0, 2.0, 2}, {1.0, 1.0, 4}};
  p.stop_reversals = 12;
  p.stop_trials = 100;
  p.skip = 4;
  return p;
}

void staircases() {
  constexpr int kRuns = 20'000;
  long trials = 0;
  const double from = now();
  for (int i = 0; i < kRuns; ++i) {
    Staircase track(staircase());
    ResponseObserver observer(observer_parameters(), static_cast<std::uint64_t>(i), "bench");
    while (!track.finished()) {
      const Level& level = track.next();
      track.report(observer.answer(level[0]), level);
      ++trials;
    }
  }
  std::printf("staircase with observer            %.3g trials a second\n",
              static_cast<double>(trials) / (now() - from));
  const PsychometricFunction psi(observer_parameters().function);
  const double begin = now();
  const auto predicted = predict_staircase(staircase(), psi, -17.3);
  std::printf(
      "its exact prediction               %.2f ms (mean %.3f, deviation %.3f, %.1f trials)\n",
      1e3 * (now() - begin), predicted.mean, predicted.deviation, predicted.trials);
}

}  // namespace

int main() {
  quest_plus("QUEST+, threshold, width, lapse", grid(41, 41, 4, 5), 128);
  quest_plus("QUEST+, large", grid(100, 100, 15, 10), 128);
  auto marginal = grid(41, 41, 4, 5);
  marginal.lapse.nuisance = true;
  quest_plus("marginal Psi, lapse a nuisance", marginal, 128);
  staircases();
  return 0;
}
