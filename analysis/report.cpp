#include "analysis/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "analysis/html.h"
#include "analysis/report_style.h"
#include "analysis/wording.h"

namespace haptrial::analysis {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string paragraph(const std::string& text) { return "<p>" + escape_html(text) + "</p>\n"; }

std::string heading(const std::string& text) { return "<h2>" + escape_html(text) + "</h2>\n"; }

std::string subheading(const std::string& text) { return "<h3>" + escape_html(text) + "</h3>\n"; }

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) {
    text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

// The figure of that name, or nothing when the study has none.
std::string picture(const std::vector<Drawing>& drawings, const std::string& name) {
  for (const auto& [figure, svg] : drawings) {
    if (figure.name == name) {
      return fmt::format("<figure>\n{}\n<figcaption>{}</figcaption>\n</figure>\n",
                         inline_svg(svg, name, figure.title + ". " + figure.alt),
                         escape_html(figure.caption));
    }
  }
  return {};
}

std::string opening(const StudyResult& study) {
  const auto& s = study.statistics;
  std::string html = "<h1>Recall of force patterns</h1>\n<p class=\"lead\">" +
                     escape_html(fmt::format(
                         "{} of {} under {}. Each trial trained a force pattern and then asked for "
                         "it; the recall error is 0 for a perfect recall and grows with the "
                         "difference that remains after aligning the two curves in time.",
                         counted(study.scores.size(), "scored recall trial"),
                         counted(study.sessions.size(), "participant"),
                         counted(s.conditions.size(), "training condition"))) +
                     "</p>\n";
  if (study.simulated()) {
    html +=
        "<div class=\"banner\">SIMULATED PARTICIPANTS: these data come from virtual subjects. They "
        "say how the experiment and its analysis work, not how people learn.</div>\n";
  }
  return html;
}

std::string lines_that_matter(const StudyResult& study) {
  std::string html = "<ul class=\"lines\">\n";
  for (const auto& line : summary_lines(study)) {
    html += "<li>" + escape_html(line) + "</li>\n";
  }
  return html + "</ul>\n";
}

std::string design(const StudyResult& study) {
  std::string html = heading("Design and exclusions");
  std::size_t blocks = 0;
  std::set<std::pair<std::string, std::int32_t>> seen;
  for (const auto& score : study.scores) {
    blocks += seen.insert({score.subject, score.block}).second ? 1 : 0;
  }
  html += paragraph(fmt::format(
      "Training conditions: {}. The scored trials lie in {} that repeat one trajectory and force "
      "pattern under one training condition.",
      joined(study.statistics.conditions), counted(blocks, "block")));
  Rows rows;
  for (const auto& session : study.sessions) {
    rows.push_back({session.info.subject, session.file, session.info.device, session.info.start_utc,
                    std::to_string(session.test_passes), std::to_string(session.scored)});
  }
  html += html_table({"Subject", "File", "Device", "Start", "Test passes", "Scored"}, rows);
  for (const std::string& remark : study.remarks) {
    html += paragraph(remark);
  }
  if (study.exclusions.empty()) {
    return html + paragraph("No trial was excluded.");
  }
  std::map<std::string, std::size_t> reasons;
  for (const auto& e : study.exclusions) {
    ++reasons[e.reason];
  }
  html += paragraph("Without a score: " + counted(study.exclusions.size(), "test pass") + ".");
  rows.clear();
  for (const auto& [reason, count] : reasons) {
    rows.push_back({reason, std::to_string(count)});
  }
  html += html_table({"Reason", "Passes"}, rows);
  rows.clear();
  for (const auto& e : study.exclusions) {
    rows.push_back({e.subject, std::to_string(e.trial), e.reason});
  }
  return html + "<details><summary>Every exclusion</summary>\n" +
         html_table({"Subject", "Trial", "Reason"}, rows) + "</details>\n";
}

std::string interval(const Defined<MeanInterval>& i) {
  return i ? fmt::format("{} to {}", number(i->low), number(i->high))
           : "not defined, because " + i.because();
}

std::string recall(const StudyResult& study, const std::vector<Drawing>& drawings) {
  std::string html = heading("Recall error by training condition");
  html += picture(drawings, "figure-28-recall-error");
  Rows rows;
  for (const auto& s : study.statistics.summaries) {
    rows.push_back({capitalized(s.condition), std::to_string(s.count), quantity(s.mean, 1.0, ""),
                    s.trials ? number(s.trials->deviation) : "-", interval(s.trials),
                    interval(s.participants)});
  }
  return html + html_table({"Condition", "Trials", "Mean", "SD", "95 % CI, pooled trials",
                            "95 % CI, participants' means"},
                           rows);
}

std::string published(const StudyStatistics& s) {
  std::string html = subheading("As published: pooled trials");
  html += paragraph("One-way analysis of variance over all trials: " + anova_result(s.anova) + ".");
  Rows rows;
  for (const auto& c : s.comparisons) {
    rows.push_back({c.better + " < " + c.worse, t_result(c.pooled), t_result(c.welch)});
  }
  return html + html_table({"Hypothesis (one-tailed)", "Student", "Welch"}, rows);
}

std::string repeated(const StudyStatistics& s) {
  std::string html = subheading("Repeated measures: participants' means");
  html += paragraph(
      "The trials of one participant are not independent, so the pooled tests count more evidence "
      "than there is; here every participant gives one mean for each condition, and conditions are "
      "compared within participants.");
  html += paragraph("One-way repeated-measures analysis of variance: " + anova_result(s.repeated) +
                    ".");
  if (!s.incomplete.empty()) {
    html += paragraph(
        "Left out for lack of a scored trial in some condition: " + joined(s.incomplete) + ".");
  }
  Rows rows;
  for (const auto& c : s.comparisons) {
    rows.push_back({c.better + " < " + c.worse, t_result(c.paired),
                    c.paired_holm ? p_value(*c.paired_holm)
                                  : "not defined, because " + c.paired_holm.because()});
  }
  return html + html_table({"Hypothesis (one-tailed)", "Paired t-test", "After Holm"}, rows);
}

std::string analyses(const StudyResult& study) {
  return heading("Analyses") + published(study.statistics) + repeated(study.statistics);
}

std::string table_1(const StudyStatistics& s) {
  std::string html = heading("Table 1: best and worst condition of each participant");
  if (s.table_1.empty()) {
    return html + paragraph("No participant has a scored trial in every condition.");
  }
  std::vector<std::string> names{"Subject", "Best", "Worst"};
  for (const auto& condition : s.conditions) {
    names.push_back("Mean, " + condition);
  }
  std::map<std::string, std::pair<std::size_t, std::size_t>> counts;
  for (const auto& condition : s.conditions) {
    counts[condition] = {0, 0};
  }
  Rows rows;
  for (const auto& row : s.table_1) {
    rows.push_back({row.subject, row.best, row.worst});
    for (const double mean : row.means) {
      rows.back().push_back(number(mean));
    }
    ++counts[row.best].first;
    ++counts[row.worst].second;
  }
  html += html_table(names, rows);
  for (const auto& [condition, count] : counts) {
    html +=
        paragraph(fmt::format("{}: best for {} and worst for {} of {}.", capitalized(condition),
                              count.first, count.second, counted(s.table_1.size(), "participant")));
  }
  return html;
}

std::string learning(const std::vector<Drawing>& drawings) {
  return heading("Learning within a block") + picture(drawings, "learning");
}

std::string alignments(const StudyResult& study, const std::vector<Drawing>& drawings) {
  std::string html = heading("How recalls were aligned");
  for (const auto& recall_picture : study.recalls) {
    html += subheading(fmt::format("The {} recall", recall_picture.which));
    html += picture(drawings, "figure-26-alignment-" + recall_picture.which);
    html += picture(drawings, "figure-27-warped-" + recall_picture.which);
  }
  return html;
}

std::string stimuli(const std::vector<Drawing>& drawings) {
  return heading("A stimulus") + picture(drawings, "figure-22-trajectory") +
         picture(drawings, "figure-23-force-pattern");
}

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

std::string pace(const StudyResult& study) {
  std::string html = heading("Pace and distance from the path");
  html += paragraph(
      "The participants moved along the path at their own pace, so forces are compared over the "
      "place on the path and not over time. How long a run took, over the completed passes "
      "(training and test), and the hand's root-mean-square distance from the nearest place of the "
      "path: in space, and without the direction of the force.");
  Rows rows;
  for (const auto& session : study.sessions) {
    rows.push_back(pace_row(session.tracking));
  }
  rows.push_back(pace_row(study.tracking));
  return html + html_table({"Subject", "Passes", "Run", "SD of run", "RMS distance",
                            "RMS distance in plane"},
                           rows);
}

std::string tracking(const StudyResult& study) {
  if (study.over_path) {
    return pace(study);
  }
  std::string html = heading("Tracking of the trajectory");
  html += paragraph(
      "How far the hand lagged behind the ideal path, by cross-correlation along z over each "
      "completed pass (training and test), and its root-mean-square distance from the ideal "
      "position: in space, and without the direction of the force.");
  Rows rows;
  for (const auto& session : study.sessions) {
    rows.push_back(tracking_row(session.tracking));
  }
  rows.push_back(tracking_row(study.tracking));
  html += html_table({"Subject", "Passes", "Lag", "SD of lag", "RMS error", "RMS error in plane"},
                     rows);
  if (study.tracking.passes_without_lag > 0) {
    html += paragraph(counted(study.tracking.passes_without_lag, "pass") +
                      " gave no lag: the path did not vary or no peak was found.");
  }
  return html;
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

std::string timing(const StudyResult& study) {
  std::string html = heading("Timing of the servo loop");
  std::vector<std::string> names{"Subject", "Clock", "Ticks", "Dropped", "Missing"};
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
    html += paragraph("Timing does not apply to " + (real ? joined(simulated) : "these sessions") +
                      ": on a simulated clock every tick takes exactly one period.");
  }
  if (!unfinished.empty()) {
    html += paragraph(
        "Not counted, because the session did not come to its end: " + joined(unfinished) + ".");
  }
  if (real) {
    names.insert(names.end(), {"Overruns", "Period", "Lateness", "Compute"});
    html += paragraph(
        "Times in microseconds: median / 99 % / 99.9 % / highest, each the upper edge of the bin "
        "of the histogram that holds it.");
  }
  Rows rows;
  for (const auto& session : study.sessions) {
    rows.push_back(timing_row(session, real));
  }
  return html + html_table(names, rows);
}

std::string versions(const StudyResult& study) {
  std::string html = heading("Parameters and versions");
  Rows rows;
  for (const auto& [name, value] : study.parameters) {
    rows.push_back({name, value});
  }
  html += html_table({"Parameter of the score", "Value"}, rows);
  std::set<std::string> programs;
  std::map<std::string, std::string> definitions;  // text to name
  for (const auto& session : study.sessions) {
    programs.insert(session.info.program_version + " (" + session.info.program_commit + ")");
    definitions.emplace(session.info.definition, session.info.definition_name);
  }
  html += paragraph("Recorded by haptrial " + joined({programs.begin(), programs.end()}) + ".");
  if (definitions.size() > 1) {
    html += paragraph(
        fmt::format("The sessions come from {} different definitions.", definitions.size()));
  }
  for (const auto& [text, name] : definitions) {
    html += fmt::format("<details><summary>Definition {}</summary>\n<pre>{}</pre></details>\n",
                        escape_html(name), escape_html(text));
  }
  return html;
}

}  // namespace

std::string html_report(const StudyResult& study, const std::vector<Drawing>& drawings) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}Recall of force patterns</title>\n<style>{}</style>\n</head>\n<body>\n",
      study.simulated() ? "SIMULATED: " : "", kReportStyle);
  html += opening(study) + lines_that_matter(study) + design(study) + recall(study, drawings) +
          analyses(study) + table_1(study.statistics) + learning(drawings) +
          alignments(study, drawings) + stimuli(drawings) + tracking(study) + timing(study) +
          versions(study);
  return html + "</body>\n</html>\n";
}

}  // namespace haptrial::analysis
