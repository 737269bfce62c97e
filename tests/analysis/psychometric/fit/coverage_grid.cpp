#include "tests/analysis/psychometric/fit/coverage_grid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "analysis/psychometric/fit/adaptive_posterior.h"
#include "analysis/psychometric/fit/bootstrap_fit.h"
#include "analysis/psychometric/fit/stated_fit.h"
#include "analysis/psychometric/fit/track_interval.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/psychometric/procedure/listed.h"
#include "core/psychometric/procedure/pest.h"
#include "core/psychometric/procedure/psi_definition.h"
#include "core/psychometric/procedure/quest_plus.h"
#include "core/psychometric/procedure/staircase.h"

namespace haptrial::test {
namespace {

using namespace psychometric;
using namespace analysis;

constexpr double kEnd = 2.1;  // of the levels
constexpr int kAdaptiveTrials = 100;

PsychometricParameters gaussian(double threshold, double sigma, double lapse, double guess) {
  PsychometricParameters p;
  p.sigmoid = Sigmoid::kGaussian;
  p.threshold = threshold;
  p.width = width_of_rate(p.sigmoid, 1.0 / sigma);
  p.lapse = lapse;
  p.guess = guess;
  return p;
}

/// Answers whose probability varies between levels: Polya's urn gives the beta-binomial.
class CorrelatedObserver {
 public:
  CorrelatedObserver(const PsychometricParameters& p, double correlation, RandomStream& random)
      : function_(p), weight_(1.0 / correlation - 1.0), random_(random) {}

  int answer(double level) {
    double p = function_(level);
    auto& [ones, trials] = before_[level];
    if (std::isfinite(weight_)) {
      p = (p * weight_ + ones) / (weight_ + trials);
    }
    const int answer = random_.uniform() < p ? 1 : 0;
    ones += answer;
    trials += 1.0;
    return answer;
  }

