#include "experiments/studies/psychophysics/trials_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "analysis/exchange/own_findings.h"
#include "analysis/psychophysics/data/presented_files.h"
#include "analysis/psychophysics/data/read_trials.h"
#include "analysis/psychophysics/report/trials_words.h"
#include "analysis/psychophysics/report/write_trials.h"
#include "analysis/psychophysics/study/covariate.h"
#include "analysis/psychophysics/study/trials_study.h"
#include "core/base/counted.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"
#include "experiments/preview/trials_parts.h"
#include "experiments/preview/tried_trial.h"
#include "experiments/studies/psychophysics/trials_analysis.h"
#include "experiments/studies/psychophysics/trials_methods.h"
#include "experiments/studies/psychophysics/trials_study_simulation.h"
#include "protocols/psychophysics/definition/trials_definition.h"
#include "protocols/psychophysics/trials_protocol.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
namespace trials = analysis::trials;
using protocols::TrialsDefinition;

const TrialsDefinition& trials_of(const protocols::Definition& definition) {
  return dynamic_cast<const TrialsDefinition&>(definition);
}

/// Definition that a session was recorded with.
std::unique_ptr<protocols::Definition> definition_of(const record::SessionInfo& info) {
  Table root = Table::parse(info.definition, info.definition_name);
  auto definition = protocols::trials_protocol().read(root, info.definition_name, nullptr);
  root.check();
  return definition;
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
    auto tests = analysis::parse_analysis_plan(request.planned, "", "--planned").tests;
    std::ranges::transform(tests, tests.begin(), trials::with_short_numbers);
    plan.plan = analysis::with_tests(std::move(plan.plan), std::move(tests));
    remarks.emplace_back("The planned tests were given to analyze, not stated in the definition.");
  }
}

/// Names in planned tests are of the quantity with most conditions: force compensation has none
/// where no channel came.
void check_planned(const trials::TrialsResult& result, std::vector<std::string>& remarks) {
  const std::vector<analysis::PlannedTest>& tests = result.plan.plan.tests;
  const auto most = std::max_element(result.quantities.begin(), result.quantities.end(),
                                     [](const trials::Quantity& a, const trials::Quantity& b) {
                                       return a.table.cells.size() < b.table.cells.size();
                                     });
  if (most != result.quantities.end() && most->compared) {
    analysis::check_plan(most->table, result.plan.plan);
  } else if (!tests.empty() && result.plan.by.empty()) {
    throw InputError(fmt::format(
        "the planned test \"{}\" compares conditions, but the study has one; state the factors in "
        "analysis.by",
        analysis::text_of(tests.front())));
  } else if (!tests.empty()) {
    remarks.emplace_back(
        "The planned tests were not made, because the sessions do not have two conditions.");
  }
}

/// Looks at the test that decides when the study ends.
/// @throws InputError if the plan names a quantity that the results lack
void add_sequential(const AnalysisRequest& request, const TrialsDefinition& definition,
                    trials::TrialsResult& result, std::vector<std::string>& remarks) {
  const analysis::AnalysisPlan& plan = result.plan.plan;
  if (!plan.sequential) {
    return;
  }
  if (!record::imported_from(record::SessionReader(request.files.files.front())).empty()) {
    remarks.emplace_back(
        "Nobody knows when participants of imported trials came: the rule that ends the study "
        "takes them in the order of the tables' rows.");
  }
  if (trials::Quantity* decides = trials::compared_quantity(result.quantities, plan.sequential->of,
                                                            "analysis.sequential.of")) {
    decides->tests.sequential =
        analysis::sequential_result(decides->table, analysis::decisive_test(plan), *plan.sequential,
                                    complete_participants(request.files.files, definition),
                                    static_cast<std::size_t>(definition.design.participants));
  }
}

