#include <fmt/format.h>

#include "analysis/force_training/report/report_parts.h"
#include "analysis/statistics/design/wording.h"
#include "core/record/read/session_facts.h"

namespace haptrial::analysis {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::vector<std::string> tracking_row(const TrackingSummary& t) {
  return {t.subject,
          std::to_string(t.passes),
          quantity(t.lag, 1e3, "ms"),
          t.lag_deviation ? number(*t.lag_deviation * 1e3) + " ms" : "-",
          quantity(t.rms_error, 1e3, "mm"),
          quantity(t.rms_error_in_plane, 1e3, "mm")};
}

std::vector<std::string> pace_row(const TrackingSummary& t) {
  return {t.subject,
          std::to_string(t.passes),
          quantity(t.run, 1.0, "s"),
          t.run_deviation ? number(*t.run_deviation) + " s" : "-",
          quantity(t.rms_error, 1e3, "mm"),
          quantity(t.rms_error_in_plane, 1e3, "mm")};
}

void add_pace(Document& document, const StudyResult& study) {
  document.heading("Pace and distance from the path");
  document.paragraph(
      "The participants moved along the path at their own pace, so forces are compared over the "
      "place on the path and not over time. How long a run took, over the completed passes "
      "(training and test), and the hand's root-mean-square distance from the nearest place of the "
      "path: in space, and without the direction of the force.");
  Rows rows;
  for (const auto& session : study.sessions) {
    rows.push_back(pace_row(session.tracking));
  }
  rows.push_back(pace_row(study.tracking));
  document.table({"Subject", "Passes", "Run", "SD of run", "RMS distance", "RMS distance in plane"},
                 rows);
}

void add_tracking(Document& document, const StudyResult& study) {
  document.heading("Tracking of the trajectory");
  document.paragraph(
      "How far the hand lagged behind the ideal path, by cross-correlation along z over each "
      "completed pass (training and test), and its root-mean-square distance from the ideal "
      "position: in space, and without the direction of the force.");
  Rows rows;
  for (const auto& session : study.sessions) {
    rows.push_back(tracking_row(session.tracking));
  }
  rows.push_back(tracking_row(study.tracking));
  document.table({"Subject", "Passes", "Lag", "SD of lag", "RMS error", "RMS error in plane"},
                 rows);
  if (study.tracking.passes_without_lag > 0) {
    document.paragraph(counted(study.tracking.passes_without_lag, "pass") +
                       " gave no lag: the path did not vary or no peak was found.");
  }
}

std::string microseconds(const Defined<TimingPercentiles>& p) {
  if (!p) {
    return "not defined, because " + p.because();
  }
  const auto us = [](std::int64_t ns) { return number(1e-3 * static_cast<double>(ns)); };
  return fmt::format("{} / {} / {} / {}", us(p->median_ns), us(p->p99_ns), us(p->p999_ns),
                     us(p->highest_ns));
}

// On a simulated clock only completeness says anything.
std::vector<std::string> timing_row(const SessionSummary& session, bool percentiles) {
  const auto& t = session.timing;
  std::vector<std::string> row{session.info.subject, session.info.clock};
  const auto count = [&](std::uint64_t n) { return t.complete ? std::to_string(n) : "unknown"; };
  row.insert(row.end(), {count(t.ticks), count(t.dropped), count(t.missing)});
  if (percentiles) {
    row.insert(
        row.end(),
        {t.applies ? count(t.overruns) : "-", t.applies ? microseconds(t.period) : "-",
         t.applies ? microseconds(t.lateness) : "-", t.applies ? microseconds(t.compute) : "-"});
  }
  return row;
}

void add_timing(Document& document, const StudyResult& study) {
  document.heading("Timing of the servo loop");
  std::vector<std::string> simulated;
  std::vector<std::string> unfinished;
  for (const auto& session : study.sessions) {
    if (!session.timing.applies) {
      simulated.push_back(session.info.subject);
    }
    if (!session.timing.complete) {
      unfinished.push_back(session.info.subject);
    }
  }
  const bool real = simulated.size() < study.sessions.size();
  if (!simulated.empty()) {
    document.paragraph("Timing does not apply to " +
                       (real ? joined(simulated) : std::string("these sessions")) +
                       ": on a simulated clock every tick takes exactly one period.");
  }
  if (!unfinished.empty()) {
    document.paragraph(
        "Not counted, because the session did not come to its end: " + joined(unfinished) + ".");
  }
  std::vector<std::string> names{"Subject", "Clock", "Ticks", "Lost records", "Missing"};
  if (real) {
    names.insert(names.end(), {"Overruns", "Period", "Lateness", "Compute"});
    document.paragraph(
        "Times in microseconds: median / 99 % / 99.9 % / highest, each the upper edge of the bin "
        "of the histogram that holds it.");
  }
  Rows rows;
  for (const auto& session : study.sessions) {
    rows.push_back(timing_row(session, real));
    const auto late = record::too_many_overruns(session.timing.ticks, session.timing.overruns);
    if (session.timing.applies && late) {
      document.alarm(fmt::format("The servo loop of {} did not keep its rate: {}.",
                                 session.info.subject, *late));
    }
  }
  document.table(names, rows);
}

}  // namespace

void add_quality(Document& document, const StudyResult& study,
                 const std::vector<Drawing>& drawings) {
  if (!study.curves_from.empty()) {
    return;  // nothing is known of how they were recorded
  }
  add_trial_quality(document, study);
  document.heading("A stimulus");
  add_picture(document, drawings, "figure-22-trajectory");
  add_picture(document, drawings, "figure-23-force-pattern");
  study.over_path ? add_pace(document, study) : add_tracking(document, study);
  add_timing(document, study);
}

}  // namespace haptrial::analysis
