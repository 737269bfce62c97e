#include "analysis/force_training/study/study_result.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/statistics/design/design_lines.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis {

bool StudyResult::simulated() const {
  return std::any_of(sessions.begin(), sessions.end(),
                     [](const auto& session) { return session.info.simulated; });
}

namespace {

std::string line_of(const ConditionSummary& s, const std::string& participants) {
  const bool only_a_mean = !s.participants && s.mean;
  return fmt::format("{}: mean recall error {} ({}, {})", capitalized(s.condition),
                     only_a_mean ? number(*s.mean) : mean_with_interval(s.participants),
                     counted(s.people, participants), counted(s.count, "trial"));
}

}  // namespace

std::vector<std::string> summary_lines(const StudyResult& study) {
  const auto& statistics = study.statistics;
  const char* participants = study.simulated() ? "simulated participant" : "participant";
  std::vector<std::string> lines;
  for (const auto& s : statistics.summaries) {
    lines.push_back(line_of(s, participants));
  }
  for (const auto& more : {effect_lines(statistics.tests), planned_lines(statistics.tests),
                           unplanned_lines(statistics.tests)}) {
    lines.insert(lines.end(), more.begin(), more.end());
  }
  if (study.path) {
    for (const ConditionSummary& s : study.path->summaries) {
      lines.push_back(fmt::format(
          "{}: mean path error {} mm", capitalized(s.condition),
          s.participants ? mean_with_interval(s.participants) : quantity(s.mean, 1.0, "")));
    }
    for (const std::string& line : planned_lines(study.path->tests)) {
      lines.push_back("Path error, " + line);
    }
  }
  for (const std::string& line : learning_lines(study.learned)) {
    lines.push_back(line);
  }
  return lines;
}

}  // namespace haptrial::analysis
