#include "analysis/psychophysics/report/trials_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>

#include "analysis/document/palette.h"
#include "analysis/psychophysics/report/report_surfaces.h"
#include "analysis/psychophysics/report/trials_words.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::trials {
namespace {

constexpr Look kMean{palette::kBlack, palette::kSolid, 7, 2.5, 1.2};
constexpr Look kPerson{palette::kGrey, palette::kSolid, 6, 1.5, 0.9};

/// Median and quartiles of reaction times.
void add_times(Series& series, double place, const std::vector<double>& times) {
  const auto low = quantile(times, 0.25), middle = quantile(times, 0.5);
  const auto high = quantile(times, 0.75);
  if (low && middle && high) {
    series.x.push_back(place);
    series.y.push_back(*middle);
    series.low.push_back(*low);
    series.high.push_back(*high);
  }
}

std::map<std::string, std::vector<double>> times_of(const TrialsResult& result) {
  std::map<std::string, std::vector<double>> times;
  for (const StudyTrial& trial : result.data.trials) {
    const GivenAnswer* answer = answer_to(trial, result.plan.question);
    if (trial.counts() && answer != nullptr && std::isfinite(answer->reaction_time)) {
      times[result.data.session_of(trial).participant].push_back(answer->reaction_time);
    }
  }
  return times;
}

/// Means of a quantity, on the axis brought back to levels.
double shown(const TrialsResult& result, const Quantity& q, double value) {
  return q.on_axis ? result.plan.function.axis.level(value) : value;
}

Figure quantity_figure(const TrialsResult& result, const Quantity& q) {
  const std::string unit = unit_word(result, q);
  Figure figure =
      new_figure(result, "by-condition-" + file_word(q.name),
                 capitalized(q.title) + (result.plan.by.empty() ? "" : " by condition"), "",
                 capitalized(q.title) + (unit.empty() ? "" : " (" + unit.substr(1) + ")"));
  Series people{"participant", Mark::kPoints, kPerson};
  Series means{"mean with 95 % CI", Mark::kBars, kMean};
  const std::size_t cells = q.table.cells.size();
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double place = static_cast<double>(cell + 1);
    figure.x_names.emplace_back(place, result.plan.by.empty()
                                           ? counted(q.table.participants(cell), "participant")
                                           : q.table.names[cell]);
    const std::size_t count = q.table.means.size();
    for (std::size_t p = 0; p < count; ++p) {
      if (q.table.means[p][cell]) {
        people.x.push_back(place + 0.08 +
                           0.25 * static_cast<double>(p) / static_cast<double>(count));
        people.y.push_back(shown(result, q, *q.table.means[p][cell]));
      }
    }
    const auto mean = mean_of(q, cell);
    if (mean && q.table.participants(cell) > 1) {  // without an interval it is a point alone
      means.x.push_back(place);
      means.y.push_back(shown(result, q, *mean));
      means.low.push_back(shown(result, q, q.means[cell] ? q.means[cell]->low : *mean));
      means.high.push_back(shown(result, q, q.means[cell] ? q.means[cell]->high : *mean));
    }
    figure.alt += fmt::format("{}{}: {}", cell == 0 ? "" : "; ", figure.x_names.back().second,
                              mean_word(result, q, cell));
  }
  figure.series = {people, means};
  std::erase_if(figure.series, [](const Series& s) { return s.x.empty(); });
  figure.x_range = Range{0.5, static_cast<double>(cells) + 0.7};
  figure.caption =
      "One circle is one participant; the mean over participants with its 95 % confidence interval "
      "(Student's t).";
  return figure;
}

/// A quantity by condition, participants beside the mean: "by-condition-threshold".
std::vector<Figure> quantity_figures(const TrialsResult& result) {
  std::vector<Figure> figures;
  for (const Quantity& q : result.quantities) {
    if (!q.table.cells.empty() && q.name != "log_width") {
      figures.push_back(quantity_figure(result, q));
    }
  }
  return figures;
}

/// Magnitudes over levels, both logarithmic: "magnitudes".
std::vector<Figure> magnitude_figures(const TrialsResult& result) {
  Figure figure = new_figure(result, "magnitudes", "Magnitudes over levels",
                             "Logarithm (base 10) of " + level_label(result),
                             "Logarithm (base 10) of the magnitude");
  std::size_t conditions = 0;
  for (const MagnitudeCondition& one : result.magnitudes) {
    if (!one.law) {
      continue;
    }
    const std::string name = one.condition.empty() ? "geometric mean" : one.condition;
    Look look = look_of(conditions++);
    Series means{name, Mark::kBars, look};
    Series line{fmt::format("exponent {:.2f}", one.law->exponent), Mark::kLine, look};
    for (const MagnitudeLevel& level : one.law->levels) {
      means.x.push_back(std::log10(level.measured));
      means.y.push_back(std::log10(level.mean));
      means.low.push_back(std::log10(level.low));
      means.high.push_back(std::log10(level.high));
      line.x.push_back(means.x.back());
      line.y.push_back(std::log10(one.law->constant) + one.law->exponent * means.x.back());
    }
    figure.alt += fmt::format("{}{}: exponent {:.2f}", figure.alt.empty() ? "" : "; ", name,
                              one.law->exponent);
    figure.series.push_back(std::move(means));
    figure.series.push_back(std::move(line));
  }
  figure.caption =
      "Geometric means over participants after modulus equalisation, with 95 % intervals over "
      "participants; lines have the mean of the participants' exponents.";
  return figure.series.empty() ? std::vector<Figure>{} : std::vector{figure};
}

