#include "experiments/studies/force/force_study_simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "analysis/force_training/study/learned_scores.h"
#include "analysis/force_training/study/study_statistics.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "experiments/study/study_run.h"
#include "protocols/definition/groups.h"
#include "protocols/interface/trials.h"

namespace haptrial::experiments {
namespace {

using analysis::StudyStatistics;
using analysis::TrialScore;

/// The parts of a score.
struct ScoreParts {
  double mean{0.0};
  double practice{0.0};  // from trial to trial of the session
  double participant{0.0}, interaction{0.0}, block{0.0}, trial{0.0};  // standard deviations
  std::map<std::string, double> effects;                              // by condition
};

std::optional<ScoreParts> read_parts(const protocols::ForceDefinition& d) {
  const std::vector<std::string>& conditions = d.design.conditions;
  Table root = d.root();
  if (!root.has("power") || !root.table("power").has("responses")) {
    return std::nullopt;
  }
  Table table = root.table("power").table("responses");
  ScoreParts parts;
  parts.mean = table.number("mean", {}, "");
  parts.participant = table.number("participant", kNonNegative, "");
  parts.interaction = table.number("interaction", kNonNegative, "");
  parts.block = table.number("block", kNonNegative, "");
  parts.trial = table.number("trial", kNonNegative, "");
  parts.practice = table.number_or("practice", 0.0, {}, "");
  if (table.has("effects")) {
    Table effects = table.table("effects");
    for (const std::string& name : effects.keys()) {
      parts.effects[name] = effects.number(name, {}, "");
      if (std::ranges::find(conditions, name) == conditions.end()) {
        effects.reject(name, "is no condition of the design; name one of design.conditions");
      }
    }
  }
  root.check();
  return parts;
}

void note_tests(const analysis::TestFamily& family, SimulatedStudy& r) {
  for (const analysis::NamedTest& test : named_tests(family, family.name + ": ")) {
    r.tests.push_back({test.name, test.p});
  }
  for (const analysis::SideTest& test : family.tests) {
    if (test.t) {
      const std::string name = fmt::format("{}: {}", family.name, text_of(test.sides));
      r.values.push_back({name + ", " + name_of_test(test), test.t->difference});
    }
  }
}

void note_pooled(const StudyStatistics& study, SimulatedStudy& r) {
  if (study.anova) {
    r.tests.push_back({"as published: pooled trials, analysis of variance", study.anova->p});
  }
  for (const analysis::PooledComparison& each : study.comparisons) {
    if (each.student) {
      const std::string name =
          fmt::format("as published: pooled trials, {}, Student's t", text_of(each.sides));
      r.tests.push_back({name, each.student->p});
      r.values.push_back({name, each.student->difference});
    }
  }
}

SimulatedStudy of_statistics(const StudyStatistics& study, std::size_t trials) {
  SimulatedStudy r;
  r.trials = trials;
  for (const auto& effect : study.tests.effects) {
    if (effect) {
      r.tests.push_back({effect->factor + ": " + effect->test, effect->p});
    }
  }
  if (study.tests.ranks) {
    r.tests.push_back({"condition: on ranks", study.tests.ranks->p});
  }
  note_tests(study.tests.planned, r);
  for (const analysis::TestFamily& family : study.tests.families) {
    note_tests(family, r);
  }
  if (study.mixed.omnibus) {
    r.tests.push_back({"mixed model: all conditions", study.mixed.omnibus->p});
  } else {
    r.failures.push_back("the mixed model was not fitted: " + study.mixed.omnibus.because());
  }
  note_pooled(study, r);
  for (const analysis::ConditionSummary& each : study.summaries) {
    if (each.participants) {
      r.values.push_back({"score: mean of " + each.condition, each.participants->mean});
    }
  }
  return r;
}

/// The tests of changes from session to session, as the report names them.
void note_learned(const analysis::LearnedStudy& learned, SimulatedStudy& r) {
  for (const analysis::LearnedOutcome& outcome : learned.outcomes) {
    const std::string of = fmt::format("change of {}, ", outcome.title);
    for (const auto& effect : outcome.tests.effects) {
      if (effect) {
        r.tests.push_back({of + effect->factor + ": " + effect->test, effect->p});
      }
    }
    analysis::TestFamily planned = outcome.tests.planned;
    planned.name = of + planned.name;
    note_tests(planned, r);
  }
}

class ForceStudySimulation final : public StudySimulation {
 public:
  ForceStudySimulation(const protocols::ForceDefinition& definition, std::string asked_in,
                       CurveAnalysis curves)
      : d_(definition),
        asked_in_(std::move(asked_in)),
        curves_(std::move(curves)),
        parts_(read_parts(definition)) {
    hours_of_trial_ = d_.longest(d_.design.trials) / d_.design.trials / 3600.0;
  }

