#include "experiments/studies/psychophysics/import_trials.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ctime>
#include <map>
#include <set>

#include "analysis/files/csv.h"
#include "analysis/files/new_folder.h"
#include "analysis/psychophysics/exchange/write_imported.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "experiments/runner/version.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/psychophysics/trials_analysis.h"
#include "experiments/study/session_name.h"
#include "protocols/psychophysics/definition/trials_definition.h"
#include "protocols/psychophysics/trials_protocol.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
namespace trials = analysis::trials;
using protocols::TrialsDefinition;

const TrialsDefinition& stated_trials(const Experiment& experiment) {
  const auto* definition = dynamic_cast<const TrialsDefinition*>(experiment.definition.get());
  if (definition == nullptr) {
    throw InputError(fmt::format("{}: is of protocol '{}'; allowed: protocol = \"trials\"",
                                 experiment.definition->file_name,
                                 experiment.study->protocol().name()));
  }
  return *definition;
}

std::string level_of(const TrialsDefinition& d, const trials::TrialsPlan& plan) {
  return !plan.level.empty() ? plan.level : d.tracks.empty() ? "" : d.tracks.front().variable;
}

/// The definition's factors. Behind them stand values of blocks and [variables] by which its analysis
/// tells trials apart.
std::vector<std::string> needed_factors(const TrialsDefinition& d, const trials::TrialsPlan& plan) {
  std::vector<std::string> needed;
  if (!d.order.factors.empty()) {
    needed = d.root().table("factors").keys_as_written();
  }
  std::vector<std::string> named = plan.by;
  named.insert(named.end(), {plan.stimulus, plan.paired.first, plan.paired.second});
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  // Those have columns of their own, or follow from the trial.
  const std::vector<std::string> others{"",      "group", "session",     "condition",      "probe",
                                        "track", "block", trials::kItem, level_of(d, plan)};
  for (const std::string& name : named) {
    if (!has(others, name) && !has(needed, name)) {
      needed.push_back(name);
    }
  }
  return needed;
}

/// Takes the columns that are called as the definition's factors and level are. Factors come in the
/// order of its [factors], so that the levels of a condition do.
void add_columns_of(const TrialsDefinition& d, const trials::TrialsPlan& plan, const fs::path& file,
                    trials::TrialColumns& columns) {
  const analysis::CsvTable table = analysis::CsvTable::load(file);
  const std::vector<std::string> written = needed_factors(d, plan);
  for (const std::string& factor : written) {
    if (std::ranges::find(columns.factors, factor, &trials::FactorColumn::variable) !=
        columns.factors.end()) {
      continue;
    }
    if (!table.has(factor)) {
      throw InputError(fmt::format(
          "{}: the definition varies {}, and no column is called so; add --factor {}=COLUMN",
          file.string(), factor, factor));
    }
    columns.factors.push_back({factor, factor});
  }
  std::ranges::stable_sort(columns.factors, {}, [&](const trials::FactorColumn& column) {
    return std::ranges::find(written, column.variable);
  });
  if (columns.level.empty() && table.has(level_of(d, plan))) {
    columns.level = level_of(d, plan);
  }
}

void check_level(const TrialsDefinition& d, const trials::TrialColumns& columns,
                 const std::string& level) {
  if (!columns.level.empty() && level.empty()) {
    throw InputError(fmt::format(
        "{}: has neither a procedure nor analysis.level, so that nobody knows what the column {} "
        "holds; add level = \"NAME\" to [analysis]",
        d.file_name, columns.level));
  }
  if (!columns.level.empty() && columns.track.empty() && d.tracks.size() > 1) {
    std::vector<std::string> names;
    for (const protocols::Track& track : d.tracks) {
      names.push_back(track.name);
    }
    throw InputError(
        fmt::format("{}: has the tracks {}; add --column track=COLUMN, which says whose each "
                    "trial's level is",
                    d.file_name, fmt::join(names, ", ")));
  }
}

trials::ImportedNames names_of(const TrialsDefinition& d, const trials::TrialsPlan& plan,
                               const trials::TrialColumns& columns) {
  trials::ImportedNames names;
  const auto question = plan.question.empty() ? d.questions.begin()
                                              : std::ranges::find(d.questions, plan.question,
                                                                  &protocols::TrialQuestion::name);
  if (question != d.questions.end()) {
    names.answer = question->name;
    names.choices = question->has_choices() ? question->answers() : std::vector<std::string>();
    names.first = question->first;
  }
  const auto other = std::ranges::find_if(
      d.questions, [&](const auto& each) { return each.name != names.answer; });
  names.rating = !plan.rating.empty()         ? plan.rating
                 : other != d.questions.end() ? other->name
                                              : std::string();
  names.level = level_of(d, plan);
  names.level_is_set = std::ranges::any_of(
      d.tracks, [&](const protocols::Track& track) { return track.variable == names.level; });
  names.track = d.tracks.empty() ? "" : d.tracks.front().name;
  check_level(d, columns, names.level);
  return names;
}