 private:
  PsychometricFunction function_;
  double weight_;
  RandomStream& random_;
  std::map<double, std::pair<double, double>> before_;
};

StaircaseParameters staircase_of(int alternatives) {
  StaircaseParameters p;
  p.start = 2.0;
  p.low = -kEnd;
  p.high = kEnd;
  p.down = alternatives == 1 ? 1 : 2;
  p.steps = {{1.0, 1.0, 0}, {0.5, 0.5, 2}};
  p.stop_reversals = 14;
  p.stop_trials = kAdaptiveTrials;
  p.skip = 2;
  return p;
}

PestParameters pest_of(int alternatives) {
  PestParameters p;
  p.start = 2.0;
  p.low = -kEnd;
  p.high = kEnd;
  p.target = alternatives == 1 ? 0.5 : alternatives == 2 ? 0.75 : 0.625;
  p.first_step = 1.0;
  p.smallest_step = 0.125;
  p.largest_step = 2.0;
  p.stop_trials = 400;
  return p;
}

/// Thresholds reach half a range beyond the levels, as those of a definition without a list do.
std::shared_ptr<const QuestTables> tables_of(int alternatives, bool lapses) {
  PsiParameters p;
  p.function = gaussian(0.0, 1.0, 0.02, alternatives == 1 ? 0.1 : 1.0 / alternatives);
  for (int i = -10; i <= 30; ++i) {
    const double level = -kEnd + 0.21 * i;
    p.threshold.values.push_back(level);
    if (i >= 0 && i <= 20) {
      p.levels.push_back(level);
    }
  }
  for (int i = 0; i < 8; ++i) {
    const double sigma = 0.3 * std::pow(10.0, i / 7.0);  // to 3
    p.width.values.push_back(width_of_rate(Sigmoid::kGaussian, 1.0 / sigma));
  }
  if (lapses) {
    p.lapse.values = {0.0, 0.05, 0.1, 0.2};
  }
  return std::make_shared<const QuestTables>(psi_definition(p));
}

std::shared_ptr<const QuestTables> shared_tables(int alternatives, bool lapses) {
  static const std::map<std::pair<int, bool>, std::shared_ptr<const QuestTables>> all = [] {
    std::map<std::pair<int, bool>, std::shared_ptr<const QuestTables>> made;
    for (const int n : {1, 2, 4}) {
      for (const bool with : {false, true}) {
        made[{n, with}] = tables_of(n, with);
      }
    }
    return made;
  }();
  return all.at({alternatives, lapses});
}

std::unique_ptr<Procedure> begin(const CoverageCell& cell, std::uint64_t seed) {
  if (cell.procedure == "staircase") {
    return std::make_unique<Staircase>(staircase_of(cell.alternatives));
  }
  if (cell.procedure == "PEST") {
    return std::make_unique<Pest>(pest_of(cell.alternatives));
  }
  if (cell.procedure == "listed") {
    return std::make_unique<ConstantStimuli>(
        ListParameters{{-2.1, -1.5, -0.9, -0.3, 0.3, 0.9, 1.5, 2.1}, 40, false}, seed,
        "coverage/order");
  }
  return std::make_unique<QuestPlus>(shared_tables(cell.alternatives, cell.procedure == "QUEST+"),
                                     QuestStop{kAdaptiveTrials, 0.0});
}

struct Answers {
  std::vector<TrialBlock> blocks;
  std::size_t trials{0}, at_end{0};  // the latter after the level changed for the first time
};

Answers answers_of(const CoverageCell& cell, Procedure& procedure, CorrelatedObserver& observer,
                   RandomStream& random) {
  Answers found;
  const double first = procedure.next()[0];
  bool changed = false;
  while (!procedure.finished()) {
    const Level level = procedure.next();
    const int answer = observer.answer(level[0]);
    found.blocks.push_back({level[0], answer, 1});
    procedure.report(answer, level);
    changed = changed || level[0] != first;
    found.at_end += changed && std::abs(level[0]) > kEnd - 1e-9 ? 1U : 0U;
    ++found.trials;
  }
  found.at_end = changed ? found.at_end : found.trials;
  if (cell.alternatives == 1) {
    TrialBlock catches{kNoStimulus, 0, std::max(20, static_cast<int>(found.trials / 4))};
    for (int i = 0; i < catches.total; ++i) {
      catches.correct += random.uniform() < cell.false_alarms ? 1 : 0;
    }
    found.blocks.push_back(catches);
  }
  found.blocks = pooled(found.blocks);
  return found;
}

LikelihoodOptions grid_options(const CoverageCell& cell) {
  LikelihoodOptions options;
  const double guess = cell.alternatives == 1 ? 0.0 : 1.0 / cell.alternatives;
  options.function = gaussian(0.0, 1.0, 0.0, guess);
  options.task = cell.alternatives == 1 ? Task::kYesNo : Task::kForcedChoice;
  options.lapse.high = 0.2;
  options.guess.high = kLargestRate;
  if (cell.procedure != "listed") {
    options.presentable = SearchBounds{-kEnd, kEnd};
  }
  return options;
}

/// The share of observers with the fitted function whose deviance is as large.
double deviance_p(const std::vector<TrialBlock>& blocks, const LikelihoodOptions& options,
                  RandomStream& random) {
  constexpr int kDraws = 199;
  const LikelihoodFitter fitter(options, blocks);
  const auto function = fitter.function(likelihood_fit(blocks, options).parameters);
  const double own = deviance_of(function, blocks).deviance;
  AnswerDraws draws(blocks, function);
  std::vector<int> correct(blocks.size());
  std::vector<TrialBlock> drawn = blocks;
  int larger = 1;
  for (int i = 0; i < kDraws; ++i) {
    draws.draw(random, correct);
    for (std::size_t b = 0; b < drawn.size(); ++b) {
      drawn[b].correct = correct[b];
    }
    const auto refit = fitter.function(fitter.fit(correct).parameters);
    larger += deviance_of(refit, drawn).deviance >= own ? 1 : 0;
  }
  return static_cast<double>(larger) / (kDraws + 1);
}

void count_interval(CoverageCount& counts, const ProfileInterval& interval, double truth) {
  ++counts.stated;
  counts.held += interval.holds(truth) ? 1 : 0;
  counts.open += interval.low_open || interval.high_open ? 1 : 0;
}

/// The interval of a procedure's own estimate, as a report states it.
std::optional<ProfileInterval> own_interval(const CoverageCell& cell, const Procedure& procedure,
                                            const Answers& answers,
                                            const LikelihoodOptions& options, std::uint64_t seed) {
  const auto estimates = procedure.estimates();
  if (!estimates.empty() && estimates[0].interval) {
    const auto [low, high] = *estimates[0].interval;
    return ProfileInterval{low, high, std::isinf(low), std::isinf(high)};
  }
  if (estimates.empty() || !estimates[0].remark.empty() || 10 * answers.at_end > answers.trials) {
    return std::nullopt;
  }
  const auto draws = adaptive_posterior(answers.blocks, options, 0.95, kPosteriorDraws).draws;
  const auto interval =
      track_interval({estimates[0], answers.trials, true, [&] { return begin(cell, seed); }},
                     options.function, draws, seed);
  return interval ? std::optional(ProfileInterval{interval->low, interval->high}) : std::nullopt;
}

struct ObserverCounts {
  CoverageCount fit, own;
};

ObserverCounts counts_of_observer(const CoverageCell& cell, std::uint64_t seed) {
  RandomStream random(seed, "coverage/grid");
  const double sigma = 0.7 * std::pow(2.0, random.uniform());
  const double inside = random.uniform(-1.0, 1.0);
  const double threshold = cell.place == 0 ? inside : kEnd + (cell.place == 2 ? 2.0 * sigma : 0.0);
  const auto truth = gaussian(threshold, sigma, cell.lapse,
                              cell.alternatives == 1 ? cell.false_alarms : 1.0 / cell.alternatives);
  CorrelatedObserver observer(truth, cell.correlation, random);
  const auto procedure = begin(cell, seed);
  const Answers answers = answers_of(cell, *procedure, observer, random);
  const LikelihoodOptions options = grid_options(cell);
  ObserverCounts counts{{.observers = 1}, {.observers = 1}};
  const auto presented = std::ranges::count_if(
      answers.blocks, [](const TrialBlock& block) { return block.level != kNoStimulus; });
  if (presented < 2) {
    return counts;
  }
  const bool adaptive = cell.procedure != "listed";
  const double p = adaptive ? 1.0 : deviance_p(answers.blocks, options, random);
  const StatedFit fit = stated_fit(answers.blocks, options, adaptive, p);
  if (fit.told && fit.no_interval.empty()) {
    count_interval(counts.fit, fit.threshold, threshold);
  }
  const std::optional<double> target = procedure->target();
  if (const auto own = own_interval(cell, *procedure, answers, options, seed);
      own && (!target || (*target > truth.guess && *target < 1.0 - truth.lapse))) {
    count_interval(counts.own, *own,
                   target ? PsychometricFunction(truth).x_for(*target) : threshold);
  }
  return counts;
}

void add_counts(CoverageCount& sum, const CoverageCount& one) {
  sum.observers += one.observers;
  sum.stated += one.stated;
  sum.held += one.held;
  sum.open += one.open;
}

}  // namespace

std::vector<CoverageCell> coverage_cells() {
  std::vector<CoverageCell> cells;
  for (const char* procedure : {"listed", "staircase", "PEST", "Psi", "QUEST+"}) {
    for (const int alternatives : {1, 2, 4}) {
      const CoverageCell usual{procedure, alternatives};
      for (const int place : {0, 1, 2}) {
        cells.push_back(usual);
        cells.back().place = place;
      }
      for (const double lapse : {0.0, 0.1, 0.15}) {
        cells.push_back(usual);
        cells.back().lapse = lapse;
      }
      for (const double rate : {0.0, 0.15, 0.3}) {
        if (alternatives == 1) {
          cells.push_back(usual);
          cells.back().false_alarms = rate;
        }
      }
      cells.push_back(usual);
      cells.back().correlation = 0.05;
    }
  }
  return cells;
}

CellCounts count_coverage(const CoverageCell& cell, int observers, int threads) {
  std::vector<ObserverCounts> all(static_cast<std::size_t>(observers));
  parallel_for(all.size(), threads, [&](std::size_t i) { all[i] = counts_of_observer(cell, i); });
  CellCounts counts;
  for (const ObserverCounts& one : all) {
    add_counts(counts.fit, one.fit);
    add_counts(counts.own, one.own);
  }
  return counts;
}

}  // namespace haptrial::test
