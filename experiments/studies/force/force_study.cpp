#include "experiments/studies/force/force_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "analysis/exchange/own_findings.h"
#include "analysis/force_training/report/write_analysis.h"
#include "analysis/force_training/study/study.h"
#include "analysis/force_training/study/study_result.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "experiments/preview/tried_trial.h"
#include "experiments/studies/force/force_preview.h"
#include "experiments/studies/force/force_study_simulation.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_protocol.h"
#include "protocols/force_training/guided_passes.h"
#include "protocols/force_training/recorded_pass.h"

namespace haptrial::experiments {
namespace {

using protocols::ForceDefinition;
using protocols::GuidedPass;
using protocols::GuidedTrial;
using record::Phase;

class TriedTraining final : public TriedPass {
 public:
  TriedTraining(const ForceDefinition& d, GuidedTrial trial)
      : TriedPass(d, trial.stimulus.path.points().front()), d_(d), trial_(std::move(trial)) {
    choose(0);
  }

  std::vector<std::string> stages() const override {
    std::vector<std::string> names;
    for (const GuidedPass& pass : trial_.passes) {
      names.emplace_back(pass.phase.name());
    }
    return names;
  }
  std::vector<SpaceObject> objects() const override {
    return {{"path", 0, lines_of(trial_.stimulus.path.points())}};
  }
  void choose(std::size_t stage) override {
    phase_ = trial_.passes[stage].phase;
    begin(
        make_pass(trial_.plan.condition, phase_, trial_.stimulus, d_.guidance, trial_.plan.block));
  }
  std::string now() const override {
    if (is_over()) {
      return fmt::format("{}: over", phase_.name());
    }
    return fmt::format("{}: {}, target force {:.2f} N", phase_.name(), name_of(output().stage),
                       output().target_force);
  }

 private:
  void before_tick() override {
    if (is_over() && phase_ == Phase::kTraining) {
      choose(1);
    }
  }

