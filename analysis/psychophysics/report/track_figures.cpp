#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/document/palette.h"
#include "analysis/psychophysics/report/report_surfaces.h"
#include "analysis/psychophysics/report/trials_figures.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::trials {
namespace {

constexpr Look kReversal{palette::kBlack, palette::kSolid, 6, 1.6, 1.7};
constexpr int kFilled = 7, kOpen = 6;  // points of the answers 1 and 0
constexpr std::size_t kPanels = 12;    // of a figure
constexpr double kPanelWidth = 0.85;   // of the place of a panel

/// A dotted line over a track's trials at its own estimate, if that is of one variable.
Series estimate_of(const TrackEstimate& track, const Series& line, Look look) {
  look.dash = "(2,4)";
  look.width = 1.2;
  Series series{"", Mark::kSegments, look};
  if (track.estimates.size() == 1 && !line.x.empty()) {
    const double value = track.estimates.front().value;
    series.x = {line.x.front()};
    series.x2 = {line.x.back()};
    series.y = series.y2 = {value};
  }
  return series;
}

/// Adds a track to the panel at `place`. @param steps  that fill the width of a panel
void add_panel(const TrackEstimate& track, double place, std::size_t steps, Figure& figure) {
  Look look = look_of(0);
  look.width = 1.0;
  Series line{"", Mark::kLine, look};
  Series ones{"", Mark::kPoints, look};
  ones.look.point = kFilled;
  ones.look.point_size = 0.35;
  Series zeros = ones;
  zeros.look.point = kOpen;
  zeros.look.point_size = 0.6;
  for (std::size_t i = 0; i < track.steps.size(); ++i) {
    const TrackStep& step = track.steps[i];
    const double part =
        static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(1, steps - 1));
    line.x.push_back(place + kPanelWidth * (part - 0.5));
    line.y.push_back(step.applied);
    Series& answers = step.outcome == 0.0 ? zeros : ones;
    answers.x.push_back(line.x.back());
    answers.y.push_back(step.applied);
  }
  for (const Series& each : {line, ones, zeros, estimate_of(track, line, look_of(1))}) {
    if (!each.x.empty()) {
      figure.series.push_back(each);
    }
  }
}

/// The tracks of one name, in figures of kPanels.
void add_panels(const TrialsResult& result, const std::vector<const TrackEstimate*>& tracks,
                std::vector<Figure>& figures) {
  std::size_t steps = 1;
  for (const TrackEstimate* track : tracks) {
    steps = std::max(steps, track->steps.size());
  }
  for (std::size_t first = 0; first < tracks.size(); first += kPanels) {
    const std::string& name = tracks.front()->track;
    const std::size_t count = std::min(kPanels, tracks.size() - first);
    Figure figure =
        new_figure(result,
                   fmt::format("panel-{}{}", file_word(name),
                               first == 0 ? "" : fmt::format("-{}", first / kPanels + 1)),
                   "Tracks of all participants: " + name, "", level_label(result));
    for (std::size_t i = 0; i < count; ++i) {
      const double place = static_cast<double>(i + 1);
      figure.x_names.emplace_back(place, tracks[first + i]->participant);
      add_panel(*tracks[first + i], place, steps, figure);
    }
    figure.x_range = Range{0.4, static_cast<double>(std::max<std::size_t>(count, 4)) + 0.6};
    figure.height = 0.4;
    figure.caption = fmt::format(
        "The levels that were presented, a panel for each participant; a whole panel is as wide as "
        "the longest track, {}. Filled if the procedure learnt a 1 (a right answer), open if it "
        "learnt a 0; dotted: the procedure's own estimate.",
        counted(steps, "trial"));
    figure.alt = fmt::format("{} beside each other.", counted(count, "track"));
    figures.push_back(std::move(figure));
  }
}

}  // namespace

std::vector<Figure> track_figures(const TrialsResult& result) {
  std::vector<Figure> figures;
  for (const ParticipantTrials& person : drawn_participants(result)) {
    Figure figure = new_figure(result, "tracks-" + file_word(person.participant),
                               "Tracks of " + person.participant, "Trial", level_label(result));
    Series reversals{"reversal", Mark::kPoints, kReversal};
    std::size_t tracks = 0;
    bool estimated = false;
    for (const TrackEstimate& track : result.tracks) {
      if (track.participant != person.participant || !track.adaptive) {
        continue;
      }
      Series line{track.track, Mark::kLine, look_of(tracks)};
      Series ones{"", Mark::kPoints, look_of(tracks)};
      ones.look.point = kFilled;
      ones.look.point_size = 0.8;
      Series zeros = ones;
      zeros.look.point = kOpen;
      zeros.look.point_size = 1.1;
      for (const TrackStep& step : track.steps) {
        const double x = result.data.trials[step.trial].trial;
        line.x.push_back(x);
        line.y.push_back(step.applied);
        Series& answers = step.outcome == 0.0 ? zeros : ones;
        answers.x.push_back(x);
        answers.y.push_back(step.applied);
        if (step.reversal) {
          reversals.x.push_back(x);
          reversals.y.push_back(step.applied);
        }
      }
      const Series estimate = estimate_of(track, line, look_of(tracks));
      ++tracks;
      estimated = estimated || !estimate.x.empty();
      for (const Series& each : {line, ones, zeros, estimate}) {
        if (!each.x.empty()) {
          figure.series.push_back(each);
        }
      }
    }
    figure.caption =
        "The level that was presented in each trial: filled if the procedure learnt a 1 (a right "
        "answer), open if it learnt a 0.";
    if (estimated) {
      figure.caption += " Dotted: the procedure's own estimate.";
    }
    if (!reversals.x.empty()) {
      figure.caption += " Circles: reversals.";
      figure.series.push_back(std::move(reversals));
    }
    figure.alt = fmt::format("{} of {}.", counted(tracks, "track"), person.participant);
    if (tracks > 0) {
      figures.push_back(std::move(figure));
    }
  }
  return figures;
}