/// The sessions that a participant should have had and has not, and those that there are twice.
void add_sessions_of(const std::string& participant, const std::string& group,
                     const std::multiset<int>& there, const TrialsDefinition& definition,
                     std::vector<std::string>& remarks) {
  std::vector<int> missing, twice;
  for (int session = 1; session <= definition.sessions(); ++session) {
    const std::size_t files = there.count(session);
    if (files == 0 && definition.comes(session, group)) {
      missing.push_back(session);
    } else if (files > 1) {
      twice.push_back(session);
    }
  }
  if (!missing.empty()) {
    remarks.push_back(fmt::format("{} has no {} {}.", participant,
                                  missing.size() > 1 ? "sessions" : "session",
                                  fmt::join(missing, ", ")));
  }
  if (!twice.empty()) {
    remarks.push_back(fmt::format("{} has several files of {} {}; all of them are analysed.",
                                  participant, twice.size() > 1 ? "sessions" : "session",
                                  fmt::join(twice, ", ")));
  }
}

/// A function of one variable has no trials in which a procedure set another.
void add_other_levels(const trials::TrialsData& data, const trials::TrialsPlan& plan,
                      std::vector<std::string>& remarks) {
  const auto others = std::ranges::count_if(data.trials, [&](const trials::StudyTrial& trial) {
    return trial.counts() && trials::sets_other_level(trial, plan);
  });
  if (others > 0 && plan.uses_level()) {
    remarks.push_back(fmt::format(
        "{}, in which a procedure set another variable than {}, {} not among the levels that are "
        "analysed{}.",
        counted(others, "trial", "trials"), plan.level, others == 1 ? "is" : "are",
        plan.level_assumed ? "; analysis.level can name another" : ""));
  }
}

/// Sentences about sessions that the study planned and the folder lacks.
void add_missing(const AnalysisRequest& request, const TrialsDefinition& definition,
                 const trials::TrialsData& data, std::vector<std::string>& remarks) {
  std::map<std::string, std::multiset<int>> sessions;
  std::map<std::string, std::string> groups;
  for (const trials::StudySession& session : data.sessions) {
    groups[session.participant] = session.group;
    sessions[session.participant].insert(session.session);
  }
  const auto planned = static_cast<std::size_t>(definition.design.participants);
  if (request.pilots == Pilots::kLeftOut && sessions.size() < planned) {
    remarks.push_back(fmt::format("{} of {} planned participants {} a session in this folder.",
                                  sessions.size(), planned, sessions.size() == 1 ? "has" : "have"));
  }
  for (const auto& [participant, there] : sessions) {
    if (definition.sessions() > 1) {
      add_sessions_of(participant, groups[participant], there, definition, remarks);
    }
  }
  if (const auto unfinished = unfinished_sessions(request.folder); !unfinished.empty()) {
    remarks.push_back(fmt::format("Not analysed, because the session is unfinished: {}.",
                                  fmt::join(unfinished, ", ")));
  }
}

class TrialsStudy final : public Study {
 public:
  const protocols::Protocol& protocol() const override { return protocols::trials_protocol(); }
  void read_analysis(Table& root, const protocols::Definition* definition, bool) const override {
    read_trials_analysis(root, dynamic_cast<const protocols::TrialsDefinition*>(definition));
  }
  std::vector<std::string> analysis_warnings(const protocols::Definition& d) const override;
  void add_preview(const protocols::Definition& definition, const PreviewRequest& request,
                   Preview& preview) const override {
    add_trials_parts(dynamic_cast<const protocols::StudiedDefinition&>(definition), request,
                     preview);
  }
  std::shared_ptr<TriedTrial> tried_trial(const protocols::Definition& definition,
                                          const PreviewRequest& request) const override {
    return tried_scenes(dynamic_cast<const protocols::StudiedDefinition&>(definition), request);
  }
  void add_methods(const protocols::Definition& definition, std::uint64_t seed,
                   analysis::Document& document) const override {
    add_trials_methods(dynamic_cast<const protocols::StudiedDefinition&>(definition), seed,
                       document);
  }
  std::vector<std::string> analyze(const AnalysisRequest& request) const override;
  std::optional<analysis::SequentialResult> sequential(
      const AnalysisRequest& request) const override;
  std::unique_ptr<StudySimulation> study_simulation(const protocols::Definition& definition,
                                                    const std::string& asked_in,
                                                    const std::string& watched) const override {
    return trials_study_simulation(dynamic_cast<const protocols::StudiedDefinition&>(definition),
                                   plan_of(trials_of(definition)), asked_in, watched);
  }
};

