#include <fmt/format.h>

#include "analysis/force_training/report/report_parts.h"
#include "analysis/force_training/study/quality_summary.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis {
namespace {

using Rows = std::vector<std::vector<std::string>>;

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
