// Fits of psychometric functions: time of a maximum-likelihood fit of eight levels for each sigmoid
// and task (processor time of this thread), of a bootstrap and of a Bayesian fit; and the coverage
// study of docs/algorithms/psychometric-fits.md: observers with a known function, eight levels of
// 40 trials each, and how often the 95 % interval holds their threshold.
//
//     bench_psychometric_fit [observers] [bootstrap resamples] [observers of the Bayesian fit]
//
// With 0 resamples or 0 observers that part is left out.

#include <fmt/format.h>
#include <time.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "analysis/psychometric/fit/bayesian_fit.h"
#include "analysis/psychometric/fit/bootstrap_fit.h"
#include "analysis/psychometric/fit/profile_interval.h"
#include "core/base/parallel.h"
#include "core/base/random.h"

namespace {

using namespace haptrial::analysis;
using haptrial::psychometric::parameters_named;
using haptrial::psychometric::PsychometricFunction;
using haptrial::psychometric::PsychometricParameters;

double seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Study {
  const char* sigmoid;
  Task task;
  double lapse;
};

/// Eight levels over 1.2 widths around the threshold 2 (in the coordinate).
class Observer {
 public:
  explicit Observer(const Study& study)
      : study_(study), shape_(parameters_named(study.sigmoid, 0.5)) {}

  PsychometricFunction function() const {
    const double guess = study_.task == Task::kForcedChoice ? 0.5 : 0.02;
    return fitted_function(shape_, {2.0, 1.0, study_.lapse, guess});
  }

  std::vector<TrialBlock> answers(std::uint64_t number) const {
    haptrial::RandomStream random(number, std::string("observer ") + study_.sigmoid);
    std::vector<TrialBlock> blocks;
    for (int i = 0; i < 8; ++i) {
      TrialBlock block{shape_.axis.level(1.4 + 1.2 * i / 7.0), 0, 40};
      const double p = function()(block.level);
      for (int t = 0; t < 40; ++t) {
        block.correct += random.uniform() < p ? 1 : 0;
      }
      blocks.push_back(block);
    }
    return blocks;
  }

  LikelihoodOptions options() const { return {.function = shape_, .task = study_.task}; }

 private:
  Study study_;
  PsychometricParameters shape_;
};

std::string name_of(const Study& s) {
  return fmt::format("{:9} {:13}", s.sigmoid,
                     s.task == Task::kForcedChoice ? "forced choice"
                     : s.task == Task::kYesNo      ? "yes/no"
                                                   : "equal");
}

void time_fit(const Study& study) {
  const Observer observer(study);
  constexpr std::size_t kObservers = 200, kRounds = 50;
  std::vector<LikelihoodFitter> fitters;
  std::vector<std::vector<int>> correct(kObservers);
  for (std::size_t i = 0; i < kObservers; ++i) {
    const auto blocks = observer.answers(i);
    fitters.emplace_back(observer.options(), blocks);
    for (const TrialBlock& b : blocks) {
      correct[i].push_back(b.correct);
    }
  }
  double best = 1e9, steps = 0.0;
  for (std::size_t round = 0; round < kRounds; ++round) {
    const double start = seconds();
    steps = 0.0;
    for (std::size_t i = 0; i < kObservers; ++i) {
      steps += fitters[i].fit(correct[i]).steps;
    }
    best = std::min(best, seconds() - start);
  }
  fmt::print("{}  {:5.2f} us a fit, {:4.1f} steps\n", name_of(study),
             1e6 * best / static_cast<double>(kObservers), steps / static_cast<double>(kObservers));
}

/// Intervals that hold the truth, and the estimates.
struct Counted {
  double held{0.0}, none{0.0}, sum{0.0}, squares{0.0}, count{0.0};

