#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/document/palette.h"
#include "analysis/psychophysics/report/trials_figures.h"
#include "analysis/psychophysics/report/trials_findings.h"
#include "analysis/psychophysics/report/trials_report.h"
#include "analysis/psychophysics/report/trials_words.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::trials {
namespace {

using Rows = std::vector<std::vector<std::string>>;
using Number = Estimated CuePerson::*;

constexpr Look kObserved{palette::kBlack, palette::kSolid, 7, 2.5, 1.2};
constexpr Look kPredicted{palette::kBlue, palette::kLong, 5, 2.0, 1.1};
constexpr Look kFirst{palette::kGreen, palette::kShort, 9, 2.0, 1.1};
constexpr Look kSecond{palette::kOrange, palette::kMixed, 13, 2.0, 1.1};
constexpr Look kOnePerson{palette::kGrey, palette::kSolid, 6, 1.5, 0.9};

/// Values that are compared at each level, as the figures need them.
struct Drawn {
  std::string label;
  Number number;
  Look look;
  double shift;  // beside the level's place
};

std::string level_word(const CueLevel& level) { return level.level.empty() ? "all" : level.level; }

std::string unit_heading(const TrialsResult& result, const std::string& text) {
  const std::string unit = result.plan.function.axis.x_unit();
  return unit.empty() ? text : fmt::format("{} ({})", text, unit);
}

std::string interval_of(const CueTest& test, bool ratio) {
  if (!test.test) {
    return "not defined, because " + test.test.because();
  }
  const auto shown = [&](double value) { return ratio ? std::exp(value) : value; };
  return estimate_word(
      {shown(test.test->difference), shown(test.test->low), shown(test.test->high)});
}

void add_weights(Document& document, const TrialsResult& result, const std::string& at) {
  Rows rows;
  for (const CueLevel& level : result.cues->levels) {
    rows.push_back({level_word(level), std::to_string(level.people.size()),
                    estimate_word(mean_of(level, &CuePerson::weight, false)),
                    estimate_word(mean_of(level, &CuePerson::predicted_weight, false)),
                    interval_of(level.weight, false), t_result(level.weight.test),
                    p_result(level.weight.holm)});
  }
  document.table(
      {at, "participants",
       "weight of " + name_of_cue(result.plan.cues->first) + ", observed [95 %]",
       "predicted [95 %]", "observed less predicted [95 %]", "paired t-test", "p after Holm"},
      rows);
}

void add_deviations(Document& document, const TrialsResult& result, const std::string& at) {
  const CuePlan& cues = *result.plan.cues;
  Rows rows, tests;
  for (const CueLevel& level : result.cues->levels) {
    std::vector<std::string> row{level_word(level)};
    for (const Number number : {&CuePerson::first_sd, &CuePerson::second_sd, &CuePerson::both_sd,
                                &CuePerson::predicted_sd}) {
      row.push_back(estimate_word(mean_of(level, number, true)));
    }
    rows.push_back(row);
    tests.push_back({level_word(level), interval_of(level.log_sd, true),
                     t_result(level.log_sd.test), p_result(level.log_sd.holm),
                     interval_of(level.beats_best, true), t_result(level.beats_best.test),
                     p_result(level.beats_best.holm)});
  }
  document.table({at, unit_heading(result, "σ of " + name_of_cue(cues.first) + " [95 %]"),
                  "σ of " + name_of_cue(cues.second) + " [95 %]",
                  "σ of " + name_of_cue(cues.both) + ", observed [95 %]", "predicted [95 %]"},
                 rows);
  document.table({at, "σ observed / predicted [95 %]", "paired t-test of logarithms",
                  "p after Holm", "σ observed / σ of the better cue alone [95 %]",
                  "paired t-test of logarithms, one-tailed", "p after Holm"},
                 tests);
}

void add_people(Document& document, const TrialsResult& result) {
  FindingTable all;
  for (const CueLevel& level : result.cues->levels) {
    FindingTable table = cue_findings(result, level);
    all.title = table.title;
    std::ranges::move(table.rows, std::back_inserter(all.rows));
  }
  add_table(document, all, true);
}

Figure cue_figure(const TrialsResult& result, const char* name, const std::string& title,
                  const std::string& y_label, const std::vector<Drawn>& drawn, Number of_people) {
  const std::string& at = result.plan.cues->at;
  Figure figure = new_figure(result, name, title, capitalized(at), y_label);
  const bool geometric = of_people != &CuePerson::weight;
  Series people{"participant, observed", Mark::kPoints, kOnePerson};
  std::vector<Series> means;
  for (const Drawn& each : drawn) {
    means.push_back({each.label, Mark::kLinkedBars, each.look});
  }
  double place = 0.0;
  for (const CueLevel& level : result.cues->levels) {
    figure.x_names.emplace_back(++place, level_word(level));
    for (std::size_t i = 0; i < level.people.size(); ++i) {
      people.x.push_back(place + 0.2 +
                         0.2 * static_cast<double>(i) / static_cast<double>(level.people.size()));
      people.y.push_back((level.people[i].*of_people).value);
    }
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const Estimated mean = mean_of(level, drawn[i].number, geometric);
      if (std::isfinite(mean.low)) {
        means[i].x.push_back(place + drawn[i].shift);
        means[i].y.push_back(mean.value);
        means[i].low.push_back(mean.low);
        means[i].high.push_back(mean.high);
      }
      figure.alt += fmt::format("{}{}, {}: {}", figure.alt.empty() ? "" : "; ", level_word(level),
                                drawn[i].label, estimate_word(mean));
    }
  }
  figure.series.push_back(std::move(people));
  std::move(means.begin(), means.end(), std::back_inserter(figure.series));
  std::erase_if(figure.series, [](const Series& s) { return s.x.empty(); });
  figure.x_range = Range{0.5, place + 0.6};
  return figure;
}

}  // namespace

