#include "experiments/studies/psychophysics/trials_analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <map>

#include "analysis/psychophysics/study/paired_quantities.h"
#include "analysis/psychophysics/study/produced_quantities.h"
#include "analysis/psychophysics/study/pursuit_quantities.h"
#include "analysis/psychophysics/study/reach_quantities.h"
#include "core/base/definition/table.h"
#include "experiments/studies/psychophysics/reach_routes.h"
#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::experiments {
namespace {

using analysis::trials::AnalysisKind;
using analysis::trials::PlanDefaults;

/// The answers that somebody may give, and behind them one that silence gives where two others can
/// be chosen: "missed" is no alternative of a guess, and "stay" beside "go" alone is one.
analysis::trials::PlanQuestion plan_question(const protocols::TrialQuestion& question) {
  analysis::trials::PlanQuestion known{question.name, {}, false, !question.correct.empty()};
  if (question.has_choices()) {
    known.choices = question.answers();
  }
  const int silent = question.silent_choice();
  if (silent >= 0 && known.choices.size() > 2) {
    known.last_is_silent = true;
    std::rotate(known.choices.begin() + silent, known.choices.begin() + silent + 1,
                known.choices.end());
  }
  return known;
}

void add_names(const protocols::TrialsDefinition& d, PlanDefaults& defaults) {
  Table root = d.root();
  if (root.has("factors")) {
    defaults.factors = root.table("factors").keys_as_written();
  }
  if (d.groups.size() > 1) {
    defaults.factors.emplace_back("group");
  }
  defaults.names = {"condition", "block", "track", "probe", "group"};
  if (d.sessions() > 1) {
    defaults.names.emplace_back(analysis::trials::kSession);
  }
  for (int session = 1; session <= d.sessions(); ++session) {
    defaults.sessions.push_back(d.session_name(session));
  }
  for (const protocols::Block& block : d.order.blocks) {
    for (const protocols::GivenValue& value : block.values) {
      defaults.names.push_back(value.name);
    }
  }
  if (root.has("variables")) {
    std::ranges::copy(root.table("variables").keys_as_written(),
                      std::back_inserter(defaults.names));
  }
}

/// A level as a table of trials shows it; empty: it depends on others.
std::string level_of_formula(const std::string& formula) {
  constexpr char kQuote = '\'';
  if (formula.size() > 1 && formula.front() == kQuote && formula.back() == kQuote) {
    const std::string word = formula.substr(1, formula.size() - 2);
    return word.find(kQuote) == std::string::npos ? word : std::string();
  }
  char* end = nullptr;
  const double number = std::strtod(formula.c_str(), &end);
  return end != formula.c_str() && *end == '\0' ? fmt::format("{}", number) : std::string();
}

/// Levels of factors and of what blocks give, and what [variables] says elsewhere. Factors with a
/// level that depends on others are left out.
std::map<std::string, std::vector<std::string>> stated_levels(const protocols::TrialsDefinition& d,
                                                              Table& root) {
  std::map<std::string, std::vector<std::string>> formulas;
  for (const protocols::Factor& factor : d.order.factors) {
    formulas[factor.name] = factor.levels;
  }
  for (const protocols::Block& block : d.order.blocks) {
    for (const protocols::GivenValue& value : block.values) {
      formulas[value.name].push_back(value.formula);
    }
  }
  std::map<std::string, std::vector<std::string>> stated;
  for (auto& [name, all] : formulas) {
    if (root.has("variables") && root.table("variables").has(name)) {
      Table variables = root.table("variables");
      all.push_back(variables.is_table(name)   ? "$" + name
                    : variables.has_text(name) ? variables.text(name)
                                               : fmt::format("{}", variables.number(name, {}, "")));
    }
    std::vector<std::string> levels;
    for (const std::string& formula : all) {
      const std::string level = level_of_formula(formula);
      if (std::find(levels.begin(), levels.end(), level) == levels.end()) {
        levels.push_back(level);
      }
    }
    if (std::find(levels.begin(), levels.end(), "") == levels.end()) {
      stated[name] = levels;
    }
  }
  return stated;
}

/// Names that the comparison of cues may use.
analysis::trials::CueNames cue_names(const protocols::TrialsDefinition& d) {
  Table root = d.root();
  analysis::trials::CueNames names;
  names.levels = stated_levels(d, root);
  const auto add = [&](const std::string& name) {
    if (std::find(names.variables.begin(), names.variables.end(), name) == names.variables.end()) {
      names.variables.push_back(name);
    }
  };
  for (const protocols::Interval& interval : d.intervals) {
    names.intervals.push_back(interval.name);
    for (const protocols::GivenValue& value : interval.values) {
      add(value.name);
    }
  }
  if (root.has("variables")) {
    for (const std::string& name : root.table("variables").keys_as_written()) {
      add(name);
    }
  }
  return names;
}

/// The targets, with the frequencies that they have in every trial.
analysis::trials::PursuitNames pursuit_names(const protocols::TrialsDefinition& d) {
  analysis::trials::PursuitNames names{d.stages, {}, ""};
  Table root = d.root();
  if (!root.has("targets")) {
    return names;
  }
  Table targets = root.table("targets");
  const std::vector<std::string> written = targets.keys_as_written();
  names.first = written.empty() ? "" : written.front();
  for (const std::string& name : targets.keys()) {
    Table target = targets.table(name);
    names.targets.push_back({name, {}});
    const auto rows = target.has("frequencies") ? target.rows("frequencies", "")
                                                : std::vector<std::vector<NumberOrText>>{};
    for (std::size_t i = 0; rows.size() == 1 && i < rows[0].size(); ++i) {
      if (!rows[0][i].number) {
        names.targets.back().frequencies.clear();
        break;
      }
      names.targets.back().frequencies.push_back(*rows[0][i].number);
    }
  }
  return names;
}

/// Measures, and the variables that they may have been to equal: every name that a trial records.
/// @param known  factors, and what blocks and [variables] give
analysis::trials::ProducedNames produced_names(const protocols::TrialsDefinition& d,
                                               const PlanDefaults& known) {
  analysis::trials::ProducedNames names{{}, known.factors};
  for (const protocols::Measure& measure : d.measures) {
    names.measures.push_back({measure.name, protocols::words_of(measure), measure.unit});
  }
  const auto add = [&](const std::string& name) {
    if (std::ranges::find(names.variables, name) == names.variables.end()) {
      names.variables.push_back(name);
    }
  };
  for (const protocols::Track& track : d.tracks) {
    std::ranges::for_each(track.variables(), add);
  }
  std::ranges::for_each(known.cues.variables, add);  // of intervals and [variables]
  for (const protocols::Block& block : d.order.blocks) {
    for (const protocols::GivenValue& value : block.values) {
      add(value.name);
    }
  }
  return names;
}

/// The variables of levels with one dimension, each with what its first procedure says.
std::vector<analysis::trials::ProcedureLevels> levels_of_procedures(
    const protocols::TrialsDefinition& d) {
  using analysis::trials::ProcedureLevels;
  std::vector<ProcedureLevels> all;
  for (const protocols::Track& track : d.tracks) {
    const auto known = std::ranges::find(all, track.variable, &ProcedureLevels::variable);
    if (known == all.end()) {
      all.push_back({track.variable, track.axis, track.falls});
      all.back().axis.unit = track.unit;
    } else if (known->falls != track.falls) {
      known->falls.reset();
    }
  }
  return all;
}

}  // namespace

