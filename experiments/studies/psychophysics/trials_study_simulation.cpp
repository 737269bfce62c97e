#include "experiments/studies/psychophysics/trials_study_simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "analysis/psychophysics/data/page_scores.h"
#include "analysis/psychophysics/data/read_trials.h"
#include "analysis/psychophysics/study/covariate.h"
#include "analysis/psychophysics/study/trials_study.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "experiments/studies/power_plan.h"
#include "experiments/studies/psychophysics/trials_analysis.h"
#include "experiments/study/study_run.h"
#include "protocols/psychophysics/response_session.h"

namespace haptrial::experiments {
namespace {

namespace trials = analysis::trials;
using protocols::StudiedDefinition;

/// Variables that the analysis looks at, beside those that every trial has.
std::vector<std::string> variables_of(const trials::TrialsPlan& plan) {
  const std::set<std::string> always{"condition", "block", "track", "probe", "group"};
  std::set<std::string> wanted(plan.by.begin(), plan.by.end());
  wanted.insert(plan.stimulus);
  wanted.insert(plan.level);
  std::vector<std::string> names;
  for (const std::string& name : wanted) {
    if (!name.empty() && !always.contains(name)) {
      names.push_back(name);
    }
  }
  return names;
}

trials::StudyTrial study_trial(std::size_t session, protocols::AnsweredTrial answered) {
  trials::StudyTrial trial;
  trial.session = session;
  trial.trial = answered.plan.trial;
  trial.block = answered.plan.block;
  trial.condition = std::move(answered.plan.condition);
  trial.probe = std::move(answered.probe);
  trial.practice = answered.plan.practice;
  for (record::LevelRow& row : answered.levels) {
    trial.levels.push_back(
        {std::move(row.track), std::move(row.variable), row.asked, row.applied, row.outcome});
  }
  for (record::ResponseRow& row : answered.answers) {
    trial.answers.push_back({std::move(row.question), row.value, std::move(row.text), row.correct});
  }
  trial.variables.push_back({"block", 0, trials::kNotKnown, answered.plan.block_name});
  for (record::VariableRow& row : answered.variables) {
    trial.variables.push_back({std::move(row.name), row.interval, row.value, std::move(row.word)});
  }
  return trial;
}

void note_values(const trials::Quantity& q, std::vector<NamedNumber>& values) {
  for (std::size_t cell = 0; cell < q.means.size(); ++cell) {
    if (const auto mean = trials::mean_of(q, cell)) {
      const std::string where = q.table.names[cell].empty() ? "" : " of " + q.table.names[cell];
      values.push_back({fmt::format("{}: mean{}", q.title, where), *mean});
    }
  }
  const auto note_family = [&](const analysis::TestFamily& family) {
    for (const analysis::SideTest& test : family.tests) {
      if (test.t) {
        const std::string name =
            fmt::format("{}: {} {}, ", q.title, family.name, text_of(test.sides));
        values.push_back({name + name_of_test(test), test.t->difference});
      }
    }
  };
  note_family(q.tests.planned);
  for (const analysis::TestFamily& family : q.tests.families) {
    note_family(family);
  }
}

SimulatedStudy simulated_study_of(const trials::TrialsResult& result) {
  SimulatedStudy r;
  for (const analysis::NamedTest& test : trials::tests_of(result)) {
    r.tests.push_back({test.name, test.p});
  }
  for (const trials::Quantity& q : result.quantities) {
    note_values(q, r.values);
  }
  if (result.drift) {
    r.values.push_back({"drift over the trials", result.drift->difference});
  }
  if (result.repetition) {
    r.values.push_back({"repetition of the answer before", result.repetition->difference});
  }
  for (const trials::FunctionFit& fit : result.fits) {
    if (!fit.stated) {
      r.failures.push_back("a psychometric function was not fitted: " + fit.stated.because());
    }
  }
  for (const trials::DetectedCondition& one : result.detected) {
    if (!one.detection) {
      r.failures.push_back("d' was not computed: " + one.detection.because());
    }
  }
  for (const trials::StudyTrial& trial : result.data.trials) {
    r.trials += trial.counts() ? 1U : 0U;
    if (!trial.completed) {
      r.failures.push_back("a trial was aborted");
    }
  }
  return r;
}

class TrialsStudySimulation final : public StudySimulation {
 public:
  TrialsStudySimulation(const StudiedDefinition& definition, trials::TrialsPlan plan,
                        std::string asked_in, const std::string& watched)
      : d_(definition), plan_(std::move(plan)), asked_in_(std::move(asked_in)) {
    plan_.resamples = 0;
    plan_.bayesian = false;
    plan_.hierarchical = false;
    plan_.track_intervals = false;
    plan_.serial = watched.find(": ") == std::string::npos;  // names of other tests have one
    plan_.population = !plan_.by.empty();                    // it tests nothing but conditions
    plan_.permutations =
        watched.find(", permutation") != std::string::npos ? plan_.permutations : 0;
    const int most = std::max(1, d_.most_trials());
    hours_of_trial_ = d_.longest(most) / most / 3600.0;
    read_responses();
    check_question();
  }

  bool people_differ() const override {
    const auto& people = d_.observer.people;
    return people && people->varies();
  }

