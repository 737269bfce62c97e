#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/trials/report/trials_figures.h"
#include "analysis/trials/report/trials_words.h"

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

/// Shares of the answers. Levels of an adaptive procedure hold few trials each, so neighbours are
/// put together until there are at least a tenth of the trials, or five.
Series data_series(const FunctionFit& fit, const Look& look) {
  Series series{"", Mark::kPoints, look};
  const int enough = std::max(5, static_cast<int>(fit.trials) / 10);
  double levels = 0.0;
  int correct = 0, total = 0;
  const auto flush = [&] {
    if (total > 0) {
      series.x.push_back(levels / total);
      series.y.push_back(static_cast<double>(correct) / total);
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
  return series;
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
              Look look) {
  look.width = 1.0;
  look.dash = "(3,3)";
  const auto p = fit.function(plan).parameters();
  for (const bool high : {false, true}) {
    const bool labelled = !high && figure.series.size() == 2;  // the first function's
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
               Look look) {
  look.width = 1.0;
  look.dash = "(8,5)";
  const auto function = fit.function(plan);
  const double threshold = fit.stated->threshold.value;
  const double guess = function.parameters().guess;
  Series marks{figure.series.size() < 5 ? "guess rate, threshold" : "", Mark::kSegments, look};
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
    figure.series.push_back(data_series(fit, look));
    if (fit.stated) {
      figure.series.push_back(curve_series(fit, result.plan, range, look));
      add_band(figure, fit, result.plan, range, look);
      add_marks(figure, fit, result.plan, range, look);
    }
    figure.alt += fmt::format("{}{}: threshold {}", i == 0 ? "" : "; ",
                              series_name(participant, fit.condition),
                              fit.stated ? estimate_word(fit.stated->threshold) : "–");
  }
  figure.y_range = Range{0.0, 1.02};
  figure.caption =
      "Points: shares of the answers, neighbouring levels together where one has few trials. "
      "Thin lines: 95 % intervals of the level at which each share is reached.";
  return figure;
}

}  // namespace

std::vector<Figure> function_figures(const TrialsResult& result) {
  std::vector<Figure> figures;
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
