#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "analysis/psychophysics/report/trials_findings.h"
#include "analysis/psychophysics/report/trials_report.h"
#include "analysis/psychophysics/report/trials_words.h"
#include "analysis/statistics/design/design_blocks.h"
#include "analysis/statistics/design/wording.h"
#include "analysis/statistics/tests/wilcoxon.h"

namespace haptrial::analysis::trials {
namespace {

constexpr std::size_t kMostTracks = 1;

void add_quantity(Document& document, const Quantity& q) {
  document.subheading(capitalized(q.title));
  if (!q.open.empty()) {
    document.paragraph(
        fmt::format("Without {}: the answers leave a side of the value's interval open.",
                    fmt::join(q.open, ", ")));
  }
  add_design_tests(document, q.table, q.tests, q.unit);
}

/// Adds the origin of the tracks' intervals, and why some have none.
void add_interval_words(Document& document, const TrialsResult& result) {
  std::set<std::string> reasons;
  bool stated = false;
  for (const TrackEstimate& track : result.tracks) {
    if (!track.no_interval.empty()) {
      reasons.insert(track.no_interval);
    }
    stated = stated || (!track.estimates.empty() && track.estimates.front().interval &&
                        !track.estimates.front().freedom);
  }
  if (stated) {
    document.paragraph(
        "The interval of a staircase's or PEST's own estimate is the estimate less the errors of "
        "999 simulated tracks of the same procedure, whose observers have the functions that the "
        "track's answers leave open; that of a Bayesian procedure is the central 95 % of its "
        "posterior.");
  }
  if (!reasons.empty()) {
    document.paragraph(fmt::format("Estimates without an interval: {}.", fmt::join(reasons, "; ")));
  }
}

void add_tracks(Document& document, const TrialsResult& result,
                const std::vector<Drawing>& drawings) {
  if (std::ranges::none_of(result.tracks, &TrackEstimate::adaptive)) {
    return;  // listed levels have neither turns nor an estimate
  }
  add_section(document, result, "Tracks of the procedure");
  for (const Drawing& drawing : drawings) {
    if (drawing.figure.name.starts_with("panel-")) {
      document.picture(drawing);
    }
  }
  add_pictures(document, drawings, "tracks-", kMostTracks);
  add_table(document, track_findings(result), true);
  add_interval_words(document, result);
}

/// Why sessions were simulated for the tests, where levels followed from answers.
std::string words_of_chance(const TrialsResult& result) {
  const bool adaptive = std::any_of(result.series.begin(), result.series.end(),
                                    [](const AnsweredSeries& series) { return series.adaptive; });
  return adaptive ? " Where levels follow from answers, these numbers are not zero even for people "
                    "without drift or repetition. Their average over 25 simulated sessions of such "
                    "a person is subtracted."
                  : "";
}

/// ", on ranks p = 0.12", which single participants far out do not decide.
std::string on_ranks(const std::vector<SerialEffects>& serial,
                     Defined<double> SerialCoefficients::*effect) {
  std::vector<double> values;
  for (const SerialEffects& s : serial) {
    if (const auto& value = s.effects.*effect) {
      values.push_back(*value);
    }
  }
  const std::vector<double> zero(values.size(), 0.0);
  const auto test = wilcoxon_signed_rank(values, zero, Tail::kTwoSided);
  return test
             ? fmt::format(", on ranks {}{}", p_value(test->p), test->exact ? "" : " (approximate)")
             : "";
}

void add_serial(Document& document, const TrialsResult& result) {
  if (result.serial.empty()) {
    return;
  }
  add_table(document, serial_findings(result), false);
  document.paragraph(fmt::format(
      "Drift: how the log odds of an answer 1 change over the session beside the function. "
      "Repetition: how much the answer before moves the log odds of giving it again. Over "
      "participants against 0: drift {}{}; repetition {}{}. Intervals of single people take their "
      "function as known.{}",
      t_result(result.drift), on_ranks(result.serial, &SerialCoefficients::drift),
      t_result(result.repetition), on_ranks(result.serial, &SerialCoefficients::repetition),
      words_of_chance(result)));
}

/// The stages in which the force limit was reached: one before the stimulus harms no answer.
std::string limit_words(const std::vector<ParticipantTrials>& people) {
  struct Limited {
    std::size_t participants{0};
    double most{0.0};
  };
  std::map<std::string, Limited> stages;
  for (const ParticipantTrials& p : people) {
    for (const auto& [stage, share] : p.at_limit) {
      ++stages[stage].participants;
      stages[stage].most = std::max(stages[stage].most, share);
    }
  }
  std::vector<std::string> words;
  for (const auto& [stage, limited] : stages) {
    words.push_back(fmt::format("{} (of {} of {}, in up to {} of the trials)", stage,
                                limited.participants, counted(people.size(), "participant"),
                                percent(limited.most)));
  }
  return words.empty() ? "The device never came to its force limit."
                       : fmt::format(
                             "The force limit was reached in the stages {}, and in no "
                             "other.",
                             fmt::join(words, ", "));
}

}  // namespace

void add_comparisons(Document& document, const TrialsResult& result) {
  const bool any = std::any_of(result.quantities.begin(), result.quantities.end(),
                               [](const Quantity& q) { return q.compared; });
  if (!any) {
    return;
  }
  add_section(document, result, "Comparison of conditions");
  for (const Quantity& q : result.quantities) {
    if (q.compared) {
      add_quantity(document, q);
    }
  }
}

/// How soon those who listened were told what began.
static void add_markers(Document& document, const TrialsResult& result) {
  std::vector<std::string> sentences;
  for (const markers::MarkerTimes& times : result.data.markers.times()) {
    sentences.push_back(sentence_of(times));
  }
  if (!sentences.empty()) {
    document.paragraph(fmt::format("Markers: {}.", fmt::join(sentences, "; ")));
  }
}

void add_trial_quality(Document& document, const TrialsResult& result,
                       const std::vector<Drawing>& drawings) {
  add_tracks(document, result, drawings);
  add_section(document, result, "Quality");
  add_serial(document, result);
  add_reach_quality(document, result);
  const bool staged = std::ranges::any_of(
      result.data.trials, [](const StudyTrial& trial) { return !trial.stages.empty(); });
  if (staged) {  // imported trials have none, and no device
    document.paragraph(limit_words(result.participants));
  }
  for (const std::string& sentence : body_lines(result)) {
    document.paragraph(sentence);
  }
  add_markers(document, result);
  add_pictures(document, drawings, "reaction-times", 1);
}

}  // namespace haptrial::analysis::trials
