#include "analysis/psychophysics/report/trials_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>

#include "analysis/psychometric/fit/stated_fit.h"
#include "analysis/psychophysics/report/report_times.h"
#include "analysis/psychophysics/report/trials_figures.h"
#include "analysis/psychophysics/report/trials_findings.h"
#include "analysis/psychophysics/report/trials_words.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::trials {
namespace {

void add_paired_methods(Document& document, const PairedPlan& plan) {
  const bool odds = plan.model == PairedModel::kBradleyTerry;
  document.paragraph(fmt::format(
      "Worths are those of {}, fitted to the choices of each participant under a condition by "
      "maximum likelihood without its bias of first order (Firth 1993; Kosmidis and Firth 2009), "
      "so that items that were always or never chosen have one, too; a mean has no interval if "
      "most participants chose so, or if most always or never chose the item and others over all "
      "the rest. The mean of the worths over the items is 0. Shares chosen are "
      "those of participants to whom every pair was presented.",
      odds ? "the model of Bradley and Terry (1952), in log odds"
           : "Thurstone's case V (1927), in standard deviations of a difference"));
}

void add_produced_methods(Document& document, const ProducedPlan& plan) {
  document.paragraph(fmt::format(
      "What a trial produced is its measure {}, the {} of the definition's [measures]; trials "
      "without it have none, and a participant's trials under a condition are averaged.{}",
      plan.measure, plan.words,
      plan.target.empty()
          ? std::string()
          : fmt::format(" The constant error is the mean of what was produced less {}, the "
                        "absolute error that of its size, the variable error its standard "
                        "deviation over trials.",
                        plan.target)));
}

using Rows = std::vector<std::vector<std::string>>;

void add_design(Document& document, const TrialsResult& result) {
  add_section(document, result, "Participants and trials");
  add_table(document, participant_findings(result), false);
  if (!result.plan.by.empty()) {
    document.paragraph(
        fmt::format("Conditions are the levels of {}.", fmt::join(result.plan.by, ", ")));
  }
  document.paragraph(
      "Practice and passes that were aborted or damaged are in trials.csv (column counted: 0) and "
      "in nothing else.");
  if (result.participants.size() > kMostDrawn) {
    document.paragraph(fmt::format(
        "Pictures of single participants are drawn of the first {}; estimates.csv and trials.csv "
        "have all.",
        kMostDrawn));
  }
  for (const std::string& remark : result.remarks) {
    document.paragraph(remark);
  }
}

/// Scores of questionnaires over participants.
void add_pages(Document& document, const TrialsResult& result) {
  if (result.page_scores.empty()) {
    return;
  }
  add_section(document, result, "Questionnaires");
  Rows rows;
  for (const PageSummary& s : summaries_of(result.page_scores)) {
    rows.push_back({s.page, s.when, s.score, s.group.empty() ? "–" : s.group,
                    std::to_string(s.count), fmt::format("{:.4g}", s.mean),
                    s.count > 1 ? fmt::format("{:.3g}", s.deviation) : "–"});
  }
  document.table({"page", "when", "score", "group", "participants", "mean", "standard deviation"},
                 rows);
  document.paragraph(
      "Scores of the NASA-TLX are from 0 to 100: raw is the mean of the six ratings, weighted "
      "weighs them by the 15 pairs. The laterality quotient of the Edinburgh inventory is from "
      "-100 (left) to 100 (right).");
}

std::string function_words(const TrialsPlan& plan) {
  return fmt::format(
      "The function is {}, over {}{}; guess rate {}; lapse rate {}. The threshold is the level at "
      "which, lapses aside, the share of answers 1 is {}.",
      plan.function_name,
      plan.function.axis.x_unit().empty() ? "the level" : plan.function.axis.x_unit(),
      plan.function.axis.origin != 0.0
          ? fmt::format(" of the level less {}", plan.function.axis.origin)
          : "",
      plan.guess_free       ? "free"
      : plan.guess_is_lapse ? "as the lapse rate"
                            : fmt::format("{:g}", plan.function.guess),
      plan.lapse.low == plan.lapse.high ? fmt::format("{:g}", plan.lapse.low)
                                        : fmt::format("free up to {:g}", plan.lapse.high),
      percent(plan.threshold_at));
}

/// Origin of the intervals of functions at listed levels.
std::string sampled_words(const TrialsPlan& plan) {
  return fmt::format(
      "Functions of listed levels are fitted by maximum likelihood. Intervals of threshold, "
      "width and Weber fraction at listed levels are those of the "
      "profile likelihood (Venzon and Moolgavkar 1988), those of slope, lapse rate and band "
      "bias-corrected and accelerated over {} parametric bootstrap samples (Wichmann and Hill "
      "2001). If answers scatter more than chance explains (p below {} of the deviance), the "
      "intervals are as much longer as a quasi-likelihood makes them, those of slope and Weber "
      "fraction on the logarithm, those of rates up to the bounds of the fit. A likeliest rate of "
      "0 has no interval, as samples that are drawn without lapses do not tell how many there "
      "may be.",
      plan.resamples, kUnusualScatter);
}

/// Origin of the intervals if no bootstrap samples were drawn.
std::string unsampled_words() {
  return fmt::format(
      "Functions of listed levels are fitted by maximum likelihood, without bootstrap samples. "
      "Intervals are those of the profile likelihood (Venzon and Moolgavkar 1988), which "
      "threshold, width and Weber fraction have. If answers scatter more than chance explains (p "
      "below {} of the deviance by chi-square), they are as much longer as a quasi-likelihood "
      "makes them; functions with fewer than five trials a level on average are not judged.",
      kUnusualScatter);
}

/// Origin of the intervals of functions.
std::string interval_words(const TrialsResult& result) {
  const auto adaptive = [](const FunctionFit& fit) { return fit.adaptive; };
  std::string words;
  if (std::any_of(result.fits.begin(), result.fits.end(), adaptive)) {
    words +=
        "Estimates of functions of adaptive trials are medians of the posterior of threshold, "
        "width and lapse rate, their intervals its central 95 %: it does not depend on how levels "
        "were chosen. The prior is flat in the threshold from s / 2 below to s / 2 above the range "
        "s of what could be presented and in the guess rate, Beta(1, 10) in the lapse rate, and "
        "1 / (w + s / 10) in the width w. A side of an interval is open if the prior ends it.";
  }
  if (!std::all_of(result.fits.begin(), result.fits.end(), adaptive)) {
    words += (words.empty() ? "" : " ") +
             (result.plan.resamples > 0 ? sampled_words(result.plan) : unsampled_words());
  }
  return words;
}

void add_binormal_methods(Document& document, const TrialsResult& result) {
  if (std::ranges::any_of(result.detected, [](const auto& one) { return bool(one.binormal); })) {
    document.paragraph(
        "Ratings are also described by normal distributions of unequal variances (Dorfman and Alf "
        "1969): z(H) = a + b z(F), b the standard deviation of the noise over that of the signal, "
        "d_a = √2 a / √(1 + b²), which is d' if the variances are equal.");
  }
}

/// Sentences on the tests of quantities that are compared, each once. A quantity whose conditions
/// have no defined test, such as errors that nobody made, does not say how conditions were compared
/// if another one does.
std::string compared_words(const TrialsResult& result) {
  std::vector<std::string> all;
  const auto add = [&all](const std::string& sentence) {
    if (std::ranges::find(all, sentence) == all.end()) {
      all.push_back(sentence);
    }
  };
  const auto has_effect = [](const Quantity& quantity) {
    return std::ranges::any_of(quantity.tests.effects, [](const auto& e) { return bool(e); });
  };
  const bool any_effect = std::ranges::any_of(result.quantities, has_effect);
  if (!result.plan.baseline.empty()) {
    add(
        fmt::format("Values are changes: those under a condition less the same participant's in "
                    "the session {}.",
                    result.plan.baseline));
  }
  for (const Quantity& quantity : result.quantities) {
    if (quantity.compared && quantity.table.cells.size() > 1) {
      if (!any_effect || has_effect(quantity)) {
        add(comparison_words(quantity.tests));
      }
      std::ranges::for_each(sentences_beside(quantity.tests, tested_title(result, quantity)), add);
    }
  }
  if (std::ranges::none_of(result.quantities, &Quantity::compared)) {
    add("No conditions were compared.");
  }
  return fmt::format(" {}", fmt::join(all, " "));
}

void add_methods(Document& document, const TrialsResult& result) {
  document.heading("Methods");
  const TrialsPlan& plan = result.plan;
  if (plan.functions && (result.surfaces.empty() || !result.series.empty())) {
    document.paragraph(function_words(plan));
    document.paragraph(interval_words(result));
    document.paragraph(
        "The Bayesian fit is beta-binomial on a grid (Schütt et al. 2016), so that its intervals "
        "are wider where answers scatter more than chance; its estimates are posterior means.");
  }
  if (plan.kind == AnalysisKind::kDetection) {
    document.paragraph(
        "d' and criterion are those of equal variances, from counts to which 1/2 was added "
        "(log-linear correction, Hautus 1995). Signal is in the trials in which \"yes\" is right; "
        "if "
        "the definition does not say what is right, in those with a level above 0 and no probe.");
    add_binormal_methods(document, result);
  } else if (plan.kind == AnalysisKind::kMagnitude) {
    document.paragraph(
        "A participant's repeated estimates at a level are put together by their geometric mean; "
        "the exponent is " +
        std::string(plan.measured.empty()
                        ? "the least-squares slope of log estimate over log level."
                        : fmt::format("the slope of log estimate over the logarithm of {}, with "
                                      "errors on both axes as repeated trials scatter (York et "
                                      "al. 2004).",
                                      plan.measured)) +
        " Moduli are equalised before participants are averaged (Lane, Catania and Stevens "
        "1961).");
  }
  if (plan.kind == AnalysisKind::kAdjustment) {
    document.paragraph(
        "A setting is the level at which an adjustment was left; those of a track are averaged, "
        "and the tracks of a participant under a condition again. Settings from starts above and "
        "below count alike, and the difference of the two sides is no part of the interval.");
  }
  if (plan.kind == AnalysisKind::kPursuit) {
    document.paragraph(fmt::format(
        "The tracking error of a pursuit is the root mean square distance of the hand from the "
        "target in the directions in which the target moves, without the first {:g} s. Gain and "
        "lag are those of sines fitted beside a line in time to target and hand (least squares) "
        "along the direction in which the target swings; a participant's trials under a condition "
        "are averaged as complex numbers.",
        plan.pursuit.settle));
  }
  if (plan.kind == AnalysisKind::kProduced) {
    add_produced_methods(document, plan.produced);
  }
  if (plan.kind == AnalysisKind::kPaired) {
    add_paired_methods(document, plan.paired);
  }
  if (plan.kind == AnalysisKind::kTimes) {
    add_time_methods(document, plan);
  }
  if (plan.metacognition) {
    document.paragraph(
        "meta-d' is the d' at which an observer of equal variances would tell right from wrong "
        "answers by confidence as well as the participant, by maximum likelihood of the ratings "
        "given stimulus and answer (Maniscalco and Lau 2012); the M-ratio is meta-d' / d', with "
        "d' of the answers after the log-linear correction. It has no number if the 95 % interval "
        "of that d' reaches 0. Intervals are of Fisher's information and the delta method.");
  }
  if (plan.kind == AnalysisKind::kReaching) {
    add_reaching_methods(document, plan.reaching);
    if (!result.quantities.empty()) {
      document.paragraph(fmt::format(
          "Conditions are compared in one value of each participant under each condition, the mean "
          "over its reaches without a probe in {} of each block; force compensation is that of "
          "reaches in a channel.{}",
          plan.reaching.cycles == ReachCycles::kAll     ? "all cycles"
          : plan.reaching.cycles == ReachCycles::kFirst ? "the first cycle"
                                                        : "the last cycle",
          compared_words(result)));
    }
    document.heading("Definition");
    document.source(result.definition_name, result.definition);
    return;
  }
  document.paragraph(
      "Tests between conditions take one value of each participant for each condition; trials are "
      "never counted as independent over participants." +
      compared_words(result));
  document.heading("Definition");
  document.source(result.definition_name, result.definition);
}

}  // namespace

