#include "tests/analysis/psychometric/fit/procedure_study.h"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "analysis/psychometric/fit/adaptive_posterior.h"
#include "analysis/psychometric/fit/track_interval.h"
#include "core/base/parallel.h"
#include "core/psychometric/function/response_observer.h"
#include "core/psychometric/procedure/adjusting.h"
#include "core/psychometric/procedure/listed.h"
#include "core/psychometric/procedure/pest.h"
#include "core/psychometric/procedure/psi_definition.h"
#include "core/psychometric/procedure/quest_plus.h"
#include "core/psychometric/procedure/staircase.h"

namespace haptrial::test {
namespace {

using namespace psychometric;
using analysis::Task;
using analysis::TrialBlock;

constexpr double kChance = 0.5;

PsychometricParameters function_of(const Truth& truth, Task task) {
  PsychometricParameters p;
  p.sigmoid = Sigmoid::kGaussian;
  p.threshold = truth.threshold;
  p.width = width_of_rate(p.sigmoid, 1.0 / truth.sigma);
  p.guess = task == Task::kForcedChoice ? kChance : truth.lapse;
  p.lapse = truth.lapse;
  return p;
}

ResponseObserver observer_of(const Truth& truth, Task task, std::uint64_t seed) {
  return {{function_of(truth, task), 0.0, 0.0}, seed, "coverage/answers"};
}

analysis::LikelihoodOptions options_of(Task task) {
  analysis::LikelihoodOptions options{.task = task};
  options.function.sigmoid = Sigmoid::kGaussian;
  options.function.guess = kChance;
  return options;
}

/// Runs the procedure to the end; every trial goes to the blocks of the session.
void run(Procedure& procedure, ResponseObserver& observer, Session& session) {
  while (!procedure.finished()) {
    const Level level = procedure.next();
    const int answer = observer.answer(level[0]);
    session.blocks.push_back({level[0], answer, 1});
    procedure.report(answer, level);
    ++session.trials;
  }
}

/// Result with the interval that the procedure states itself, or Student's of its error.
Found found_of(const Estimate& e, double truth) {
  if (e.interval) {
    return {e.value, truth, true, e.interval->low, e.interval->high};
  }
  if (!e.deviation || !e.freedom) {
    return {e.value, truth};
  }
  const double half = gsl_cdf_tdist_Pinv(0.975, *e.freedom) * *e.deviation;
  return {e.value, truth, true, e.value - half, e.value + half};
}

/// An estimate of a finished track, with the interval that a report states.
template <class Track, class Parameters>
void add_estimate(const Track& track, const Parameters& p, const Truth& truth, std::uint64_t seed,
                  Session& session) {
  const auto estimates = track.estimates();
  const auto blocks = analysis::pooled(session.blocks);
  if (estimates.empty() || blocks.size() < 2) {
    return;
  }
  const double aim =
      PsychometricFunction(function_of(truth, session.task)).level_for(*track.target());
  session.natural = Found{estimates[0].value, aim};
  const auto options = options_of(session.task);
  const auto draws =
      analysis::adaptive_posterior(blocks, options, 0.95, analysis::kPosteriorDraws).draws;
  const auto interval = analysis::track_interval(
      {estimates[0], session.blocks.size(), true, [&p] { return std::make_unique<Track>(p); }},
      options.function, draws, seed);
  if (interval) {
    session.natural->interval = true;
    session.natural->low = interval->low;
    session.natural->high = interval->high;
  }
}

Session constant_stimuli(const Truth& truth, std::uint64_t seed, Task task) {
  Session session;
  session.task = task;
  auto observer = observer_of(truth, task, seed);
  ConstantStimuli levels({{-2.1, -1.5, -0.9, -0.3, 0.3, 0.9, 1.5, 2.1}, 40, false}, seed,
                         "coverage/order");
  run(levels, observer, session);
  return session;
}

/// Steps of 1 until the second reversal, then `step` up and down by its ratio; the mean of
/// reversals 3 to 14.
StaircaseParameters staircase(int down, StaircaseStep step) {
  StaircaseParameters p;
  p.start = 3.0;
  p.low = -6.0;
  p.high = 6.0;
  p.down = down;
  p.steps = {{1.0, 1.0 * step.up / step.down, 0}, {step.down, step.up, 2}};
  p.stop_reversals = 14;
  p.stop_trials = 400;
  p.skip = 2;
  return p;
}

Session one_track(const Truth& truth, std::uint64_t seed, const StaircaseParameters& p) {
  Session session;
  session.adaptive = true;
  auto observer = observer_of(truth, Task::kForcedChoice, seed);
  Staircase track(p);
  run(track, observer, session);
  add_estimate(track, p, truth, seed, session);
  return session;
}

/// Tracks of the same rule, each from its own start; the interval is that of their mean.
Session four_tracks(const Truth& truth, std::uint64_t seed, StaircaseParameters p, double target) {
  Session session;
  session.adaptive = true;
  auto observer = observer_of(truth, Task::kForcedChoice, seed);
  std::vector<double> found;
  for (const double start : {2.0, 2.5, 3.0, 3.5}) {
    p.start = start;
    Staircase track(p);
    run(track, observer, session);
    found.push_back(track.estimates().at(0).value);
  }
  const double n = 4.0, mean = std::accumulate(found.begin(), found.end(), 0.0) / n;
  double squares = 0.0;
  for (const double f : found) {
    squares += (f - mean) * (f - mean);
  }
  const double aim =
      PsychometricFunction(function_of(truth, Task::kForcedChoice)).level_for(target);
  session.natural = found_of({"", mean, std::sqrt(squares / (n - 1.0) / n), n - 1.0}, aim);
  return session;
}

Session pest(const Truth& truth, std::uint64_t seed) {
  PestParameters p;
  p.start = 3.0;
  p.low = -6.0;
  p.high = 6.0;
  p.first_step = 1.0;
  p.smallest_step = 0.125;
  p.largest_step = 2.0;
  p.stop_trials = 400;
  Session session;
  session.adaptive = true;
  auto observer = observer_of(truth, Task::kForcedChoice, seed);
  Pest track(p);
  run(track, observer, session);
  add_estimate(track, p, truth, seed, session);
  return session;
}

/// Thresholds and widths on grids that are wider than what the observers have.
std::shared_ptr<const QuestTables> psi_tables(const std::vector<double>& lapses, bool nuisance) {
  PsiParameters p;
  p.function = function_of({}, Task::kForcedChoice);
  p.function.lapse = lapses[0];
  for (int i = 0; i <= 40; ++i) {
    p.levels.push_back(-5.0 + 0.25 * i);
  }
  for (int i = 0; i <= 60; ++i) {
    p.threshold.values.push_back(-3.03 + 0.1 * i);
  }
  for (int i = 0; i < 16; ++i) {  // sigma from 0.3 to 3
    p.width.values.push_back(
        width_of_rate(p.function.sigmoid, 1.0 / (0.3 * std::pow(10.0, i / 15.0))));
  }
  if (lapses.size() > 1) {
    p.lapse.values = lapses;
    p.lapse.nuisance = nuisance;
  }
  return std::make_shared<QuestTables>(psi_definition(p));
}

Session psi(const Truth& truth, std::uint64_t seed, std::shared_ptr<const QuestTables> tables) {
  Session session;
  session.adaptive = true;
  auto observer = observer_of(truth, Task::kForcedChoice, seed);
  QuestPlus quest(tables, {120, 0.0});
  run(quest, observer, session);
  const auto estimates = quest.estimates();
  session.natural = found_of(estimates[0], truth.threshold);
  const double width = function_of(truth, Task::kForcedChoice).width;
  session.width = found_of(estimates[1], width);
  for (double* number :
       {&session.width->value, &session.width->truth, &session.width->low, &session.width->high}) {
    *number = std::log(*number);
  }
  return session;
}

/// The observer steps towards equality by 0.2 until the direction has changed four times, twelve
/// settings from starts on both sides.
Session adjustment(const Truth& truth, std::uint64_t seed) {
  Session session;
  auto observer = observer_of(truth, Task::kYesNo, seed);
  AdjustingParameters parameters;
  parameters.starts = {{-3.0, -2.5, -2.0, 2.0, 2.5, 3.0}, 2, false};
  parameters.steps = {0.2};
  parameters.low = -20.0;
  parameters.high = 20.0;
  parameters.most_presentations = 1000;
  Adjusting settings(parameters, seed, "coverage/order");
  while (!settings.finished()) {
    double before = 0.0;
    for (int turns = 0; turns < 4;) {
      const Level level = settings.next();
      const double answer = observer.answer(level[0]) == 1 ? -1.0 : 1.0;  // 1: larger than equal
      turns += before != 0.0 && answer != before ? 1 : 0;
      before = answer;
      settings.report(answer, level);
    }
    settings.report(0.0, Level(settings.next()));
    ++session.trials;
  }
  session.natural = found_of(settings.estimates().at(0), truth.threshold);
  return session;
}

/// Eight levels, three times each; log-normal numbers that are rounded to two digits. The exponent
/// is that of an observer whose sigma is 1 at 1.
Session magnitudes(const Truth& truth, std::uint64_t seed) {
  Session session;
  RandomStream random(seed, "coverage/magnitudes");
  MagnitudeEstimation numbers({{1, 2, 4, 8, 16, 32, 64, 128}, 3, false}, std::nullopt, seed,
                              "coverage/order");
  while (!numbers.finished()) {
    const Level level = numbers.next();
    const double felt = 10.0 * std::pow(level[0], truth.sigma) * std::exp(0.3 * random.normal());
    const double digit = std::pow(10.0, std::floor(std::log10(felt)) - 1.0);
    numbers.report(digit * std::round(felt / digit), level);
    ++session.trials;
  }
  session.natural = found_of(numbers.estimates().at(0), truth.sigma);
  return session;
}

struct Counted {
  Session session;
  std::optional<analysis::ProfiledFit> fit;
  std::optional<analysis::AdaptivePosterior> posterior;  // of adaptive trials
  std::optional<analysis::BayesianFit> bayesian;
  Truth truth;
};

analysis::BayesianFit bayesian_of(const std::vector<TrialBlock>& blocks, Task task) {
  analysis::BayesianOptions options;
  options.function = options_of(task).function;
  options.task = task;
  options.levels = {0.95};
  return analysis::bayesian_fit(blocks, options);
}

Counted observed(const ProcedureStudy& study, std::uint64_t number, bool bayesian) {
  Counted counted;
  RandomStream random(number, "coverage/observer");
  counted.truth.threshold = random.uniform(-1.0, 1.0);
  counted.truth.sigma = 0.7 * std::pow(2.0, random.uniform());
  counted.session = study.run(counted.truth, number);
  if (counted.session.blocks.empty()) {
    return counted;
  }
  const auto options = options_of(counted.session.task);
  const auto blocks = analysis::pooled(counted.session.blocks);
  if (blocks.size() > 1) {
    counted.fit = analysis::profiled_fit(blocks, options);
    if (counted.session.adaptive) {
      counted.posterior = analysis::adaptive_posterior(blocks, options);
    }
    if (bayesian) {
      counted.bayesian = bayesian_of(blocks, counted.session.task);
    }
  }
  return counted;
}

void count(Tally& tally, const analysis::ProfileInterval& interval, double truth) {
  ++tally.observers;
  tally.held += interval.holds(truth) ? 1 : 0;
  tally.open += interval.low_open || interval.high_open ? 1 : 0;
}

void count(Tally& tally, const analysis::CredibleInterval& interval, double truth) {
  count(tally, analysis::ProfileInterval{interval.low, interval.high}, truth);
}

void add(StudyResult& result, const Counted& counted) {
  const Session& session = counted.session;
  if (session.natural) {
    result.natural.add(*session.natural);
  }
  if (session.width) {
    result.natural_width.add(*session.width);
  }
  if (!counted.fit) {
    return;
  }
  const double threshold = counted.truth.threshold;
  const double width = function_of(counted.truth, session.task).width;
  const auto& fit = *counted.fit;
  count(result.profile, fit.threshold, threshold);
  count(result.profile_width, fit.width, width);
  if (counted.posterior) {
    count(result.threshold, counted.posterior->threshold, threshold);
    count(result.width, counted.posterior->width, width);
  } else {
    count(result.threshold, fit.threshold, threshold);
    count(result.width, fit.width, width);
  }
  if (counted.bayesian) {
    const auto& intervals = counted.bayesian->intervals;
    count(result.bayesian, intervals[analysis::kThreshold][0], threshold);
    count(result.bayesian_width, intervals[analysis::kWidth][0], width);
  }
  result.undetermined += fit.fit.undetermined ? 1 : 0;
  if (!fit.fit.undetermined) {
    result.threshold.errors.push_back(fit.fit.parameters.threshold - threshold);
    result.width.errors.push_back(std::log(fit.fit.parameters.width / width));
  }
}

}  // namespace

std::vector<ProcedureStudy> procedure_studies() {
  const StaircaseStep equal{0.5, 0.5, 0};
  const StaircaseStep weighted{0.25, 0.75, 0};  // in balance at 0.75 (Kaernbach 1991)
  const auto track = [](int down, StaircaseStep step) {
    return [=](const Truth& t, std::uint64_t seed) {
      return one_track(t, seed, staircase(down, step));
    };
  };
  const auto of_tables = [](const std::vector<double>& lapses, bool nuisance) {
    return [tables = psi_tables(lapses, nuisance)](const Truth& t, std::uint64_t seed) {
      return psi(t, seed, tables);
    };
  };
  const auto constant = [](Task task) {
    return [=](const Truth& t, std::uint64_t seed) { return constant_stimuli(t, seed, task); };
  };
  const double two = balance_of(2, equal);
  return {{"constant stimuli, forced choice", "", constant(Task::kForcedChoice)},
          {"constant stimuli, yes/no", "", constant(Task::kYesNo)},
          {"2-down/1-up", "0.707", track(2, equal)},
          {"3-down/1-up", "0.794", track(3, equal)},
          {"weighted up-down", "0.75", track(1, weighted)},
          {"2-down/1-up, four tracks", "0.707",
           [=](const Truth& t, std::uint64_t seed) {
             return four_tracks(t, seed, staircase(2, equal), two);
           }},
          {"PEST", "0.75", pest},
          {"Psi", "threshold", of_tables({0.02}, false)},
          {"Psi that assumes no lapses", "threshold", of_tables({0.0}, false)},
          {"QUEST+ with lapses", "threshold", of_tables({0.0, 0.02, 0.04, 0.06}, false)},
          {"marginal Psi", "threshold", of_tables({0.0, 0.02, 0.04, 0.06}, true)},
          {"adjustment", "threshold", adjustment},
          {"magnitude estimation", "exponent", magnitudes}};
}

void Tally::add(const Found& found) {
  ++observers;
  errors.push_back(found.value - found.truth);
  open += found.interval ? 0 : 1;
  held += found.interval && found.low <= found.truth && found.truth <= found.high ? 1 : 0;
}

double Tally::bias() const {
  return std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
}

double Tally::deviation() const {
  const double mean = bias();
  double squares = 0.0;
  for (const double error : errors) {
    squares += (error - mean) * (error - mean);
  }
  return std::sqrt(squares / (static_cast<double>(errors.size()) - 1.0));
}

StudyResult run_study(const ProcedureStudy& study, int observers, int threads, int bayesian) {
  std::vector<Counted> all(static_cast<std::size_t>(observers));
  parallel_for(all.size(), threads, [&](std::size_t i) {
    all[i] = observed(study, i, i < static_cast<std::size_t>(bayesian));
  });
  StudyResult result;
  for (const Counted& counted : all) {
    result.trials += static_cast<double>(counted.session.trials) / observers;
    add(result, counted);
  }
  return result;
}

}  // namespace haptrial::test
