#include <fmt/format.h>

#include <cmath>

#include "analysis/force_training/report/report_parts.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis {
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

}  // namespace haptrial::analysis
