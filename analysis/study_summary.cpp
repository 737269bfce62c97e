#include <fmt/format.h>

#include <algorithm>

#include "analysis/study.h"
#include "analysis/wording.h"

namespace haptrial::analysis {

bool StudyResult::simulated() const {
  return std::any_of(sessions.begin(), sessions.end(),
                     [](const auto& session) { return session.info.simulated; });
}

std::vector<std::string> summary_lines(const StudyResult& study) {
  const auto& statistics = study.statistics;
  const char* participants = study.simulated() ? "simulated participant" : "participant";
  std::vector<std::string> lines;
  for (const auto& s : statistics.summaries) {
    lines.push_back(fmt::format("{}: mean recall error {} ({}, {})", capitalized(s.condition),
                                mean_with_interval(s.trials), counted(s.count, "trial"),
                                counted(statistics.subjects.size(), participants)));
  }
  lines.push_back(fmt::format("Analysis of variance: pooled trials {}; repeated measures {}",
                              anova_result(statistics.anova), anova_result(statistics.repeated)));
  std::string tests;
  for (const auto& c : statistics.comparisons) {
    tests += fmt::format("{}{} below {} {}", tests.empty() ? "" : "; ", c.better, c.worse,
                         t_result(c.pooled));
  }
  if (!tests.empty()) {
    lines.push_back("One-tailed t-tests on pooled trials: " + tests);
  }
  return lines;
}

}  // namespace haptrial::analysis
