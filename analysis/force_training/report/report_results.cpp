#include <fmt/format.h>

#include <map>
#include <set>

#include "analysis/force_training/report/report_parts.h"
#include "analysis/force_training/study/order_balance.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis {
namespace {

using Rows = std::vector<std::vector<std::string>>;

void add_sessions(Document& document, const StudyResult& study) {
  Rows rows;
  for (const auto& session : study.sessions) {
    rows.push_back({session.info.subject, session.file, session.info.device, session.info.start_utc,
                    std::to_string(session.test_passes), std::to_string(session.scored)});
  }
  document.table({"Subject", "File", "Device", "Start", "Test passes", "Scored"}, rows);
}

void add_curves(Document& document, const StudyResult& study) {
  document.paragraph("The curves were not recorded by haptrial; " + study.curves_from +
                     " says of which trial each is. Nothing is known here of devices, tracking and "
                     "timing, nor of trials that the table leaves out.");
  Rows rows;
  for (const auto& session : study.sessions) {
    rows.push_back({session.info.subject, std::to_string(session.scored)});
  }
  document.table({"Subject", "Scored"}, rows);
}

void add_exclusions(Document& document, const StudyResult& study) {
  if (study.exclusions.empty()) {
    document.paragraph("No trial was excluded.");
    return;
  }
  std::map<std::string, std::size_t> reasons;
  Rows every;
  for (const auto& e : study.exclusions) {
    ++reasons[e.reason];
    every.push_back({e.subject, std::to_string(e.trial), e.reason});
  }
  document.paragraph("Without a score: " + counted(study.exclusions.size(), "test pass") + ".");
  Rows rows;
  for (const auto& [reason, count] : reasons) {
    rows.push_back({reason, std::to_string(count)});
  }
  document.table({"Reason", "Passes"}, rows);
  document.table({"Subject", "Trial", "Reason"}, every, "Every exclusion");
}

std::string interval(const Defined<MeanInterval>& i) {
  return i ? fmt::format("{} to {}", number(i->low), number(i->high))
           : "not defined, because " + i.because();
}

void add_table_1(Document& document, const StudyStatistics& s) {
  document.heading("Table 1: best and worst condition of each participant by mean recall error");
  if (s.table_1.empty()) {
    document.paragraph("No participant has a scored trial in every condition.");
    return;
  }
  std::vector<std::string> names{"Subject", "Best", "Worst"};
  std::map<std::string, std::pair<std::size_t, std::size_t>> counts;
  for (const auto& condition : s.conditions) {
    names.push_back("Mean, " + condition);
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
  document.table(names, rows);
  for (const auto& [condition, count] : counts) {
    document.paragraph(fmt::format("{}: best for {} and worst for {} of {}.",
                                   capitalized(condition), count.first, count.second,
                                   counted(s.table_1.size(), "participant")));
  }
}

}  // namespace

void add_design(Document& document, const StudyResult& study) {
  document.heading("Design and exclusions");
  std::set<std::pair<std::string, std::int32_t>> blocks;
  for (const auto& score : study.scores) {
    blocks.insert({score.subject, score.block});
  }
  document.paragraph(fmt::format("Varied {}.", study.statistics.tests.design));
  if (study.curves_from.empty()) {
    document.paragraph(
        fmt::format("The scored trials belong to {}; in each, one trajectory and force pattern are "
                    "repeated under "
                    "one training condition.",
                    counted(blocks.size(), "block")));
  }
  if (study.statistics.table.factors.size() == 1 && study.statistics.table.factors[0].within &&
      blocks.size() > study.statistics.subjects.size()) {
    document.paragraph(sentence_of(order_balance(study.scores, study.statistics.conditions)));
  }
  study.curves_from.empty() ? add_sessions(document, study) : add_curves(document, study);
  for (const std::string& remark : study.remarks) {
    document.paragraph(remark);
  }
  add_exclusions(document, study);
}

void add_recall(Document& document, const StudyResult& study,
                const std::vector<Drawing>& drawings) {
  document.heading("Recall error by training condition");
  add_picture(document, drawings, "figure-28-recall-error");
  add_picture(document, drawings, "interaction");
  Rows rows;
  for (const auto& s : study.statistics.summaries) {
    rows.push_back({capitalized(s.condition), std::to_string(s.people),
                    s.participants ? number(s.participants->mean) : quantity(s.mean, 1.0, ""),
                    s.participants ? number(s.participants->deviation) : "-",
                    interval(s.participants), std::to_string(s.count), quantity(s.mean, 1.0, ""),
                    s.trials ? number(s.trials->deviation) : "-", interval(s.trials)});
  }
  document.table({"Condition", "Participants", "Mean", "SD", "95 % CI", "Trials",
                  "Mean, pooled trials", "SD, pooled trials", "95 % CI, pooled trials"},
                 rows);
  if (study.statistics.table.factors.size() == 1 && study.statistics.table.factors[0].within) {
    add_table_1(document, study.statistics);
  }
}

void add_learning(Document& document, const StudyResult& study,
                  const std::vector<Drawing>& drawings) {
  document.heading("Learning");
  add_picture(document, drawings, "learning");
  add_picture(document, drawings, "learning-over-blocks");
  const auto& slope = study.statistics.slope;
  document.paragraph(
      slope ? fmt::format("From one block to the next the recall error changed by {} (the mean of "
                          "the participants' own regression slopes, 95 % CI {} to {}).",
                          number(slope->mean), number(slope->low), number(slope->high))
            : "The change from block to block is not defined, because " + slope.because() + ".");
}

void add_alignments(Document& document, const StudyResult& study,
                    const std::vector<Drawing>& drawings) {
  document.heading("How recalls were aligned");
  for (const auto& recall : study.recalls) {
    document.subheading(fmt::format("The {} recall", recall.which));
    add_picture(document, drawings, "figure-26-alignment-" + recall.which);
    add_picture(document, drawings, "figure-27-warped-" + recall.which);
  }
}

}  // namespace haptrial::analysis