std::vector<Figure> panel_figures(const TrialsResult& result) {
  std::map<std::string, std::vector<const TrackEstimate*>> by_name;
  const std::span<const ParticipantTrials> drawn = drawn_participants(result);
  for (const TrackEstimate& track : result.tracks) {
    const bool is_drawn = std::ranges::any_of(drawn, [&](const ParticipantTrials& person) {
      return person.participant == track.participant;
    });
    if (track.adaptive && !track.steps.empty() && is_drawn) {
      by_name[track.track].push_back(&track);
    }
  }
  std::vector<Figure> figures;
  for (const auto& [name, tracks] : by_name) {
    if (tracks.size() > 1) {
      add_panels(result, tracks, figures);
    }
  }
  return figures;
}

namespace {

constexpr Look kMiddle{palette::kBlue, palette::kSolid, 7, 2.5, 1.0};
constexpr Look kBand{palette::kBlue, palette::kShort, 7, 1.2, 1.0};
constexpr Look kOne{palette::kBlack, palette::kSolid, 7, 1.0, 0.7};
constexpr Look kZero{palette::kOrange, palette::kSolid, 6, 1.2, 0.9};

Series pieces(const char* label, const Look& look, const std::vector<Segment>& segments) {
  Series series{label, Mark::kSegments, look};
  for (const auto& [from, to] : segments) {
    series.x.push_back(from.first);
    series.y.push_back(from.second);
    series.x2.push_back(to.first);
    series.y2.push_back(to.second);
  }
  return series;
}

/// Adds, at each place, an open circle for all its trials and a disc for those with the answer 1,
/// with areas as their numbers.
void add_answers(Figure& figure, const SurfaceCondition& one) {
  std::map<std::pair<double, double>, std::pair<int, int>> places;  // answers 1, all
  int most = 1;
  for (const SurfaceTrial& trial : one.trials) {
    auto& [ones, all] = places[{trial.stimulus[0], trial.stimulus[1]}];
    ones += trial.outcome == 1 ? 1 : 0;
    most = std::max(most, ++all);
  }
  const auto add = [&](const char* label, Look look, const std::pair<double, double>& place,
                       int count) {
    constexpr double kLargest = 3.0;  // of a place with the most trials
    look.point_size = kLargest * std::sqrt(static_cast<double>(count) / most);
    figure.series.push_back({label, Mark::kPoints, look, {place.first}, {place.second}});
  };
  bool first = true;
  for (const auto& [place, counts] : places) {
    add(first ? "all trials" : "", kZero, place, counts.second);
    if (counts.first > 0) {
      add(first ? "answer 1" : "", kOne, place, counts.first);
    }
    first = false;
  }
}

Figure figure_of(const TrialsResult& result, const SurfaceCondition& one) {
  Figure figure;
  figure.name = "surface-" + file_word(one.participant) + "-" + file_word(one.track) +
                (one.condition.empty() ? "" : "-" + file_word(one.condition));
  figure.title = fmt::format("Threshold of {}{}{}", one.participant,
                             one.condition.empty() ? "" : ", ", one.condition);
  const std::string& unit = result.plan.function.axis.unit;
  const std::string in_unit = unit.empty() ? "" : " (" + unit + ")";
  figure.x_label = one.variables[0] + (one.shares_unit ? in_unit : "");
  figure.y_label = one.variables[1] + in_unit;
  figure.simulated = result.simulated();
  add_answers(figure, one);
  figure.series.push_back(pieces("threshold", kMiddle, one.contour->middle));
  figure.series.push_back(pieces("95 %", kBand, one.contour->sure));
  figure.series.push_back(pieces("", kBand, one.contour->hardly));
  std::erase_if(figure.series, [](const Series& s) { return s.x.empty(); });
  const std::string after = unit.empty() ? "" : " " + unit;
  for (const ContourPoint& point : one.points) {
    if (point.second.size() == 1) {
      figure.alt += fmt::format("{}{}{} at {} {:.4g}{}", figure.alt.empty() ? "" : "; ",
                                number(point.second.front()), after, one.variables[0], point.first,
                                one.shares_unit ? after : "");
    }
  }
  figure.caption = fmt::format(
      "Line: where the probability of the answer 1 is {:g} %; dashed: its 95 % band, point by "
      "point. Circles: the trials at each place; discs: those with the answer 1; areas as their "
      "numbers.",
      100.0 * one.share);
  return figure;
}

}  // namespace

std::vector<Figure> surface_figures(const TrialsResult& result) {
  std::vector<Figure> figures;
  for (const SurfaceCondition& one : result.surfaces) {
    if (one.contour && one.no_contour.empty()) {
      figures.push_back(figure_of(result, one));
    }
  }
  return figures;
}

}  // namespace haptrial::analysis::trials
