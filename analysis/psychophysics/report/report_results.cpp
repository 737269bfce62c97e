#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/psychophysics/report/report_hierarchical.h"
#include "analysis/psychophysics/report/report_surfaces.h"
#include "analysis/psychophysics/report/report_times.h"
#include "analysis/psychophysics/report/trials_findings.h"
#include "analysis/psychophysics/report/trials_report.h"
#include "analysis/psychophysics/report/trials_words.h"
#include "analysis/statistics/base/p_adjust.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::trials {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t kMostPictures = 4;

std::string with_unit(const char* name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} ({})", name, unit);
}

/// Says whose answers scatter, which of the rows to report, and what a deviance cannot show.
void add_fit_words(Document& document, const TrialsResult& result) {
  if (result.plan.bayesian) {
    document.paragraph(
        "Report the first row of each; means and tests are of it. The Bayesian fit is for "
        "comparison: it allows for answers that scatter, and its prior of the lapse rate, which "
        "has a mean of 0.09, moves threshold and width where the answers do not tell that rate.");
  }
  std::vector<double> p;
  std::size_t few = 0;
  for (const FunctionFit& fit : result.fits) {
    if (std::isfinite(fit.deviance_p)) {
      p.push_back(fit.deviance_p);
      few += 5 * fit.blocks.size() > fit.trials ? 1U : 0U;
    }
  }
  if (p.empty()) {
    return;
  }
  constexpr double kLevel = 0.05;
  const auto below = [](const std::vector<double>& values) {
    return std::ranges::count_if(values, [](double each) { return each < kLevel; });
  };
  document.paragraph(fmt::format(
      "Answers scatter more about the function than chance explains in {} of {} at the level 0.05; "
      "{:.2g} are expected by chance. After Holm's adjustment {} remain.{}",
      below(p), counted(p.size(), "function"), kLevel * static_cast<double>(p.size()),
      below(holm_adjusted(p)),
      few > 0 ? fmt::format(" {} fewer than five answers at a level on average, which hardly show "
                            "such scatter.",
                            counted(few, "function") + (few == 1 ? " has" : " have"))
              : ""));
}

void add_fit_table(Document& document, const TrialsResult& result) {
  add_table(document, function_findings(result), true);
  add_fit_words(document, result);
  std::vector<std::string> warnings;
  for (const FunctionFit& fit : result.fits) {
    for (const std::string& warning : fit.warnings) {
      warnings.push_back(series_name(fit.participant, fit.condition) + ": " + warning + ".");
    }
  }
  if (!warnings.empty()) {
    document.subheading("What to be careful about");
    for (const std::string& warning : warnings) {
      document.paragraph(warning);
    }
  }
}

void add_population(Document& document, const TrialsResult& result) {
  const auto& population = result.population;
  document.subheading("Mixed model over participants");
  if (!population) {
    document.paragraph("A probit mixed model is not defined, because " + population.because() +
                       ".");
    return;
  }
  const BinomialMixedModel& model = population->model;
  Rows rows;
  for (std::size_t i = 0; i < population->names.size(); ++i) {
    const BinomialCoefficient& c = model.fixed.coefficients[i];
    rows.push_back({population->names[i], number(c.estimate), number(c.error),
                    fmt::format("{} to {}", number(c.low), number(c.high))});
  }
  document.table({"coefficient (probit)", "estimate", "standard error", "95 %"}, rows);
  Rows points;
  for (const PopulationPoint& p : population->points) {
    const psychometric::Axis& axis = result.plan.function.axis;
    points.push_back({p.condition.empty() ? "all" : p.condition,
                      p.point ? fmt::format("{} [{}, {}]", number(axis.level(p.point->point)),
                                            number(axis.level(p.point->point_low)),
                                            number(axis.level(p.point->point_high)))
                              : "not defined, because " + p.point.because(),
                      p.point ? fmt::format("{} [{}, {}]", number(p.point->jnd),
                                            number(p.point->jnd_low), number(p.point->jnd_high))
                              : "–"});
  }
  document.table({"condition", with_unit("level of 50 %", result.plan.function.axis.unit),
                  with_unit("from 50 % to 75 %", result.plan.function.axis.x_unit())},
                 points);
  document.paragraph(fmt::format(
      "Answers of all participants in one model, by maximum likelihood in Laplace's approximation. "
      "Intercept, slope and, with two conditions, the differences of both vary between "
      "participants, with all covariances. Intervals are of Student's t with participants - 1 "
      "degrees of freedom. The level is standardised: (x - {}) / {}.{}{}",
      number(population->centre), number(population->scale),
      model.at_boundary ? " Some variance between participants is estimated as 0." : "",
      population->condition_p
          ? fmt::format(" Whether the conditions differ: t({}) = {}, {}.", population->condition_df,
                        number(population->condition_t), p_value(*population->condition_p))
          : ""));
}

void add_functions(Document& document, const TrialsResult& result,
                   const std::vector<Drawing>& drawings) {
  add_section(document, result, "Psychometric functions");
  if (result.plan.kind == AnalysisKind::kPsychometric) {  // else they stand with the detection
    add_means(document, result);
    add_pictures(document, drawings, "by-condition-", kMostPictures);
  }
  add_pictures(document, drawings, "functions", 1);
  add_pictures(document, drawings, "function-", kMostPictures);
  add_fit_table(document, result);
  add_population(document, result);
  add_hierarchical(document, result);
}