PlanDefaults plan_defaults(const protocols::TrialsDefinition& d) {
  PlanDefaults defaults;
  add_names(d, defaults);
  defaults.reaching = reaching_names(d);
  defaults.pursuit = pursuit_names(d);
  defaults.cues = cue_names(d);
  defaults.produced = produced_names(d, defaults);
  defaults.levels = defaults.cues.levels;
  defaults.levels[analysis::trials::kSession] = defaults.sessions;
  for (const auto& group : d.groups) {
    defaults.levels["group"].push_back(group.name);
  }
  for (const protocols::Block& block : d.order.blocks) {
    if (!block.practice) {
      defaults.levels["block"].push_back(block.name);
    }
  }
  std::ranges::transform(d.questions, std::back_inserter(defaults.questions), plan_question);
  defaults.counts_formula = std::ranges::any_of(
      d.tracks, [](const protocols::Track& track) { return !track.counts.empty(); });
  std::ranges::copy_if(defaults.factors, std::back_inserter(defaults.within_settings),
                       [&](const std::string& factor) {
                         return factor != "group" &&
                                std::ranges::any_of(d.tracks, [&](const protocols::Track& track) {
                                  return std::ranges::find(track.by, factor) == track.by.end();
                                });
                       });
  for (const questions::Page& page : d.pages.pages) {
    defaults.pages.push_back(page.name);
  }
  if (d.tracks.empty()) {
    return defaults;
  }
  const protocols::Track& track = d.tracks.front();
  using psychometric::OutcomeForm;
  defaults.kind = track.learns_from == OutcomeForm::kMagnitude    ? AnalysisKind::kMagnitude
                  : track.learns_from == OutcomeForm::kAdjustment ? AnalysisKind::kAdjustment
                                                                  : AnalysisKind::kPsychometric;
  defaults.procedures = levels_of_procedures(d);
  return defaults;
}

