#include "experiments/studies/drilling/drilling_curriculum.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "analysis/bone_drilling/feedback/curriculum_page.h"
#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/bone_drilling/metrics/quantities.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/base/whole_file.h"
#include "core/record/read/marked_trials.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/drilling/expert_sessions.h"
#include "experiments/studies/drilling/learn_score.h"
#include "experiments/studies/drilling/procedure_setup.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/roster.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
namespace drilling = analysis::drilling;

bool asks_for_score(const bone::Curriculum& curriculum) {
  return std::ranges::any_of(curriculum.cases, [](const bone::CurriculumCase& each) {
    return std::ranges::any_of(each.pass, [](const bone::Criterion& criterion) {
      return criterion.quantity == bone::kScoreQuantity;
    });
  });
}

/// One session of a trainee.
class CaseSession {
 public:
  CaseSession(const fs::path& file, const drilling::ScoreModel* score)
      : reader_(file), score_(score) {
    require_drilling(file);
    for (const record::PassRow& pass : reader_.passes()) {
      conditions_[pass.trial] = pass.condition;
    }
  }

  void add_attempts(const bone::Curriculum& curriculum, std::vector<bone::CaseAttempt>& all) {
    const record::SessionInfo& info = reader_.info();
    const auto definition = protocols::parse_bone_definition(info.definition, info.definition_name);
    const auto setup = procedure_setup(reader_);
    const std::set<int> left_out = record::trials_left_out(reader_);
    drilling::StudyBones bones;
    for (const drilling::Procedure& procedure : load_procedures(reader_, setup, &bones)) {
      const bone::CurriculumCase* of = curriculum.case_of(conditions_[procedure.number]);
      if (of == nullptr || !procedure.completed || left_out.contains(procedure.number)) {
        continue;
      }
      const drilling::ProcedureSummary summary = summarize(procedure, {}, bones);
      bone::CaseAttempt attempt{of->name, info.start_utc.substr(0, 10)};
      for (const bone::Criterion& criterion : of->pass) {
        if (const auto value = value_of(criterion.quantity, summary, definition)) {
          attempt.values[criterion.quantity] = *value;
        }
      }
      all.push_back(std::move(attempt));
    }
  }

 private:
  std::optional<double> value_of(const std::string& name, const drilling::ProcedureSummary& summary,
                                 const protocols::BoneDefinition& definition) const {
    if (name != bone::kScoreQuantity) {
      return judged_quantity(summary, name);
    }
    if (score_ == nullptr) {
      return std::nullopt;
    }
    const auto score = score_of(*score_, summary, score_rules(definition));
    return score ? std::optional(score->value) : std::nullopt;
  }

  record::SessionReader reader_;
  const drilling::ScoreModel* score_;
  std::map<int, std::string> conditions_;  // by trial
};

/// @param known  quantities of procedures of its case  @param of  file and case
void check_criterion(const bone::Criterion& criterion, const std::vector<std::string>& known,
                     const std::string& of) {
  const std::string& name = criterion.quantity;
  if (name == bone::kScoreQuantity) {
    return;
  }
  if (std::ranges::find(known, name) == known.end()) {
    const std::string hint = did_you_mean(name, known);
    throw InputError(fmt::format("{} asks for '{}', which its bone does not have{} allowed: {}", of,
                                 name, hint.empty() ? ";" : hint, fmt::join(known, ", ")));
  }
  const double most = 1e3 * drilling::kLeftReach;  // [mm]
  if (drilling::is_bone_left(name) && criterion.value > most) {
    throw InputError(
        fmt::format("{} asks for '{}' of {:g} mm; allowed: up to {:g} mm, beyond "
                    "which bone left is not measured",
                    of, name, criterion.value, most));
  }
}

}  // namespace

std::vector<bone::CaseAttempt> case_attempts(const bone::Curriculum& curriculum,
                                             std::span<const fs::path> sessions,
                                             const drilling::ScoreModel* score) {
  std::vector<bone::CaseAttempt> all;
  for (const fs::path& file : sessions) {
    CaseSession(file, score).add_attempts(curriculum, all);
  }
  return all;
}