/// Whether sessions of a definition judge the answers that are analysed, by a formula or what a
/// procedure learns.
bool judges_answers(const TrialsDefinition& d, const trials::TrialsPlan& plan) {
  const auto question = std::ranges::find_if(d.questions, [&](const auto& each) {
    return plan.question.empty() || each.name == plan.question;
  });
  return (question != d.questions.end() && !question->correct.empty()) ||
         (plan.question.empty() && !d.tracks.empty());
}

/// Whether two stages have fields that the other one lacks, as stages do that present one stimulus
/// after the other. Fields of both, such as one that holds the hand, are none of the stimuli.
bool stages_differ(const TrialsDefinition& d) {
  Table root = d.root();
  std::vector<std::set<std::string>> fields;
  for (Table& stage : root.tables("stages")) {
    const auto names = stage.is_array("fields") ? stage.texts("fields")
                       : stage.has("fields")    ? std::vector{stage.text("fields")}
                                                : std::vector<std::string>{};
    fields.emplace_back(names.begin(), names.end());
  }
  return std::ranges::any_of(fields, [&](const auto& a) {
    return std::ranges::any_of(fields, [&](const auto& b) {
      return !std::ranges::includes(a, b) && !std::ranges::includes(b, a);
    });
  });
}

std::vector<std::string> TrialsStudy::analysis_warnings(const protocols::Definition& d) const {
  const trials::TrialsPlan plan = plan_of(trials_of(d));
  std::vector<std::string> warnings =
      analysis::sequential_warnings(plan.plan, d.design.participants);
  const auto& rule = plan.plan.sequential;
  if (rule && !plan.tests_of.empty() && rule->of != plan.tests_of) {
    warnings.push_back(fmt::format(
        "analysis.tests_of is \"{}\", but analysis.sequential.of is \"{}\": the study ends by a "
        "test of another quantity than the planned tests are of",
        plan.tests_of, rule->of));
  }
  if (plan.kind == trials::AnalysisKind::kAdjustment && trials_of(d).tracks.empty()) {
    warnings.emplace_back(
        "analysis.kind is \"adjustment\", whose settings are the levels of procedures, and there "
        "is none, so that the report has no setting; add [procedure] with kind = \"adjustment\"");
  }
  if (needs_judged_answers(plan) && !judges_answers(trials_of(d), plan)) {
    warnings.push_back(fmt::format(
        "nothing says which answers are right, so that sessions give the analysis nothing to "
        "count; add correct = FORMULA to [[responses]]{}; only imported trials may have it in a "
        "column",
        plan.kind == trials::AnalysisKind::kIdentification
            ? ""
            : ", or yes = \"ANSWER\", which counts 1, to [analysis]"));
  }
  if (plan.task_assumed && plan.discrimination == analysis::DiscriminationTask::kOneInterval &&
      stages_differ(trials_of(d))) {
    warnings.emplace_back(
        "stages of a trial have different fields, but d' is that of one stimulus in each trial; "
        "state task = \"forced choice\" in [analysis] if a trial presents both stimuli, whose d' "
        "is 1.41 times smaller, or task = \"one interval\"");
  }
  if (plan.level_assumed && plan.uses_level()) {
    warnings.push_back(
        fmt::format("procedures set several variables, and analysis.level names none of them; "
                    "{0}, that of the first, is analysed, and trials of the others are left out; "
                    "name the one that is meant (level = \"{0}\")",
                    plan.level));
  }
  if (plan.kind == trials::AnalysisKind::kPursuit && trials_of(d).root().has("cursor")) {
    warnings.emplace_back(
        "the analysis of pursuit compares the target with the tool, not with the cursor that is "
        "seen: with its gain, turn or delay, error, gain and lag are those of the hand");
  }
  if (plan.kind == trials::AnalysisKind::kAdjustment) {
    for (const std::string& factor : plan_defaults(trials_of(d)).within_settings) {
      warnings.push_back(fmt::format(
          "{0} varies while a level is adjusted, so that settings belong to no level of it; add by "
          "= [\"{0}\"] to the procedure if each has settings of its own",
          factor));
    }
  }
  for (const protocols::Track& track : trials_of(d).tracks) {
    const bool outside = plan.function.axis.scale != psychometric::Scale::kLinear &&
                         track.low <= plan.function.axis.origin;
    if (plan.functions && outside) {
      warnings.push_back(
          fmt::format("levels of {} begin at {:g}, but the axis of analysis.function begins above "
                      "{:g}; levels up to there are left out of the function",
                      track.name, track.low, plan.function.axis.origin));
    }
    const double room = 0.1 * (track.high - track.low);
    if (plan.functions && plan.reference && (plan.level.empty() || track.variable == plan.level) &&
        (*plan.reference < track.low - room || *plan.reference > track.high + room)) {
      warnings.push_back(
          fmt::format("analysis.reference ({:g}) lies outside of the levels of {} ({:g} to {:g}): "
                      "is it the level of the standard, to which Weber fractions relate?",
                      *plan.reference, track.variable, track.low, track.high));
    }
  }
  return warnings;
}