void add_detections(Document& document, const TrialsResult& result,
                    const std::vector<Drawing>& drawings) {
  add_section(document, result, "Detection");
  add_means(document, result);
  add_pictures(document, drawings, "by-condition-", kMostPictures);
  add_pictures(document, drawings, "roc", 1);
  add_table(document, detection_findings(result), true);
}

/// The share of each answer to each stimulus, over all participants.
void add_confusions(Document& document, const TrialsResult& result) {
  for (const auto& [condition, confusions] : pooled_confusions(result.identified)) {
    std::vector<std::string> heading{"presented", "trials"};
    for (const std::string& choice : result.plan.choices) {
      heading.push_back("“" + choice + "”");
    }
    Rows rows;
    for (std::size_t i = 0; i < confusions.stimuli.size(); ++i) {
      const std::vector<int>& answers = confusions.answers[i];
      const int trials = std::accumulate(answers.begin(), answers.end(), 0);
      auto& row = rows.emplace_back();
      row = {confusions.stimuli[i], std::to_string(trials)};
      for (const int count : answers) {
        row.push_back(fmt::format("{:.2f}", static_cast<double>(count) / std::max(trials, 1)));
      }
    }
    document.table(heading, rows,
                   "Shares of the answers to each stimulus, all participants" +
                       (condition.empty() ? "" : ": " + condition));
  }
}

std::string words_of(DiscriminationTask task, int alternatives) {
  switch (task) {
    case DiscriminationTask::kOddity:
      return "who finds the odd one of three by their differences";
    case DiscriminationTask::kAbx:
      return "who compares the third with either of the others by their differences";
    case DiscriminationTask::kSameDifferent:
      return "who judges each of two on its own and says whether both are the same";
    case DiscriminationTask::kOneInterval:
      return "who meets one of two stimuli in each trial, and is the distance between the two";
    case DiscriminationTask::kForcedChoice:
      break;
  }
  return fmt::format("to whom {} alternatives are equally alike", alternatives);
}

void add_identification(Document& document, const TrialsResult& result,
                        const std::vector<Drawing>& drawings) {
  add_section(document, result, "Identification");
  add_means(document, result);
  add_pictures(document, drawings, "by-condition-", kMostPictures);
  add_confusions(document, result);
  add_table(document, identification_findings(result), true);
  const int alternatives = std::max(result.plan.alternatives(), 2);
  document.paragraph(fmt::format(
      "d' is that of an observer without bias {}; the shares above show where this does not hold. "
      "Chance is {:.3f}.",
      words_of(result.plan.discrimination, alternatives),
      task_share(result.plan.discrimination, 0.0, alternatives)));
}

void add_laws(Document& document, const TrialsResult& result,
              const std::vector<Drawing>& drawings) {
  add_section(document, result, "Magnitudes");
  add_means(document, result);
  add_pictures(document, drawings, "magnitudes", 1);
  add_pictures(document, drawings, "by-condition-", kMostPictures);
  add_table(document, law_findings(result), false);
  add_table(document, exponent_findings(result), true);
}

void add_settings(Document& document, const TrialsResult& result,
                  const std::vector<Drawing>& drawings) {
  add_section(document, result, "Settings");
  add_means(document, result);
  add_pictures(document, drawings, "by-condition-", kMostPictures);
  add_table(document, track_findings(result), true);
}

}  // namespace

void add_means(Document& document, const TrialsResult& result) {
  Rows rows;
  for (const Quantity& q : result.quantities) {
    for (std::size_t cell = 0; cell < q.table.cells.size(); ++cell) {
      rows.push_back({q.title, result.plan.by.empty() ? "all" : q.table.names[cell],
                      std::to_string(q.table.participants(cell)),
                      mean_word(result, q, cell) + unit_word(result, q)});
    }
  }
  if (!rows.empty()) {
    document.table({"quantity", "condition", "participants", "mean over participants"}, rows);
  }
}

void add_results(Document& document, const TrialsResult& result,
                 const std::vector<Drawing>& drawings) {
  if (result.plan.kind == AnalysisKind::kDetection) {
    add_detections(document, result, drawings);
  }
  if (result.plan.kind == AnalysisKind::kIdentification) {
    add_identification(document, result, drawings);
  }
  if (result.cues) {
    add_cues(document, result, drawings);
  }
  if (!result.surfaces.empty()) {
    add_section(document, result, "Functions of several variables");
    if (result.series.empty()) {
      add_means(document, result);  // else they stand with the functions of one variable
    }
    add_surfaces(document, result, drawings);
  }
  if (result.plan.functions && (result.surfaces.empty() || !result.series.empty())) {
    add_functions(document, result, drawings);
  }
  if (result.plan.kind == AnalysisKind::kMagnitude) {
    add_laws(document, result, drawings);
  }
  if (result.plan.kind == AnalysisKind::kAdjustment) {
    add_settings(document, result, drawings);
  }
  if (result.plan.kind == AnalysisKind::kTimes) {
    add_section(document, result, "Times and wrong answers");
    add_means(document, result);
    add_pictures(document, drawings, "by-condition-", kMostPictures);
    add_table(document, time_findings(result), true);
  }
  if (result.reaching) {
    add_reaching(document, result, drawings);
    if (!result.quantities.empty()) {
      add_section(document, result, "Reaches by condition");
      add_means(document, result);
      add_pictures(document, drawings, "by-condition-", kMostPictures);
    }
  }
}

}  // namespace haptrial::analysis::trials