  SimulatedStudy responses(std::uint64_t seed) const override {
    if (d_.script) {
      throw InputError(fmt::format(
          "{}: level_script chooses the levels, which responses alone do not run; give power.depth "
          "= \"sessions\"",
          asked_in_));
    }
    if (!session_) {
      throw InputError(
          fmt::format("{}: power.responses.met is missing; give the formula of what an interval "
                      "presents to the sense, such as \"$level\"",
                      asked_in_));
    }
    trials::TrialsData data;
    trials::TrialsPlan plan = plan_;
    for (int p = 0; p < d_.design.participants; ++p) {
      for (int session = 1; session <= d_.sessions(); ++session) {
        if (d_.comes(session, protocols::group_of(d_.groups, p))) {
          add_session(p, session, seed, data);
        }
      }
      draw_covariate(participant_name(p), seed, plan.plan.covariate);
    }
    return analyzed(std::move(data), plan, {});
  }

  SimulatedStudy sessions(const std::vector<std::filesystem::path>& files) const override {
    const auto group = [this](const std::string& subject) { return group_of(subject); };
    trials::TrialsPlan plan = plan_;
    trials::add_covariate(trials::page_scores(files, d_.pages, group), plan.plan.covariate);
    return analyzed(trials::read_trials(files, group, 1), plan, files);
  }

 private:
  void read_responses() {
    Table root = d_.root();
    if (!root.has("power") || !root.table("power").has("responses")) {
      return;
    }
    Table responses = root.table("power").table("responses");
    const std::string met = responses.text("met");
    root.check();
    session_.emplace(d_, met, variables_of(plan_));
    try {
      session_->check_met();
    } catch (const InputError& error) {
      responses.reject("met", fmt::format("is \"{}\": {}", met, error.what()));
      root.check();
    }
  }

  /// Analyses of movements need a hand, and those of two cues every trial's intervals.
  void check_responses() const {
    using trials::AnalysisKind;
    const AnalysisKind kind = plan_.kind;
    if (kind == AnalysisKind::kReaching || kind == AnalysisKind::kPursuit ||
        kind == AnalysisKind::kProduced || kind == AnalysisKind::kPaired || plan_.cues) {
      throw InputError(
          fmt::format("{}: responses alone do not simulate analyses of movements, of "
                      "pairs or of two cues; give power.depth = \"sessions\"",
                      asked_in_));
    }
  }

  /// The depth must suit the analysis.
  void check_question() const {
    Table root = d_.root();
    if (root.has("power") && read_power_plan(root).depth == PowerDepth::kResponses) {
      check_responses();
    }
  }

  /// Answers alone have no pages: the score is drawn, related to nothing, as those of the random
  /// answers to pages of full sessions.
  static void draw_covariate(const std::string& subject, std::uint64_t seed,
                             analysis::Covariate& covariate) {
    if (!covariate.name.empty()) {
      RandomStream random(seed, "covariate of " + subject);
      covariate.values[subject] = random.normal();
    }
  }

  std::string group_of(const std::string& subject) const {
    return d_.groups.size() > 1 ? protocols::group_of(d_.groups, subject) : std::string();
  }

  void add_session(int participant, int session, std::uint64_t seed,
                   trials::TrialsData& data) const {
    protocols::SessionPlace place;
    place.subject = participant_name(participant);
    place.participant = participant;
    place.seed = seed;
    place.session = session;
    protocols::give_seeds(place);
    data.sessions.push_back({place.subject,
                             place.subject,
                             group_of(place.subject),
                             "simulated",
                             true,
                             false,
                             session,
                             {}});
    for (protocols::AnsweredTrial& each : session_->answered(place)) {
      data.trials.push_back(study_trial(data.sessions.size() - 1, std::move(each)));
    }
  }

  /// @param files  of the sessions; none of responses alone
  SimulatedStudy analyzed(trials::TrialsData data, const trials::TrialsPlan& plan,
                          const std::vector<std::filesystem::path>& files) const {
    trials::TrialsResult result = trials::analyze(std::move(data), plan, procedures(), 1);
    if (!files.empty()) {
      add_file_quantities(d_, files, 1, result);
    }
    trials::keep_equivalence(result.quantities, plan.plan.beside);
    trials::separate_secondary(result.quantities, plan);
    SimulatedStudy r = simulated_study_of(result);
    r.hours = static_cast<double>(r.trials) * hours_of_trial_;
    return r;
  }

  /// Replayed only where estimates come from the procedures themselves, or are compared with
  /// theirs.
  trials::ProcedureOf procedures() const {
    const bool needed = plan_.serial || plan_.kind == trials::AnalysisKind::kAdjustment ||
                        std::ranges::any_of(d_.tracks, [](const protocols::Track& track) {
                          return !track.further.empty();
                        });
    if (!needed) {
      return {};
    }
    return [this](const std::string& name) -> std::unique_ptr<psychometric::Procedure> {
      for (const protocols::Track& track : d_.tracks) {
        const bool own = name == track.name || name.starts_with(track.name + ", ");
        if (own && !track.listed && track.begin) {
          return track.begin(1, name);
        }
      }
      return nullptr;
    };
  }

  const StudiedDefinition& d_;
  trials::TrialsPlan plan_;
  std::string asked_in_;  // file with [power]
  double hours_of_trial_{0.0};
  std::optional<protocols::ResponseSession> session_;
};

}  // namespace

std::unique_ptr<StudySimulation> trials_study_simulation(const StudiedDefinition& definition,
                                                         trials::TrialsPlan plan,
                                                         const std::string& asked_in,
                                                         const std::string& watched) {
  return std::make_unique<TrialsStudySimulation>(definition, std::move(plan), asked_in, watched);
}

}  // namespace haptrial::experiments