trials::TrialsResult analyzed(const AnalysisRequest& request) {
  const record::SessionInfo& first = request.files.first;
  const auto owned = definition_of(first);
  const TrialsDefinition& definition = trials_of(*owned);
  trials::TrialsPlan plan = plan_of(definition);
  std::vector<std::string> remarks = request.files.remarks;
  take_planned(request, plan, remarks);
  const auto group_of = [&](const std::string& subject) {
    return definition.groups.size() > 1 ? protocols::group_of(definition.groups, subject)
                                        : std::string();
  };
  trials::TrialsData data = trials::read_trials(request.files.files, group_of, request.threads);
  add_missing(request, definition, data, remarks);
  add_other_levels(data, plan, remarks);
  std::ranges::move(trials::unlike_files(data.sessions), std::back_inserter(remarks));
  std::vector<trials::PageScore> scores =
      trials::page_scores(request.files.files, definition.pages, group_of);
  trials::add_covariate(scores, plan.plan.covariate);
  trials::TrialsResult result =
      trials::analyze(std::move(data), plan, procedures_of(definition), request.threads);
  add_file_quantities(definition, request.files.files, request.threads, result);
  check_planned(result, remarks);
  trials::keep_equivalence(result.quantities, plan.plan.beside);
  trials::separate_secondary(result.quantities, plan);
  add_sequential(request, definition, result, remarks);
  result.page_scores = std::move(scores);
  result.title = definition.name;
  result.remarks = std::move(remarks);
  result.definition = first.definition;
  result.definition_name = first.definition_name;
  return result;
}

std::vector<std::string> TrialsStudy::analyze(const AnalysisRequest& request) const {
  const trials::TrialsResult result = analyzed(request);
  const auto own = analysis::own_findings(request.files.files);
  trials::write_trials(result, request.out, request.paper, own);
  std::vector<std::string> lines = trials::summary_lines(result);
  for (const analysis::FindingList& list : own) {
    std::ranges::move(analysis::lines_of(list), std::back_inserter(lines));
  }
  lines.insert(lines.end(), result.remarks.begin(), result.remarks.end());
  return lines;
}

std::optional<analysis::SequentialResult> TrialsStudy::sequential(
    const AnalysisRequest& request) const {
  for (const trials::Quantity& quantity : analyzed(request).quantities) {
    if (quantity.tests.sequential) {
      return quantity.tests.sequential;
    }
  }
  return std::nullopt;
}

}  // namespace

const Study& trials_study() {
  static const TrialsStudy study;
  return study;
}

}  // namespace haptrial::experiments