  void add(double estimate, double truth, bool interval, bool holds) {
    count += 1.0;
    none += interval ? 0.0 : 1.0;
    held += holds ? 1.0 : 0.0;
    sum += estimate - truth;
    squares += (estimate - truth) * (estimate - truth);
  }
  void print(const std::string& what, const char* lacking = "none") const {
    const double bias = sum / count;
    fmt::print("  {:34} held {:5.1f} %, {} {:4.1f} %, bias {:+.4f}, SD {:.4f}\n", what,
               100.0 * held / count, lacking, 100.0 * none / count, bias,
               std::sqrt(squares / count - bias * bias));
  }
};

void cover_by_profile(const Observer& observer, std::size_t observers) {
  std::vector<ProfiledFit> fits(observers);
  std::vector<std::vector<TrialBlock>> answers(observers);
  for (std::size_t i = 0; i < observers; ++i) {
    answers[i] = observer.answers(i);
  }
  const double start = seconds();
  for (std::size_t i = 0; i < observers; ++i) {
    fits[i] = profiled_fit(answers[i], observer.options());
  }
  const double each = (seconds() - start) / static_cast<double>(observers);
  const auto truth = observer.function().parameters();
  const double middle = truth.axis.at(truth.threshold);
  Counted threshold, width;
  for (const ProfiledFit& f : fits) {
    const FittedParameters& p = f.fit.parameters;
    threshold.add(p.threshold, middle, !f.threshold.low_open && !f.threshold.high_open,
                  f.threshold.holds(middle));
    width.add(p.width, truth.width, !f.width.low_open && !f.width.high_open,
              f.width.holds(truth.width));
  }
  threshold.print("threshold, profile", "open");
  width.print("width, profile", "open");
  fmt::print("  {:.1f} us a fit with both intervals\n", 1e6 * each);
}

void cover_by_bootstrap(const Observer& observer, std::size_t observers, std::size_t resamples,
                        bool parametric) {
  const std::vector<BootstrapTarget> asked{{Reading::kThreshold}, {Reading::kWidth}};
  std::vector<BootstrappedFit> fits(observers);
  const double start = seconds();
  haptrial::parallel_for(observers, 1, [&](std::size_t i) {
    FitBootstrap how{.parametric = parametric};
    how.resampling.count = resamples;
    how.resampling.seed = i;
    fits[i] = bootstrap_fit(observer.answers(i), observer.options(), asked, how);
  });
  const auto truth = observer.function().parameters();
  const double truths[] = {truth.threshold, truth.width};
  const char* const names[] = {"threshold", "width"};
  for (std::size_t a = 0; a < 2; ++a) {
    Counted counted;
    for (const BootstrappedFit& fit : fits) {
      const auto& found = fit.intervals[a];
      counted.add(fit.estimates[a], truths[a], found && found->corrected,
                  found && found->low <= truths[a] && truths[a] <= found->high);
    }
    counted.print(std::string(names[a]) + (parametric ? ", parametric" : ", non-parametric"),
                  "percentiles");
  }
  double rejected = 0.0;
  for (const BootstrappedFit& fit : fits) {
    rejected += fit.deviance_p < 0.05 ? 1.0 : 0.0;
  }
  fmt::print("  deviance p < 0.05 in {:.1f} %; {:.1f} ms an observer\n",
             100.0 * rejected / static_cast<double>(observers),
             1e3 * (seconds() - start) / static_cast<double>(observers));
}

void cover_by_posterior(const Observer& observer, std::size_t observers) {
  BayesianOptions options;
  options.function = observer.options().function;
  options.task = observer.options().task;
  std::vector<BayesianFit> fits(observers);
  const double start = seconds();
  for (std::size_t i = 0; i < observers; ++i) {
    fits[i] = bayesian_fit(observer.answers(i), options);
  }
  const double each = (seconds() - start) / static_cast<double>(observers);
  const auto truth = observer.function().parameters();
  const double middle = truth.axis.at(truth.threshold);
  Counted threshold, width, mean;
  for (const BayesianFit& fit : fits) {
    const auto& t = fit.intervals[kThreshold][0];
    const auto& w = fit.intervals[kWidth][0];
    const bool holds = t.low <= middle && middle <= t.high;
    threshold.add(fit.map.threshold, middle, true, holds);
    mean.add(fit.mean.threshold, middle, true, holds);
    width.add(fit.map.width, truth.width, true, w.low <= truth.width && truth.width <= w.high);
  }
  threshold.print("threshold, posterior (largest)");
  mean.print("threshold, posterior (mean)");
  width.print("width, posterior (largest)");
  fmt::print("  {:.0f} ms a fit\n", 1e3 * each);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t observers = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1000;
  const std::size_t resamples = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 999;
  const std::size_t of_posterior = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : observers;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  for (const char* sigmoid : {"norm", "logistic", "Weibull", "gumbel"}) {
    for (const Task task : {Task::kForcedChoice, Task::kYesNo, Task::kEqualAsymptote}) {
      time_fit({sigmoid, task, 0.02});
    }
  }
  for (const Study& study :
       {Study{"norm", Task::kForcedChoice, 0.02}, Study{"Weibull", Task::kForcedChoice, 0.02},
        Study{"norm", Task::kYesNo, 0.02}}) {
    const Observer observer(study);
    fmt::print("{} {} observers\n", name_of(study), observers);
    cover_by_profile(observer, observers);
    if (resamples > 0) {
      cover_by_bootstrap(observer, observers, resamples, true);
      cover_by_bootstrap(observer, observers, resamples, false);
    }
    if (of_posterior > 0 && study.task == Task::kForcedChoice) {
      cover_by_posterior(observer, of_posterior);
    }
  }
  return 0;
}