void add_section(Document& document, const TrialsResult& result, const char* text) {
  document.heading(result.simulated() ? std::string(text) + " (simulated)" : text);
}

void add_pictures(Document& document, const std::vector<Drawing>& drawings, const char* begin,
                  std::size_t most) {
  std::size_t shown = 0, others = 0;
  for (const Drawing& drawing : drawings) {
    if (!drawing.figure.name.starts_with(begin)) {
      continue;
    }
    if (shown < most) {
      document.picture(drawing);
      ++shown;
    } else {
      ++others;
    }
  }
  if (others > 0) {
    document.paragraph(fmt::format("{} of the other participants {} beside this report ({}*.svg).",
                                   counted(others, "picture"), others == 1 ? "lies" : "lie",
                                   begin));
  }
}

Document trials_report(const TrialsResult& result, const std::vector<Drawing>& drawings) {
  Document document;
  document.title = result.title;
  document.simulated = result.simulated();
  document.subtitle = fmt::format("{} in {}.", counted(result.participants.size(), "participant"),
                                  counted(result.data.sessions.size(), "session"));
  if (result.simulated()) {
    document.alarm(kSimulatedTrials);
  }
  document.points(summary_lines(result));
  add_design(document, result);
  add_apparatus(document, result);
  add_pages(document, result);
  add_results(document, result, drawings);
  add_comparisons(document, result);
  add_trial_quality(document, result, drawings);
  add_methods(document, result);
  return document;
}

}  // namespace haptrial::analysis::trials