/// ROC curves of ratings: "roc".
std::vector<Figure> roc_figures(const TrialsResult& result) {
  Figure figure = new_figure(result, "roc", "ROC curves of the ratings", "Share of noise trials",
                             "Share of signal trials");
  std::map<std::string, std::size_t> conditions;
  for (const DetectedCondition& one : result.detected) {
    if (!one.roc) {
      continue;
    }
    const auto [at, fresh] = conditions.emplace(one.condition, conditions.size());
    Look look = look_of(at->second);
    look.width = 1.2;
    const std::string label = one.condition.empty() ? "participant" : one.condition;
    Series curve{fresh ? label : "", Mark::kLine, look};
    for (const RocPoint& point : one.roc->curve) {
      curve.x.push_back(point.false_positives);
      curve.y.push_back(point.true_positives);
    }
    figure.series.push_back(std::move(curve));
  }
  if (figure.series.empty()) {
    return {};
  }
  figure.series.push_back(
      {"", Mark::kLine, {palette::kGrey, palette::kShort, 7, 1.5, 1.0}, {0.0, 1.0}, {0.0, 1.0}});
  figure.x_range = Range{0.0, 1.0};
  figure.y_range = Range{0.0, 1.02};
  figure.height = 0.75;
  figure.caption = "A curve for each participant. The diagonal is chance.";
  figure.alt = "ROC curves; their areas are in the table.";
  return {figure};
}

/// Reaction times of each participant: "reaction-times".
std::vector<Figure> reaction_figures(const TrialsResult& result) {
  Figure figure =
      new_figure(result, "reaction-times", "Reaction times", "Participant", "Reaction time (s)");
  Series series{"median, lower and upper quartile", Mark::kBars, look_of(0)};
  const auto times = times_of(result);
  const std::size_t named_every = 1 + times.size() / 16;  // names beside each other have room
  std::size_t place = 0;
  for (const auto& [participant, own] : times) {
    if (place++ % named_every == 0) {
      figure.x_names.emplace_back(static_cast<double>(place), participant);
    }
    add_times(series, static_cast<double>(place), own);
  }
  if (series.x.empty()) {
    return {};
  }
  figure.x_range = Range{0.5, static_cast<double>(place) + 0.5};
  figure.y_range = Range{0.0, 1.1 * *std::max_element(series.high.begin(), series.high.end())};
  figure.series.push_back(std::move(series));
  figure.caption = "Medians and quartiles of the reaction times of each participant.";
  figure.alt = "Reaction times of each participant.";
  return {figure};
}

}  // namespace

Look look_of(std::size_t index) {
  constexpr std::array<Look, 4> kLooks{{{palette::kBlue, palette::kSolid, 7, 2.0, 0.9},
                                        {palette::kOrange, palette::kLong, 5, 2.0, 0.9},
                                        {palette::kGreen, palette::kShort, 9, 2.0, 1.1},
                                        {palette::kPurple, palette::kMixed, 13, 2.0, 1.1}}};
  return kLooks[index % kLooks.size()];
}

std::string file_word(const std::string& name) {
  std::string word;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    word += u < 0x80 && (std::isalnum(u) != 0 || c == '-' || c == '_') ? c : '_';
  }
  return word;
}

Figure new_figure(const TrialsResult& result, std::string name, std::string title,
                  std::string x_label, std::string y_label) {
  Figure figure;
  figure.name = std::move(name);
  figure.title = std::move(title);
  figure.x_label = std::move(x_label);
  figure.y_label = std::move(y_label);
  figure.simulated = result.simulated();
  return figure;
}

std::string level_label(const TrialsResult& result) {
  std::string name = result.plan.level;
  for (const TrackEstimate& track : result.tracks) {
    name = name.empty() ? track.variable : name;
  }
  const std::string& unit = result.plan.function.axis.unit;
  return capitalized(name.empty() ? "level" : name) + (unit.empty() ? "" : " (" + unit + ")");
}

std::span<const ParticipantTrials> drawn_participants(const TrialsResult& result) {
  const std::span<const ParticipantTrials> all(result.participants);
  return all.first(std::min(all.size(), kMostDrawn));
}

std::vector<Figure> trials_figures(const TrialsResult& result) {
  std::vector<Figure> all;
  for (auto make :
       {cue_figures, quantity_figures, surface_figures, function_figures, magnitude_figures,
        roc_figures, panel_figures, track_figures, reaction_figures, reaching_pictures}) {
    std::vector<Figure> some = make(result);
    std::move(some.begin(), some.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace haptrial::analysis::trials
