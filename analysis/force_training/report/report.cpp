#include "analysis/force_training/report/report.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "analysis/force_training/report/report_parts.h"
#include "analysis/force_training/study/quality_summary.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis {
namespace {

std::string subtitle(const StudyResult& study) {
  return fmt::format(
      "{} of {} under {}. {} recall error is 0 for a perfect recall and grows with the difference "
      "that remains after aligning the two curves in time.",
      counted(study.scores.size(), "scored recall trial"),
      counted(study.statistics.subjects.size(), "participant"),
      counted(study.statistics.conditions.size(),
              study.curves_from.empty() ? "training condition" : "condition"),
      study.curves_from.empty()
          ? "In each trial the participant learned a force pattern and then reproduced it; the"
          : "The");
}

}  // namespace

void add_picture(Document& document, const std::vector<Drawing>& drawings,
                 const std::string& name) {
  for (const Drawing& drawing : drawings) {
    if (drawing.figure.name == name) {
      document.picture(drawing);
    }
  }
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

Document study_report(const StudyResult& study, const std::vector<Drawing>& drawings) {
  Document document;
  document.title = "Recall of force patterns";
  document.subtitle = subtitle(study);
  document.simulated = study.simulated();
  if (study.simulated()) {
    document.alarm(
        "SIMULATED PARTICIPANTS: these data come from virtual subjects. They say how the "
        "experiment and its analysis work, not how people learn.");
  }
  for (const std::string& alarm : study.alarms) {
    document.alarm(alarm);
  }
  document.points(summary_lines(study));
  add_design(document, study);
  add_recall(document, study, drawings);
  add_tests(document, study);
  add_path(document, study);
  add_learning_section(document, study.learned, drawings, study.simulated());
  add_learning(document, study, drawings);
  add_alignments(document, study, drawings);
  add_quality(document, study, drawings);
  add_methods(document, study);
  return document;
}

namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr const char* kMixedModel =
    "A linear mixed model took every trial (restricted maximum likelihood, Satterthwaite's degrees "
    "of freedom).";

/// A paragraph that can go into a paper's methods section.
std::string methods(const StudyResult& study) {
  std::vector<std::string> parameters;
  for (const auto& [name, value] : study.parameters) {
    parameters.push_back(name + " " + value);
  }
  std::string compared = comparison_words(study.statistics.tests);
  for (const std::string& sentence : sentences_beside(study.statistics.tests, "recall error")) {
    compared += " " + sentence;
  }
  return fmt::format(
      "Recall was scored as in Morris (2006, §4.3): target and applied force were resampled to a "
      "common time base, the applied force low-pass filtered, the two aligned by dynamic "
      "programming over the differences of force and slope, and the score taken as the weighted "
      "mean of the alignment cost and of the root-mean-square differences of force and slope after "
      "warping ({}). Participants were the unit of analysis: each gave one mean for each "
      "condition. {} Beside them stand tests on ranks, permutation tests and bias-corrected and "
      "accelerated bootstrap intervals (9,999 random arrangements or resamples, or all "
      "arrangements "
      "if there are at most 1,000,000). {} Intervals have a coverage of 95 %; "
      "those of shares of variance have 90 % and invert the noncentral F distribution.{}",
      joined(parameters), compared, kMixedModel,
      study.simulated() ? " All participants were simulated." : "");
}

void add_versions(Document& document, const StudyResult& study) {
  std::set<std::string> programs;
  std::map<std::string, std::string> definitions;  // text to name
  for (const auto& session : study.sessions) {
    programs.insert(session.info.program_version + " (" + session.info.program_commit + ")");
    definitions.emplace(session.info.definition, session.info.definition_name);
  }
  document.paragraph("Recorded by haptrial " + joined({programs.begin(), programs.end()}) + ".");
  if (definitions.size() > 1) {
    document.paragraph(fmt::format("The definition was used in {} versions.", definitions.size()));
  }
  for (const auto& [text, name] : definitions) {
    document.source("Definition " + name, text);
  }
}

}  // namespace

void add_methods(Document& document, const StudyResult& study) {
  document.heading("Methods, parameters and versions");
  document.paragraph(methods(study));
  Rows rows;
  for (const auto& [name, value] : study.parameters) {
    rows.push_back({name, value});
  }
  document.table({"Parameter of the score", "Value"}, rows);
  if (study.curves_from.empty()) {
    add_versions(document, study);
  }
}

namespace {

/// Root mean square of how far hands were from the expert's over a condition's trials [mm].
std::string kept_in(const StudyResult& study, const std::string& condition) {
  double squares = 0.0;
  int count = 0;
  for (const TrialScore& score : study.scores) {
    if (score.kept && score.condition == condition) {
      squares += *score.kept * *score.kept;
      ++count;
    }
  }
  return count > 0 ? number(1e3 * std::sqrt(squares / count)) : "-";
}

}  // namespace

