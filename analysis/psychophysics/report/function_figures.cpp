#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/psychophysics/report/trials_figures.h"
#include "analysis/psychophysics/report/trials_words.h"

namespace haptrial::analysis::trials {
namespace {

constexpr int kCurvePoints = 120;

/// All but the catch trials, which have no level.
std::vector<TrialBlock> presented(const FunctionFit& fit) {
  std::vector<TrialBlock> blocks = fit.blocks;
  std::erase_if(blocks, [](const TrialBlock& block) { return block.level == kNoStimulus; });
  return blocks;
}

/// Lowest and highest level that the answers and the readings of a function have.
Range levels_of(const std::vector<const FunctionFit*>& fits) {
  Range range{INFINITY, -INFINITY};
  for (const FunctionFit* fit : fits) {
    for (const TrialBlock& block : presented(*fit)) {
      range.first = std::min(range.first, block.level);
      range.second = std::max(range.second, block.level);
    }
  }
  return range;
}

/// A share of the answers at a level, and of how many.
struct Share {
  double level{0.0}, share{0.0};
  int total{0};
};

/// Shares of the answers. Levels of an adaptive procedure hold few trials each, so neighbours are
/// put together until there are at least a tenth of the trials, or five.
std::vector<Share> shares_of(const FunctionFit& fit) {
  std::vector<Share> shares;
  const int enough = std::max(5, static_cast<int>(fit.trials) / 10);
  double levels = 0.0;
  int correct = 0, total = 0;
  const auto flush = [&] {
    if (total > 0) {
      shares.push_back({levels / total, static_cast<double>(correct) / total, total});
    }
    levels = 0.0;
    correct = total = 0;
  };
  for (const TrialBlock& block : presented(fit)) {
    levels += block.level * block.total;
    correct += block.correct;
    total += block.total;
    if (total >= enough) {
      flush();
    }
  }
  flush();
  return shares;
}

/// Points whose areas are as the numbers of their trials.
void add_shares(Figure& figure, const FunctionFit& fit, const Look& look) {
  const std::vector<Share> shares = shares_of(fit);
  int most = 1;
  for (const Share& share : shares) {
    most = std::max(most, share.total);
  }
  std::map<int, Series> by_total;
  for (const Share& share : shares) {
    constexpr double kLargest = 1.4, kSmallest = 0.4;
    Series& points =
        by_total.try_emplace(share.total, Series{"", Mark::kPoints, look}).first->second;
    points.look.point_size =
        std::max(kSmallest, kLargest * std::sqrt(static_cast<double>(share.total) / most));
    points.x.push_back(share.level);
    points.y.push_back(share.share);
  }
  for (auto& [total, points] : by_total) {
    figure.series.push_back(std::move(points));
  }
}

Series curve_series(const FunctionFit& fit, const TrialsPlan& plan, const Range& range,
                    const Look& look) {
  Series curve{fit.condition.empty() ? method_of(fit) : fit.condition, Mark::kLine, look};
  const auto function = fit.function(plan);
  for (int i = 0; i < kCurvePoints; ++i) {
    const double level =
        range.first + (range.second - range.first) * static_cast<double>(i) / (kCurvePoints - 1);
    if (std::isfinite(plan.function.axis.at(level))) {
      curve.x.push_back(level);
      curve.y.push_back(function(level));
    }
  }
  return curve;
}

/// The band's edges: intervals of the level at which each share is reached.
void add_band(Figure& figure, const FunctionFit& fit, const TrialsPlan& plan, const Range& range,
              Look look, bool first) {
  look.width = 1.0;
  look.dash = "(3,3)";
  const auto p = fit.function(plan).parameters();
  for (const bool high : {false, true}) {
    const bool labelled = !high && first;
    Series edge{labelled ? "95 % of the level" : "", Mark::kLine, look};
    for (const BandPoint& point : fit.band) {
      const double level = high ? point.level.high : point.level.low;
      if (std::isfinite(level) && level >= range.first && level <= range.second) {
        edge.x.push_back(level);
        edge.y.push_back(p.guess + (1.0 - p.guess - p.lapse) * point.share);
      }
    }
    if (edge.x.size() > 1) {
      figure.series.push_back(std::move(edge));
    }
  }
}

/// The axis of the shares: answers are right or wrong only in a forced choice.
std::string share_label(const TrialsPlan& plan) {
  if (!plan.yes.empty()) {
    return "Proportion \"" + plan.yes + "\"";
  }
  return plan.task() == Task::kForcedChoice ? "Proportion correct" : "Proportion of answers 1";
}

/// Lines at the guess rate and from the threshold down.
void add_marks(Figure& figure, const FunctionFit& fit, const TrialsPlan& plan, const Range& range,
               Look look, bool first) {
  look.width = 1.0;
  look.dash = "(8,5)";
  const auto function = fit.function(plan);
  const double threshold = fit.stated->threshold.value;
  const double guess = function.parameters().guess;
  Series marks{first ? "guess rate, threshold" : "", Mark::kSegments, look};
  const auto add = [&](double x, double y, double x2, double y2) {
    marks.x.push_back(x);
    marks.y.push_back(y);
    marks.x2.push_back(x2);
    marks.y2.push_back(y2);
  };
  if (guess > 0.0) {
    add(range.first, guess, range.second, guess);
  }
  if (std::isfinite(threshold) && threshold >= range.first && threshold <= range.second) {
    add(threshold, 0.0, threshold, function(threshold));
  }
  if (!marks.x.empty()) {
    figure.series.push_back(std::move(marks));
  }
}

Figure function_figure(const TrialsResult& result, const std::vector<const FunctionFit*>& fits) {
  const std::string& participant = fits.front()->participant;
  Figure figure = new_figure(result, "function-" + file_word(participant),
                             "Psychometric function of " + participant, level_label(result),
                             share_label(result.plan));
  const Range range = levels_of(fits);
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const FunctionFit& fit = *fits[i];
    const Look look = look_of(i);
    add_shares(figure, fit, look);
    if (fit.stated) {
      figure.series.push_back(curve_series(fit, result.plan, range, look));
      add_band(figure, fit, result.plan, range, look, i == 0);
      add_marks(figure, fit, result.plan, range, look, i == 0);
    }
    figure.alt += fmt::format("{}{}: threshold {}", i == 0 ? "" : "; ",
                              series_name(participant, fit.condition),
                              fit.stated ? estimate_word(fit.stated->threshold) : "–");
  }
  figure.y_range = Range{0.0, 1.02};
  figure.caption =
      "Points: shares of the answers, neighbouring levels together where one has few trials; areas "
      "as the numbers of trials. "
      "Thin lines: 95 % intervals of the level at which each share is reached.";
  return figure;
}

/// The functions of all participants, a colour for each condition.
Figure group_figure(const TrialsResult& result) {
  Figure figure = new_figure(result, "functions", "Psychometric functions of all participants",
                             level_label(result), share_label(result.plan));
  std::vector<const FunctionFit*> fits;
  for (const FunctionFit& fit : result.fits) {
    if (fit.stated && !fit.blocks.empty()) {
      fits.push_back(&fit);
    }
  }
  const Range range = levels_of(fits);
  std::map<std::string, std::size_t> conditions;
  for (const FunctionFit* fit : fits) {
    const auto [at, fresh] = conditions.emplace(fit->condition, conditions.size());
    Look look = look_of(at->second);
    look.width = 1.2;
    Series curve = curve_series(*fit, result.plan, range, look);
    curve.label = !fresh ? "" : fit->condition.empty() ? "participant" : fit->condition;
    figure.series.push_back(std::move(curve));
  }
  figure.y_range = Range{0.0, 1.02};
  figure.caption = "The fitted function of each participant, over all levels that were presented.";
  figure.alt = fmt::format("{} fitted functions; their thresholds are in the table.", fits.size());
  return figure;
}

}  // namespace

std::vector<Figure> function_figures(const TrialsResult& result) {
  std::vector<Figure> figures;
  const auto fitted = std::ranges::count_if(
      result.fits, [](const FunctionFit& fit) { return fit.stated && !fit.blocks.empty(); });
  if (fitted > 1 && result.participants.size() > 1) {
    figures.push_back(group_figure(result));
  }
  for (const ParticipantTrials& person : drawn_participants(result)) {
    std::vector<const FunctionFit*> fits;
    for (const FunctionFit& fit : result.fits) {
      if (fit.participant == person.participant && !fit.blocks.empty()) {
        fits.push_back(&fit);
      }
    }
    if (!fits.empty()) {
      figures.push_back(function_figure(result, fits));
    }
  }
  return figures;
}

}  // namespace haptrial::analysis::trials