  const ForceDefinition& d_;
  GuidedTrial trial_;
  Phase phase_{Phase::kTraining};
};

/// Training and test of a trial, by the passes of sessions; the test begins when the training is
/// over. @param definition  outlives the trial  @throws InputError for a trial beyond the session
std::shared_ptr<TriedTrial> tried_training(const ForceDefinition& definition,
                                           const PreviewRequest& request) {
  return std::make_shared<TriedTraining>(
      definition,
      protocols::guided_trial(definition, previewed_session(request.seed), request.trial));
}

}  // namespace

namespace fs = std::filesystem;
namespace {

/// Sentences about sessions that the study planned and the folder lacks.
std::vector<std::string> what_is_missing(const fs::path& folder, const analysis::StudyResult& study,
                                         const protocols::ForceDefinition& definition) {
  std::vector<std::string> remarks;
  std::map<std::string, std::set<int>> there;
  for (const analysis::SessionSummary& session : study.sessions) {
    there[session.info.subject].insert(static_cast<int>(session.info.session));
  }
  const auto planned = static_cast<std::size_t>(definition.design.participants);
  if (there.size() != planned) {
    remarks.push_back(fmt::format("{} of {} planned participants {} a session in this folder.",
                                  there.size(), planned, there.size() == 1 ? "has" : "have"));
  }
  for (const auto& [subject, sessions] : there) {
    for (int session = 1; definition.sessions() > 1 && session <= definition.sessions();
         ++session) {
      if (!sessions.contains(session) && definition.comes(session, study.groups.at(subject))) {
        remarks.push_back(
            fmt::format("{} has no session {}.", subject, definition.session_name(session)));
      }
    }
  }
  if (const auto unfinished = unfinished_sessions(folder); !unfinished.empty()) {
    remarks.push_back(fmt::format("Not analysed, because the session is unfinished: {}.",
                                  fmt::join(unfinished, ", ")));
  }
  return remarks;
}

/// The definition's score, unless an analysis was given other shares; then `remarks` say so.
analysis::ScoreParameters scoring_for(const std::filesystem::path& shares,
                                      analysis::ScoreParameters scoring,
                                      std::vector<std::string>& remarks) {
  if (shares.empty()) {
    return scoring;
  }
  remarks.push_back(
      fmt::format("The shares of the score were given to analyze ({}), not stated in the "
                  "definition.",
                  shares.filename().string()));
  return analysis::with_shares_of(shares, std::move(scoring));
}

/// Marks every test of a study that a rule ends.
void mark_rule(analysis::StudyResult& study) {
  study.statistics.tests.ends_by_rule = true;
  if (study.path) {
    study.path->tests.ends_by_rule = true;
  }
  for (analysis::LearnedOutcome& outcome : study.learned.outcomes) {
    outcome.tests.ends_by_rule = true;
  }
}

analysis::StudyResult analyzed(const AnalysisRequest& request) {
  const StudyFiles& found = request.files;
  const record::SessionInfo& first = found.first;
  const auto definition =
      protocols::parse_force_definition(first.definition, first.definition_name);
  CurveAnalysis curves = curve_analysis_of(definition);
  std::vector<std::string> remarks;
  curves.plan = plan_for(request.planned, request.reference, curves.plan, remarks);
  curves.scoring = scoring_for(request.shares, curves.scoring, remarks);
  const analysis::AnalysisPlan& plan = curves.plan;
  analysis::StudyResult study = analyze_training(definition, curves, found.files, request.threads);
  if (study.scores.empty()) {
    throw InputError(
        fmt::format("{}: no session {}holds a completed test pass, so nothing can be scored",
                    request.folder.string(), study.tests.empty() ? "" : "that trains "));
  }
  analysis::check_plan(study.statistics.table, plan_of(request.planned, request.reference));
  if (plan.sequential) {
    mark_rule(study);
    study.statistics.tests.sequential = analysis::sequential_result(
        study.statistics.table, analysis::decisive_test(plan), *plan.sequential,
        complete_participants(found.files, definition),
        static_cast<std::size_t>(definition.design.participants));
  }
  study.remarks = found.remarks;
  study.remarks.insert(study.remarks.end(), remarks.begin(), remarks.end());
  if (request.pilots == Pilots::kLeftOut) {
    for (std::string& remark : what_is_missing(request.folder, study, definition)) {
      study.remarks.push_back(std::move(remark));
    }
  }
  return study;
}

class ForceStudy final : public Study {
 public:
  const protocols::Protocol& protocol() const override { return protocols::force_training(); }
  void read_analysis(Table& root, const protocols::Definition* definition,
                     bool fresh) const override {
    read_curve_analysis(root, definition, fresh);
  }
  std::vector<std::string> analysis_warnings(const protocols::Definition& d) const override {
    const CurveAnalysis curves = curve_analysis_of(d);
    std::vector<std::string> warnings = warnings_of(curves.scoring);
    std::ranges::move(analysis::sequential_warnings(curves.plan, d.design.participants),
                      std::back_inserter(warnings));
    return warnings;
  }
  std::optional<CurveAnalysis> curves(const record::SessionInfo& session) const override {
    return curve_analysis_of(
        protocols::parse_force_definition(session.definition, session.definition_name));
  }
  void add_preview(const protocols::Definition& definition, const PreviewRequest& request,
                   Preview& preview) const override {
    add_force_preview(dynamic_cast<const protocols::ForceDefinition&>(definition), request,
                      preview);
  }
  std::shared_ptr<TriedTrial> tried_trial(const protocols::Definition& definition,
                                          const PreviewRequest& request) const override {
    return tried_training(dynamic_cast<const protocols::ForceDefinition&>(definition), request);
  }
  void add_methods(const protocols::Definition& definition, std::uint64_t seed,
                   analysis::Document& document) const override {
    add_force_methods(dynamic_cast<const protocols::ForceDefinition&>(definition), seed, document);
  }
  std::vector<std::string> analyze(const AnalysisRequest& request) const override {
    const analysis::StudyResult study = analyzed(request);
    const auto own = analysis::own_findings(request.files.files);
    analysis::write_analysis(study, request.out, request.paper, own);
    std::vector<std::string> lines = analysis::summary_lines(study);
    for (const analysis::FindingList& list : own) {
      std::ranges::move(analysis::lines_of(list), std::back_inserter(lines));
    }
    lines.insert(lines.end(), study.remarks.begin(), study.remarks.end());
    lines.insert(lines.end(), study.alarms.begin(), study.alarms.end());
    return lines;
  }
  std::optional<analysis::SequentialResult> sequential(
      const AnalysisRequest& request) const override {
    return analyzed(request).statistics.tests.sequential;
  }
  std::unique_ptr<StudySimulation> study_simulation(const protocols::Definition& definition,
                                                    const std::string& asked_in,
                                                    const std::string& watched) const override {
    static_cast<void>(watched);  // all of its tests are quick
    return force_study_simulation(dynamic_cast<const protocols::ForceDefinition&>(definition),
                                  asked_in, curve_analysis_of(definition));
  }
};

}  // namespace

const Study& force_study() {
  static const ForceStudy study;
  return study;
}

}  // namespace haptrial::experiments
