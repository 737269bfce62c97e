#include "experiments/studies/trials_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/trials/data/read_trials.h"
#include "analysis/trials/psychometric/trials_study.h"
#include "analysis/trials/report/trials_words.h"
#include "analysis/trials/report/write_trials.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "experiments/studies/live_trials.h"
#include "experiments/studies/reaching/reach_ways.h"
#include "experiments/studies/trials_analysis.h"
#include "protocols/trials/definition/trials_definition.h"
#include "protocols/trials/trials_protocol.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
namespace trials = analysis::trials;
using protocols::TrialsDefinition;

const TrialsDefinition& trials_of(const protocols::Definition& definition) {
  return dynamic_cast<const TrialsDefinition&>(definition);
}

/// As a session keeps it: what it was recorded with.
std::unique_ptr<protocols::Definition> definition_of(const record::SessionInfo& info) {
  Table root = Table::parse(info.definition, info.definition_name);
  auto definition = protocols::trials_protocol().read(root, info.definition_name, nullptr);
  root.check();
  return definition;
}

trials::TrialsPlan plan_of_text(const std::string& text, const std::string& file_name) {
  Table root = Table::parse(text, file_name);
  trials::TrialsPlan plan = read_trials_analysis(root);
  root.check();
  return plan;
}

/// Tests that were given to analyze stand in place of the definition's.
void take_planned(const AnalysisRequest& request, trials::TrialsPlan& plan,
                  std::vector<std::string>& remarks) {
  if (!request.reference.empty()) {
    throw InputError(
        "--reference names a condition of force curves; trials compare every two conditions, so "
        "leave it out");
  }
  if (!request.planned.empty()) {
    plan.plan = analysis::parse_analysis_plan(request.planned, "", "--planned");
    remarks.emplace_back("The planned tests were given to analyze, not stated in the definition.");
  }
}

/// Sentences about sessions that the study planned and the folder lacks.
void add_missing(const AnalysisRequest& request, const TrialsDefinition& definition,
                 std::vector<std::string>& remarks) {
  const std::size_t sessions = request.files.files.size();
  const auto planned = static_cast<std::size_t>(definition.design.participants);
  if (request.pilots == Pilots::kLeftOut && sessions < planned) {
    remarks.push_back(fmt::format("{} of {} planned participants {} a session in this folder.",
                                  sessions, planned, sessions == 1 ? "has" : "have"));
  }
  if (const auto unfinished = unfinished_sessions(request.folder); !unfinished.empty()) {
    remarks.push_back(fmt::format("Not analysed, because the session is unfinished: {}.",
                                  fmt::join(unfinished, ", ")));
  }
}

class TrialsStudy final : public Study {
 public:
  const protocols::Protocol& protocol() const override { return protocols::trials_protocol(); }
  void read_analysis(Table& root, bool) const override { read_trials_analysis(root); }
  std::vector<std::string> analysis_warnings(const protocols::Definition& d) const override;
  std::unique_ptr<record::LiveFigures> live_figures(const protocols::Definition& definition,
                                                    const fs::path& resumed) const override {
    const TrialsDefinition& d = trials_of(definition);
    return std::make_unique<LiveTrials>(d.tracks.empty() ? std::string() : d.tracks.front().unit,
                                        resumed);
  }
  std::vector<std::string> analyze(const AnalysisRequest& request) const override;
};

std::vector<std::string> TrialsStudy::analysis_warnings(const protocols::Definition& d) const {
  const trials::TrialsPlan plan = plan_of_text(d.text, d.file_name);
  std::vector<std::string> warnings;
  for (const protocols::Track& track : trials_of(d).tracks) {
    const bool outside = plan.function.axis.scale != psychometric::Scale::kLinear &&
                         track.low <= plan.function.axis.origin;
    if (plan.functions && outside) {
      warnings.push_back(
          fmt::format("levels of {} begin at {:g}, but the axis of analysis.function begins above "
                      "{:g}; levels up to there are left out of the function",
                      track.name, track.low, plan.function.axis.origin));
    }
  }
  return warnings;
}

std::vector<std::string> TrialsStudy::analyze(const AnalysisRequest& request) const {
  const record::SessionInfo& first = request.files.first;
  const auto owned = definition_of(first);
  const TrialsDefinition& definition = trials_of(*owned);
  trials::TrialsPlan plan = plan_of_text(first.definition, first.definition_name);
  std::vector<std::string> remarks = request.files.remarks;
  take_planned(request, plan, remarks);
  add_missing(request, definition, remarks);
  const auto group_of = [&](const std::string& subject) {
    return definition.groups.size() > 1 ? protocols::group_of(definition.groups, subject)
                                        : std::string();
  };
  trials::TrialsResult result =
      trials::analyze(trials::read_trials(request.files.files, group_of, request.threads), plan,
                      procedures_of(definition), request.threads);
  for (const trials::Quantity& q : result.quantities) {
    if (q.compared) {
      analysis::check_plan(q.table, plan.plan);
    }
  }
  if (plan.kind == trials::AnalysisKind::kReaching) {
    const auto ways = reach_ways(definition, result.data, plan.reaching);
    result.reaching = trials::reaching_study(
        result.data,
        trials::study_reaches(result.data, request.files.files, ways, plan.reaching.stage,
                              plan.reaching.clamp, request.threads),
        plan.reaching, request.threads);
  }
  result.page_scores = trials::page_scores(request.files.files, definition.pages, group_of);
  result.title = definition.name;
  result.remarks = std::move(remarks);
  result.definition = first.definition;
  result.definition_name = first.definition_name;
  trials::write_trials(result, request.out);
  std::vector<std::string> lines = trials::summary_lines(result);
  lines.insert(lines.end(), result.remarks.begin(), result.remarks.end());
  return lines;
}

}  // namespace

const Study& trials_study() {
  static const TrialsStudy study;
  return study;
}

}  // namespace haptrial::experiments
