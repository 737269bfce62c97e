#include <fmt/format.h>

#include <map>
#include <set>

#include "analysis/force_training/report/report_parts.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis {
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

}  // namespace haptrial::analysis
