#include "analysis/psychophysics/report/report_times.h"

#include <fmt/format.h>

#include "analysis/psychophysics/study/detected.h"

namespace haptrial::analysis::trials {
namespace {

void add_count(FindingRow& row, const char* name, const char* title, std::size_t count) {
  row.push_back({.name = name, .title = title, .value = count, .form = JsonForm::kPlain});
}

void add_time_word(FindingRow& row, const std::string& name, const char* title,
                   const std::string& word, JsonForm form) {
  row.push_back({.name = name, .title = title, .value = word, .form = form});
}

void add_number(FindingRow& row, const char* name, const char* title,
                const Defined<double>& value) {
  Finding& made = row.emplace_back(
      Finding{.name = name, .title = title, .unit = "s", .csv = name, .form = JsonForm::kPlain});
  if (value) {
    made.value = *value;
  } else {
    made.why_not = value.because();
  }
}

void add_coefficient(FindingRow& row, const char* name, const char* title, const std::string& unit,
                     const Defined<Regression>& line, std::size_t which) {
  if (!line) {
    row.push_back({.name = name, .title = title, .why_not = line.because()});
    return;
  }
  const Coefficient& c = line->coefficients[which];
  row.push_back({.name = name,
                 .title = title,
                 .value = c.estimate,
                 .low = c.low,
                 .high = c.high,
                 .unit = unit,
                 .csv = name,
                 .form = JsonForm::kEstimate});
}

void add_share(FindingRow& row, const TimedCondition& one) {
  const ShareInterval interval =
      wilson_interval(static_cast<int>(one.wrong), static_cast<int>(one.judged));
  row.push_back({.name = "share_wrong",
                 .title = "share of wrong answers",
                 .value = one.share_wrong(),
                 .low = interval.low,
                 .high = interval.high,
                 .csv = "share_wrong",
                 .form = JsonForm::kEstimate});
}

void add_parameter(FindingRow& row, const char* name, const char* title, const char* unit,
                   const DiffusionEstimate& e) {
  row.push_back({.name = name,
                 .title = title,
                 .value = e.value,
                 .low = e.low,
                 .high = e.high,
                 .unit = unit,
                 .csv = name,
                 .form = JsonForm::kEstimate});
}

void add_diffusion(FindingRow& row, const Defined<DiffusionFit>& fit) {
  if (!fit) {
    row.push_back({.name = "diffusion", .title = "drift rate", .why_not = fit.because()});
    return;
  }
  add_parameter(row, "drift", "drift rate", "", fit->drift);
  add_parameter(row, "boundary", "boundary separation", "", fit->boundary);
  add_parameter(row, "non_decision_time", "non-decision time", "s", fit->non_decision);
  add_count(row, "rarer_answers", "answers of the rarer kind", fit->rarer);
  row.push_back(
      {.name = "distance", .title = "distance", .value = fit->distance, .form = JsonForm::kPlain});
}

FindingRow time_row(const TrialsPlan& plan, const TimedCondition& one) {
  FindingRow row;
  add_time_word(row, "participant", "participant", one.participant, JsonForm::kPlain);
  for (std::size_t f = 0; f < one.levels.size(); ++f) {
    add_time_word(row, "by/" + plan.by[f], "", one.levels[f], JsonForm::kAbsent);
  }
  add_time_word(row, "source", "", "times", JsonForm::kAbsent);
  add_time_word(row, "condition", "condition", one.condition, JsonForm::kPlain);
  add_count(row, "trials", "trials", one.trials);
  add_count(row, "times", "times", one.times.size());
  if (one.judged > 0) {
    add_share(row, one);
  }
  add_number(row, "mean_time", "mean time", one.mean);
  add_number(row, "median_time", "median time", one.median);
  if (plan.diffusion) {
    add_diffusion(row, one.diffusion);
  }
  if (!plan.level.empty()) {
    add_coefficient(row, "slope", "slope", slope_unit(plan), one.line, 1);
    add_coefficient(row, "intercept", "intercept", "s", one.line, 0);
  }
  return row;
}

}  // namespace

FindingTable time_findings(const TrialsResult& result) {
  FindingTable table{"times", "Every participant's times"};
  for (const TimedCondition& one : result.timed) {
    table.rows.push_back(time_row(result.plan, one));
  }
  return table;
}

void add_time_methods(Document& document, const TrialsPlan& plan) {
  document.paragraph(fmt::format(
      "A time is {}; trials with a wrong answer have none. A participant's times under a condition "
      "are averaged: unlike a median, the mean of few and of many times estimates the same (Miller "
      "1988).{}",
      plan.stage.empty()
          ? std::string("the reaction time of the answer")
          : fmt::format("the duration of the stage {}, if its end was reached", plan.stage),
      plan.level.empty()
          ? std::string()
          : fmt::format(" Slope and intercept are those of the least-squares line of a "
                        "participant's times on {}.",
                        plan.level)));
  if (plan.diffusion) {
    document.paragraph(fmt::format(
        "Drift rate, boundary separation and non-decision time are those of a diffusion model "
        "(standard deviation 1 per √s) of all answers with a time, by maximum likelihood with the "
        "first-passage density of Navarro and Fuss (2009); the start lies at {:g} of the way to "
        "the upper boundary, that of {}; a share of {:g} of the answers counts as guesses at any "
        "time up to the longest. Intervals are of profile likelihood; planned tests of the "
        "parameters are two-tailed. The distance is the largest "
        "one between the observed and the fitted distribution of times, those of the other answer "
        "counted negative: above 1.36 / √trials the model does not describe the times, and its "
        "parameters mean nothing; a smaller one does not prove it.",
        plan.diffusion_options.start,
        plan.yes.empty() ? std::string("right answers") : fmt::format("“{}”", plan.yes),
        plan.diffusion_options.contaminants));
  }
}

}  // namespace haptrial::analysis::trials
