#include "analysis/force_training/report/report.h"

#include <fmt/format.h>

#include "analysis/force_training/report/report_parts.h"
#include "analysis/force_training/study/study_summary.h"
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

}  // namespace haptrial::analysis