/// @throws InputError if no column says what the analysis counts
void check_judged(const TrialsDefinition& d, const trials::TrialsPlan& plan,
                  const trials::TrialColumns& columns) {
  const bool identifies = plan.kind == trials::AnalysisKind::kIdentification;
  const bool learnt = !identifies && (!columns.outcome.empty() || !d.tracks.empty());
  if (needs_judged_answers(plan) && columns.correct.empty() && !learnt) {
    throw InputError(fmt::format(
        "no column says whether answers are right, which this kind of analysis counts; add "
        "--column correct=COLUMN{}",
        identifies ? "" : ", or the answer that counts 1, by --yes ANSWER or analysis.yes"));
  }
}

/// When an import begins, and the places of its participants in the tables, from 1.
struct ImportOrder {
  std::string start_utc;
  std::map<std::string, std::uint64_t> places;
};

ImportOrder order_of(const trials::ImportedStudy& study) {
  ImportOrder order{fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))), {}};
  for (const trials::ImportedTrial& trial : study.trials) {
    order.places.try_emplace(trial.participant, order.places.size() + 1);
  }
  return order;
}

/// @throws InputError for settings of procedures that the definition does not have
void check_settings(const TrialsDefinition& d, const trials::TrialsPlan& plan) {
  if (plan.kind == trials::AnalysisKind::kAdjustment && d.tracks.empty()) {
    throw InputError(
        fmt::format("{}: has no procedure, whose levels an analysis of kind 'adjustment' takes for "
                    "settings; state it, or analyse the answers as kind = \"magnitude\"",
                    d.file_name));
  }
}

record::SessionInfo info_of(const TrialsDefinition& d, const trials::ImportedTrial& first,
                            const ImportOrder& order) {
  record::SessionInfo info;
  info.program_version = program_version();
  info.program_commit = program_commit();
  info.definition = d.text;
  info.definition_name = d.file_name;
  info.subject = info.participant.identifier = first.participant;
  info.device = kNoDevice;
  info.clock = "real";
  info.rate = d.rate;
  info.start_utc = order.start_utc;
  info.participant_number = order.places.at(first.participant);
  info.simulated = first.simulated;
  info.session = static_cast<std::uint64_t>(first.session);
  return info;
}

using Sessions = std::map<std::pair<std::string, int>, std::vector<const trials::ImportedTrial*>>;

Sessions sessions_of(const trials::ImportedStudy& study, const TrialsDefinition& d) {
  Sessions sessions;
  for (const trials::ImportedTrial& trial : study.trials) {
    if (trial.session > d.sessions()) {
      throw InputError(fmt::format("{}:{}: {} is {}; allowed: at most {}, as design.sessions says",
                                   study.sources[trial.source].name, trial.line,
                                   study.columns.session, trial.session, d.sessions()));
    }
    sessions[{trial.participant, trial.session}].push_back(&trial);
  }
  return sessions;
}

ImportSummary summary_of(const trials::ImportedStudy& study, const Sessions& sessions) {
  std::set<std::string> people;
  for (const auto& [key, own] : sessions) {
    people.insert(key.first);
  }
  return {people.size(),  sessions.size(),  study.trials.size(),
          study.left_out, study.unanswered, study.warnings};
}

}  // namespace

ImportSummary import_trials(TrialsImport request) {
  Experiment experiment;
  trials::ImportedStudy study;
  if (request.definition.empty()) {
    study = trials::read_trial_tables(request.files, request.columns);
    experiment =
        parse_experiment(trials::imported_definition(study, request.analysis), "study.toml");
    for (std::string note : {trials::guess_note(study, request.analysis),
                             trials::task_note(study, request.analysis)}) {
      if (!note.empty()) {
        study.warnings.push_back(std::move(note));
      }
    }
  } else {
    experiment = load_experiment(request.definition);
    const TrialsDefinition& d = stated_trials(experiment);
    add_columns_of(d, plan_of(d), request.files.front(), request.columns);
    study = trials::read_trial_tables(request.files, request.columns);
  }
  const TrialsDefinition& definition = stated_trials(experiment);
  const trials::TrialsPlan plan = plan_of(definition);
  check_judged(definition, plan, study.columns);
  check_settings(definition, plan);
  const trials::ImportedNames names = names_of(definition, plan, study.columns);
  const Sessions sessions = sessions_of(study, definition);
  const ImportOrder order = order_of(study);
  exchange::NewFolder out(request.out);
  for (const auto& [key, own] : sessions) {
    trials::write_imported(
        out.place(session_file_name(key.first, key.second, definition.sessions())),
        info_of(definition, *own.front(), order), study, own, names,
        protocols::trials_protocol().tables());
  }
  out.write("study.toml", definition.text);
  out.publish();
  return summary_of(study, sessions);
}

}  // namespace haptrial::experiments