  bool people_differ() const override {
    return !parts_ || parts_->participant > 0.0 || parts_->interaction > 0.0;
  }

  SimulatedStudy responses(std::uint64_t seed) const override {
    if (d_.sessions() > 1) {
      throw InputError(
          fmt::format("{}: responses alone do not simulate force trainings of several sessions; "
                      "give power.depth = \"sessions\"",
                      asked_in_));
    }
    if (!parts_) {
      throw InputError(
          fmt::format("{}: power.responses is missing; give mean, participant, interaction, block "
                      "and trial, the parts of a score",
                      asked_in_));
    }
    std::vector<TrialScore> scores;
    for (int p = 0; p < d_.design.participants; ++p) {
      add_session(p, seed, scores);
    }
    analysis::StudyQuestions questions;
    questions.plan = curves_.plan;
    return with_hours(of_statistics(analysis::study_statistics(scores, questions), scores.size()));
  }

  SimulatedStudy sessions(const std::vector<std::filesystem::path>& files) const override {
    const analysis::StudyResult study = analyze_training(d_, curves_, files, 1);
    SimulatedStudy r = of_statistics(study.statistics, study.scores.size() + study.tests.size());
    note_learned(study.learned, r);
    return with_hours(std::move(r));
  }

 private:
  SimulatedStudy with_hours(SimulatedStudy r) const {
    r.hours = static_cast<double>(r.trials) * hours_of_trial_;
    return r;
  }

  void add_session(int participant, std::uint64_t seed, std::vector<TrialScore>& scores) const {
    protocols::SessionPlace place;
    place.subject = participant_name(participant);
    place.participant = participant;
    place.seed = seed;
    protocols::give_seeds(place);
    RandomStream people(place.session_seed, "score of participant");
    RandomStream blocks(place.session_seed, "score of block");
    RandomStream trials(place.session_seed, "score of trial");
    const double person = parts_->participant * people.normal();
    std::map<std::string, double> own;
    for (const std::string& condition : d_.design.conditions) {
      const auto effect = parts_->effects.find(condition);
      own[condition] = person + parts_->interaction * people.normal() +
                       (effect == parts_->effects.end() ? 0.0 : effect->second);
    }
    int block = 0;
    double of_block = 0.0;
    int scored = 0;
    for (const protocols::PlannedTrial& trial :
         plan_trials(d_.design, participant, seed, place.person_seed)) {
      if (trial.practice) {
        continue;
      }
      if (trial.block != block) {
        block = trial.block;
        of_block = parts_->block * blocks.normal();
      }
      TrialScore score;
      score.subject = place.subject;
      score.condition = trial.condition;
      score.levels = {trial.condition};
      score.trial = trial.trial;
      score.block = trial.block;
      score.repetition = trial.repetition;
      score.score = parts_->mean + own.at(trial.condition) + of_block +
                    parts_->trial * trials.normal() +
                    parts_->practice * static_cast<double>(scored++);
      scores.push_back(std::move(score));
    }
  }

  const protocols::ForceDefinition& d_;
  std::string asked_in_;  // file with [power]
  CurveAnalysis curves_;
  std::optional<ScoreParts> parts_;
  double hours_of_trial_{0.0};
};

}  // namespace

std::unique_ptr<StudySimulation> force_study_simulation(
    const protocols::ForceDefinition& definition, const std::string& asked_in,
    CurveAnalysis curves) {
  return std::make_unique<ForceStudySimulation>(definition, asked_in, std::move(curves));
}

namespace {

std::vector<analysis::SessionOfStudy> planned_sessions(const protocols::Definition& definition) {
  std::vector<analysis::SessionOfStudy> sessions;
  for (int session = 1; definition.sessions() > 1 && session <= definition.sessions(); ++session) {
    sessions.push_back({definition.session_name(session), definition.session_plan(session).gives});
  }
  return sessions;
}

/// Changes from session to session, if the definition has several.
void add_learned(const protocols::ForceDefinition& definition, const CurveAnalysis& curves,
                 analysis::StudyResult& study) {
  if (definition.sessions() == 1) {
    return;
  }
  for (const analysis::SessionSummary& session : study.sessions) {
    study.groups[session.info.subject] =
        protocols::group_of(definition.groups, session.info.subject);
  }
  study.learned = analysis::learned_study(analysis::learned_scores(study, curves.learning.outcomes),
                                          curves.learning, learning_names(definition));
}

}  // namespace

analysis::StudyResult analyze_training(const protocols::ForceDefinition& definition,
                                       const CurveAnalysis& curves,
                                       const std::vector<std::filesystem::path>& files,
                                       int threads) {
  analysis::StudyResult study = analysis::analyze_study(files, curves.scoring, threads, curves.plan,
                                                        planned_sessions(definition));
  add_learned(definition, curves, study);
  return study;
}

}  // namespace haptrial::experiments