void add_cues(Document& document, const TrialsResult& result,
              const std::vector<Drawing>& drawings) {
  const CuePlan& cues = *result.plan.cues;
  const std::string first = name_of_cue(cues.first), second = name_of_cue(cues.second);
  add_section(document, result, "Combination of cues");
  if (result.cues->levels.empty()) {
    document.paragraph(fmt::format("There are no answers of {}, so nothing can be compared.",
                                   name_of_cue(cues.both)));
    return;
  }
  document.paragraph(fmt::format(
      "Whether {} and {} are combined with the least variance (Ernst and Banks 2002). σ is the "
      "standard deviation of a fitted function, the distance from a share of 50 % to one of 84 %; "
      "that of {} is the geometric mean over {}. The weight of {} is the slope of the level of "
      "equality over the difference of what the cues of {} show. Predicted is what the functions "
      "of one cue alone give, corrected by what simulated answers in the same numbers at the same "
      "levels show: fits of few answers are a little too steep.",
      first, second, name_of_cue(cues.both), cues.conflict, first, cues.standard));
  add_pictures(document, drawings, "cues-", 2);
  const std::string at = cues.at.empty() ? "condition" : cues.at;
  add_weights(document, result, at);
  add_deviations(document, result, at);
  document.paragraph(
      "Means over participants (geometric of σ) with 95 % intervals; p values of each of the three "
      "tests are adjusted together over the rows. Of two estimated cues the better one looks "
      "better "
      "than it is, so that the last test finds too little rather than too much.");
  if (std::ranges::any_of(result.cues->levels,
                          [](const CueLevel& level) { return !level.left_out.empty(); })) {
    document.paragraph(
        "Those left out below for lack of a function are mostly people whose function is too steep "
        "to be told from their answers, so that the means over the others show standard deviations "
        "that are too large.");
  }
  for (const CueLevel& level : result.cues->levels) {
    for (const std::string& who : level.left_out) {
      document.paragraph(fmt::format(
          "Left out{}: {}.",
          level.level.empty() ? "" : fmt::format(" at {} {}", cues.at, level.level), who));
    }
  }
  add_people(document, result);
}

std::vector<Figure> cue_figures(const TrialsResult& result) {
  const auto nobody = [](const CueLevel& level) { return level.people.empty(); };
  if (!result.cues || std::all_of(result.cues->levels.begin(), result.cues->levels.end(), nobody)) {
    return {};
  }
  const CuePlan& cues = *result.plan.cues;
  const std::string first = name_of_cue(cues.first);
  Figure weights = cue_figure(result, "cues-weights", "Weight of " + first, "Weight of " + first,
                              {{"predicted", &CuePerson::predicted_weight, kPredicted, -0.06},
                               {"observed", &CuePerson::weight, kObserved, 0.06}},
                              &CuePerson::weight);
  Figure deviations =
      cue_figure(result, "cues-deviations", "Standard deviations of one cue and of both",
                 unit_heading(result, "Standard deviation"),
                 {{first + " alone", &CuePerson::first_sd, kFirst, -0.12},
                  {name_of_cue(cues.second) + " alone", &CuePerson::second_sd, kSecond, -0.06},
                  {"predicted of both", &CuePerson::predicted_sd, kPredicted, 0.0},
                  {"observed of both", &CuePerson::both_sd, kObserved, 0.06}},
                 &CuePerson::both_sd);
  weights.caption =
      "Means over participants with their 95 % confidence intervals (Student's t); one circle is "
      "one participant's observed weight.";
  deviations.caption =
      "Geometric means over participants with their 95 % confidence intervals (Student's t); one "
      "circle is one participant's standard deviation with both cues.";
  return {weights, deviations};
}

}  // namespace haptrial::analysis::trials