void add_path(Document& document, const StudyResult& study) {
  if (!study.path) {
    return;
  }
  document.heading("Recall of the path by training condition");
  document.paragraph(
      "Nothing led the hand in the tests. The path error is the root mean square of its distance "
      "in the plane from where the expert was at the same time, so that it holds errors of time as "
      "well. The last column says how far hands that were led kept to the expert's, in training.");
  std::vector<std::vector<std::string>> rows;
  for (const ConditionSummary& s : study.path->summaries) {
    rows.push_back({capitalized(s.condition), std::to_string(s.people),
                    s.participants ? number(s.participants->mean) : quantity(s.mean, 1.0, ""),
                    s.participants ? number(s.participants->deviation) : "-",
                    s.participants ? fmt::format("{} to {}", number(s.participants->low),
                                                 number(s.participants->high))
                                   : "not defined, because " + s.participants.because(),
                    std::to_string(s.count), kept_in(study, s.condition)});
  }
  document.table({"Condition", "Participants", "Path error [mm]", "SD", "95 % CI", "Trials",
                  "Kept to the expert's hand [mm]"},
                 rows);
  add_participants(document, *study.path, "Path error");
}

namespace {

constexpr std::size_t kMostRows = 100;  // of flagged trials; scores.csv has them all

/// "4.2 %", "12.7 s", "49.6 ms".
std::string shown(double value, const char* unit) {
  return fmt::format("{:.1f}{}{}", value, kNoBreak, unit);
}

std::string middle(const std::optional<Spread>& s, double factor, const char* unit) {
  return s ? shown(factor * s->median, unit) : "-";
}

std::string highest(const std::optional<Spread>& s, double factor, const char* unit) {
  return s ? shown(factor * s->high, unit) : "-";
}

std::string range(const std::optional<Spread>& s) {
  return s ? fmt::format("{:.1f} to {}", s->low, shown(s->high, "s")) : "-";
}

/// Farthest from none, early or late.
std::string worst_lag(const std::optional<Spread>& s) {
  return s ? shown(1e3 * (-s->low > s->high ? s->low : s->high), "ms") : "-";
}

void add_participant_quality(Document& document,
                             const std::vector<ParticipantQuality>& participants) {
  Rows rows;
  for (const ParticipantQuality& p : participants) {
    rows.push_back({p.subject, std::to_string(p.trials), std::to_string(p.flagged),
                    middle(p.saturation, 100.0, "%"), highest(p.saturation, 100.0, "%"),
                    highest(p.training_saturation, 100.0, "%"), middle(p.duration, 1.0, "s"),
                    range(p.duration), middle(p.lag, 1e3, "ms"), worst_lag(p.lag)});
  }
  document.table(
      {"Subject", "Scored trials", "Flagged", "At the limit, median", "At the limit, worst",
       "At the limit in training, worst", "Run, median", "Run, range", "Lag, median", "Lag, worst"},
      rows);
}

/// @param trials  whose quality is judged
void add_flagged(Document& document, const std::vector<TrialScore>& trials, bool several_sessions) {
  Rows rows;
  std::size_t flagged = 0;
  for (const TrialScore& score : trials) {
    std::string reasons;
    for (const TrialFlag& flag : flags_of(score.quality)) {
      reasons += (reasons.empty() ? "" : "; ") + flag.reason;
    }
    flagged += reasons.empty() ? 0 : 1;
    if (!reasons.empty() && rows.size() < kMostRows) {
      rows.push_back({score.subject,
                      several_sessions ? fmt::format("{} of session {}", score.trial, score.session)
                                       : std::to_string(score.trial),
                      score.condition, reasons});
    }
  }
  if (flagged == 0) {
    document.paragraph("No trial is flagged.");
    return;
  }
  document.table({"Subject", "Trial", "Condition", "Flagged because"}, rows);
  if (flagged > rows.size()) {
    document.paragraph(
        fmt::format("The first {} of {} flagged trials; the column flags of "
                    "scores.csv marks all of them.",
                    rows.size(), flagged));
  }
}

}  // namespace

void add_trial_quality(Document& document, const StudyResult& study) {
  document.heading("Quality of the trials");
  document.paragraph(
      "How the runs of the scored trials went: the share of ticks at the force limit, how long the "
      "test's run took, and how far the hand lagged behind a moving target. A trial is flagged if "
      "a "
      "number is far from what the shipped studies give; a flag excludes nothing by itself. "
      "scores.csv has these numbers, and more, for each trial.");
  const std::vector<TrialScore> trials = judged_trials(study.scores, study.tests);
  if (!study.tests.empty()) {
    document.paragraph("Tests of participants whom no session had trained yet are not judged.");
  }
  add_participant_quality(document, participant_quality(trials));
  add_flagged(document, trials, !study.planned_sessions.empty());
}

}  // namespace haptrial::analysis