analysis::trials::TrialsPlan read_trials_analysis(Table& root,
                                                  const protocols::TrialsDefinition* definition) {
  const PlanDefaults defaults = definition == nullptr ? PlanDefaults{} : plan_defaults(*definition);
  const bool scripted = definition != nullptr && definition->script.has_value();
  analysis::trials::TrialsPlan plan = analysis::trials::read_trials_plan(root, defaults);
  // Levels that follow from answers pull both tests from 0; a script cannot be asked again.
  plan.serial = plan.serial && !scripted;
  return plan;
}

analysis::trials::TrialsPlan plan_of(const protocols::TrialsDefinition& definition) {
  Table root = definition.root();
  analysis::trials::TrialsPlan plan = read_trials_analysis(root, &definition);
  root.check();
  return plan;
}

bool needs_judged_answers(const analysis::trials::TrialsPlan& plan) {
  return plan.kind == AnalysisKind::kIdentification ||
         (plan.yes.empty() &&
          (plan.kind == AnalysisKind::kPsychometric || plan.kind == AnalysisKind::kPaired));
}

analysis::trials::ProcedureOf procedures_of(const protocols::TrialsDefinition& definition) {
  return [&definition](const std::string& name) -> std::unique_ptr<psychometric::Procedure> {
    for (const protocols::Track& track : definition.tracks) {
      const bool own = name == track.name || name.starts_with(track.name + ", ");
      if (own && !track.listed && track.begin && !definition.script) {
        return track.begin(1, name);
      }
    }
    return nullptr;
  };
}

namespace trials = analysis::trials;
using trials::AnalysisKind;

void add_file_quantities(const protocols::TrialsDefinition& definition,
                         const std::vector<std::filesystem::path>& files, int threads,
                         trials::TrialsResult& result) {
  const trials::TrialsPlan& plan = result.plan;
  if (plan.kind == AnalysisKind::kReaching) {
    const auto routes = reach_routes(definition, result.data, plan.reaching);
    result.reaching = trials::reaching_study(
        result.data,
        trials::study_reaches(result.data, files, routes, plan.reaching.stage, plan.reaching.clamp,
                              threads),
        plan.reaching, threads);
    result.quantities = trials::reach_quantities(result.data, *result.reaching, plan);
  }
  if (plan.kind == AnalysisKind::kPursuit) {
    result.quantities = trials::pursuit_quantities(result.data, files, plan, threads);
  }
  if (plan.kind == AnalysisKind::kPaired) {
    result.quantities = trials::paired_quantities(result.data, plan);
  }
  if (plan.kind == AnalysisKind::kProduced) {
    result.quantities = trials::produced_quantities(result.data, plan);
  }
}

}  // namespace haptrial::experiments