std::optional<drilling::ScoreModel> score_for(const protocols::BoneDefinition& d,
                                              const fs::path& folder) {
  return d.curriculum && asks_for_score(*d.curriculum) && !d.score_file.empty()
             ? std::optional(drilling::read_score_model(folder / d.score_file))
             : std::nullopt;
}

NextCase next_case_of(const protocols::BoneDefinition& d, const fs::path& folder,
                      std::span<const fs::path> sessions) {
  const auto score = sessions.empty() ? std::nullopt : score_for(d, folder);
  const auto attempts = case_attempts(*d.curriculum, sessions, score ? &*score : nullptr);
  const bone::CurriculumStanding found = standing(*d.curriculum, attempts);
  return found.next ? NextCase{d.curriculum->cases[*found.next].name,
                               why_next(drilling::with_titles(*d.curriculum), found)}
                    : NextCase{};
}

void check_curriculum(Table& root, const protocols::BoneDefinition* definition) {
  if (definition == nullptr || !definition->curriculum) {
    return;
  }
  Table curriculum = root.table("curriculum");
  std::vector<std::string> bad;
  for (const bone::CurriculumCase& each : definition->curriculum->cases) {
    for (const bone::Criterion& criterion : each.pass) {
      if (criterion.quantity != bone::kScoreQuantity &&
          !drilling::is_quantity(criterion.quantity)) {
        bad.push_back(criterion.quantity);
      }
    }
  }
  const std::vector<std::string> known = drilling::quantity_names();
  for (const std::string& name : bad) {
    const std::string hint = did_you_mean(name, known);
    curriculum.reject("cases", fmt::format("asks for '{}'{} allowed: score, {}", name,
                                           hint.empty() ? ";" : hint, fmt::join(known, ", ")));
  }
}

void check_criteria(const protocols::BoneDefinition& d) {
  if (!d.curriculum) {
    return;
  }
  for (const bone::CurriculumCase& each : d.curriculum->cases) {
    const auto source =
        static_cast<std::size_t>(std::ranges::find(d.sources, each.bone) - d.sources.begin());
    std::vector<std::string> known =
        drilling::quantity_names_on(*d.bones.at(source), d.osteotomy.has_value());
    std::erase(known, drilling::kRegionMetric);  // one procedure is compared with nothing
    if (!d.cavity) {
      for (const char* of_a_plan :
           {"cavity_removed_percent", "beyond_plan_mm3", "economy_mm3_per_m"}) {
        std::erase(known, of_a_plan);
      }
    }
    for (const bone::Criterion& criterion : each.pass) {
      check_criterion(criterion, known, fmt::format("{}: case \"{}\"", d.file_name, each.name));
    }
  }
}

void write_class_page(const ClassRequest& request) {
  const Experiment experiment = load_experiment(request.definition);
  const auto* d = dynamic_cast<const protocols::BoneDefinition*>(experiment.definition.get());
  if (d == nullptr || !d->curriculum) {
    throw InputError(fmt::format("{}: has no [curriculum], so there is no class to show",
                                 request.definition.string()));
  }
  RosterRequest asked;
  asked.protocol = &experiment.study->protocol();
  asked.definition = d;
  asked.definition_file = request.definition.string();
  asked.folder = request.folder;
  const auto score = score_for(*d, request.definition.parent_path());
  drilling::CurriculumClass found{d->name, *d->curriculum, {}};
  for (const RosterPerson& person : make_roster(asked).persons) {
    std::vector<fs::path> files;
    for (const RosterSession& each : person.sessions) {
      if (each.state == SessionState::kDone) {
        files.push_back(request.folder / each.file);
      }
    }
    if (!person.pilot && !person.excluded && !files.empty()) {
      const auto attempts = case_attempts(*d->curriculum, files, score ? &*score : nullptr);
      found.trainees.push_back({person.subject, person.group, person.simulated,
                                standing(*d->curriculum, attempts), person.next > 0});
    }
  }
  if (found.trainees.empty()) {
    throw InputError(fmt::format("{}: nobody has a finished session yet", request.folder.string()));
  }
  WholeFile whole(request.out, request.overwrite);
  whole.write(drilling::class_page(found));
  whole.finish();
}

}  // namespace haptrial::experiments
