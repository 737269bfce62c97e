#include "tests/analysis/psychophysics/simulated_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "core/base/random.h"
#include "core/psychometric/function/response_observer.h"
#include "core/psychometric/procedure/listed.h"
#include "core/psychometric/procedure/staircase.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/rows/trial_rows.h"

namespace haptrial::test {
namespace {

using namespace analysis::trials;
using psychometric::PsychometricParameters;

constexpr double kStandard = 300.0;  // [N/m]
const std::vector<std::string> kShapes{"sphere", "egg", "cube", "cylinder"};

PsychometricParameters function_of(const SimulatedTrials& study, double person) {
  PsychometricParameters p =
      psychometric::parameters_named(study.task == SimulatedTask::kComparison ? "norm" : "weibull",
                                     study.task == SimulatedTask::kComparison ? 0.0 : 0.5);
  p.axis.unit = study.task == SimulatedTask::kComparison ? "N" : "N/m";
  p.lapse = 0.01;
  if (study.task == SimulatedTask::kComparison) {
    p.threshold = kTypicalPoint + person;
    p.width = 3.0;
    p.guess = 0.01;
  } else {
    p.axis.origin = kStandard;
    p.threshold = p.axis.level(kTypicalLogThreshold + person);
    p.width = 1.8;
  }
  return p;
}

std::vector<std::unique_ptr<psychometric::Procedure>> procedures_of(const SimulatedTrials& study,
                                                                    std::uint64_t seed) {
  std::vector<std::unique_ptr<psychometric::Procedure>> all;
  if (study.task == SimulatedTask::kStaircase) {
    for (const double start : {450.0, 345.0}) {
      psychometric::StaircaseParameters p;
      p.axis = {psychometric::Scale::kLog10, kStandard, "N/m"};
      p.start = start;
      p.low = 302.0;
      p.high = 600.0;
      p.steps = {{0.2, 0.2, 0}, {0.1, 0.1, 1}};
      p.stop_trials = study.trials / 2;
      p.skip = 2;
      all.push_back(std::make_unique<psychometric::Staircase>(p));
    }
    return all;
  }
  psychometric::ListParameters list;
  list.levels = study.task == SimulatedTask::kComparison
                    ? std::vector<double>{7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0}
                : study.task == SimulatedTask::kMagnitude
                    ? std::vector<double>{1.0, 2.0, 4.0, 8.0, 16.0}
                : study.task == SimulatedTask::kDetection ? std::vector<double>{0.0, 1.0}
                : study.task == SimulatedTask::kIdentification
                    ? std::vector<double>{0.0, 1.0, 2.0, 3.0}  // of kShapes
                : study.task == SimulatedTask::kTimes
                    ? std::vector<double>{1.0, 2.0, 3.0, 4.0}
                    : std::vector<double>{305.0, 312.0, 320.0, 335.0, 360.0, 420.0};
  list.repetitions = std::max(1, study.trials / static_cast<int>(list.levels.size()));
  if (study.task == SimulatedTask::kMagnitude) {
    all.push_back(
        std::make_unique<psychometric::MagnitudeEstimation>(list, std::nullopt, seed, "levels"));
  } else {
    all.push_back(std::make_unique<psychometric::ConstantStimuli>(list, seed, "levels"));
  }
  return all;
}

/// One participant in one condition.
class SimulatedSession {
 public:
  SimulatedSession(const SimulatedTrials& study, std::uint64_t seed, double person, double modulus)
      : study_(study),
        person_(person),
        modulus_(modulus),
        random_(seed, "answers"),
        observer_({function_of(study, person), study.repetition, study.drift}, seed, "observer"),
        procedures_(procedures_of(study, seed)) {}

  void run(StudyTrial base, std::vector<StudyTrial>& trials, int& number) {
    for (std::size_t turn = 0; running(); ++turn) {
      const std::size_t track = turn % procedures_.size();
      psychometric::Procedure& procedure = *procedures_[track];
      if (procedure.finished()) {
        continue;
      }
      StudyTrial trial = base;
      trial.trial = ++number;
      const double level = procedure.next().front();
      const double outcome = answer(level, trial);
      procedure.report(outcome, {level});
      trial.levels = {
          {fmt::format("track {}, {}", track + 1, base.condition), "level", level, level, outcome}};
      trials.push_back(std::move(trial));
    }
  }

 private:
  bool running() const {
    for (const auto& procedure : procedures_) {
      if (!procedure->finished()) {
        return true;
      }
    }
    return false;
  }

  double answer(double level, StudyTrial& trial) {
    const double time = 0.4 + 0.2 * random_.uniform();
    switch (study_.task) {
      case SimulatedTask::kStaircase:
      case SimulatedTask::kConstant: {
        const int right = observer_.answer(level);
        const bool first = random_.uniform() < 0.5;
        const bool said_first = (right == 1) == first;
        trial.answers = {
            {"stiffer", said_first ? 1.0 : 2.0, said_first ? "first" : "second", right, time}};
        return right;
      }
      case SimulatedTask::kComparison: {
        const int larger = observer_.answer(level);
        trial.answers = {
            {"larger", larger == 1 ? 2.0 : 1.0, larger == 1 ? "larger" : "smaller", -1, time}};
        return larger;
      }
      case SimulatedTask::kDetection: {
        const double felt = random_.normal() + (level > 0.0 ? kTypicalDPrime + person_ : 0.0);
        const double beyond = felt - 0.8;
        const bool yes = beyond > 0.0;
        const double sure = std::abs(beyond) > 1.2 ? 3.0 : std::abs(beyond) > 0.5 ? 2.0 : 1.0;
        trial.answers = {{"felt", yes ? 1.0 : 2.0, yes ? "yes" : "no", -1, time},
                         {"sure", sure, "", -1, time}};
        return yes ? 1.0 : 0.0;
      }
      case SimulatedTask::kIdentification:
        return identify(static_cast<std::size_t>(level), time, trial);
      case SimulatedTask::kTimes: {
        const bool right = random_.uniform() > 0.08;
        const bool left = random_.uniform() < 0.5;
        trial.answers = {{"where", left ? 1.0 : 2.0, left ? "left" : "right", right ? 1 : 0,
                          0.05 * level + 0.4 * std::exp(person_ + 0.2 * random_.normal())}};
        return right ? 1.0 : 0.0;
      }
      case SimulatedTask::kMagnitude:
        break;
    }
    const double number = modulus_ * std::exp((kTypicalExponent + person_) * std::log(level) +
                                              0.15 * random_.normal());
    trial.answers = {{"number", number, "", -1, time}};
    return number;
  }

  /// Each shape gives noise, the one presented d' more; the largest is answered.
  double identify(std::size_t shown, double time, StudyTrial& trial) {
    std::array<double, 4> felt{};
    for (std::size_t i = 0; i < felt.size(); ++i) {
      felt[i] = random_.normal() + (i == shown ? kTypicalDPrime + person_ : 0.0);
    }
    const auto most = std::max_element(felt.begin(), felt.end());
    const auto answered = static_cast<std::size_t>(most - felt.begin());
    const double best = *most;
    std::nth_element(felt.begin(), felt.begin() + 1, felt.end(), std::greater<>());
    const double lead = best - felt[1];
    const bool right = answered == shown;
    trial.variables.push_back({"shape", 0, kNotKnown, kShapes[shown]});
    trial.answers = {
        {"which", static_cast<double>(answered) + 1.0, kShapes[answered], right ? 1 : 0, time},
        {"sure",
         lead > 1.2   ? 3.0
         : lead > 0.5 ? 2.0
                      : 1.0,
         "", -1, time}};
    return right ? 1.0 : 0.0;
  }

  const SimulatedTrials& study_;
  double person_, modulus_;
  RandomStream random_;
  psychometric::ResponseObserver observer_;
  std::vector<std::unique_ptr<psychometric::Procedure>> procedures_;
};

record::SessionInfo info_of(const StudySession& session, const std::string& definition) {
  record::SessionInfo info;
  info.subject = session.participant;
  info.definition = definition;
  info.definition_name = "study.toml";
  info.device = "virtual";
  info.clock = session.clock;
  info.start_utc = "2026-11-20T09:30:00Z";
  info.simulated = session.simulated;
  return info;
}

/// Rows of one trial, as the program writes them.
class SessionRows {
 public:
  SessionRows(record::SessionWriter& writer, int ticks) : writer_(writer), ticks_(ticks) {}

  void add(const StudyTrial& trial) {
    record::PassRow pass;
    pass.trial = trial.trial;
    pass.condition = trial.condition;
    pass.phase = record::Phase(record::kPresentedPhase);
    pass.block = trial.block;
    pass.practice = trial.practice;
    pass.attempt = trial.attempt;
    pass.status = trial.completed ? record::PassStatus::kCompleted : record::PassStatus::kAborted;
    pass.first_sample = next_;
    std::vector<record::Sample> samples;
    for (int k = 0; k < ticks_; ++k) {
      record::Sample sample;
      sample.sequence = next_++;
      sample.time_ns = static_cast<std::int64_t>(sample.sequence) * 1'000'000;
      sample.pass = row_;
      sample.stage = record::Stage::kRun;
      sample.saturated = std::ranges::any_of(trial.stages, [k](const StageTime& stage) {
        const auto first = static_cast<int>(stage.first);
        return stage.at_limit && k >= first && k < first + static_cast<int>(stage.ticks);
      });
      samples.push_back(sample);
    }
    pass.last_sample = next_ - 1;
    writer_.append(samples);
    add_tables(trial, pass);
    writer_.add_pass(pass);
    ++row_;
  }
  std::uint64_t ticks() const { return next_; }

 private:
  void add_tables(const StudyTrial& trial, const record::PassRow& pass) {
    for (const GivenAnswer& answer : trial.answers) {
      record::ResponseRow row;
      row.trial = trial.trial;
      row.pass = row_;
      row.question = answer.question;
      row.value = answer.value;
      row.text = answer.text;
      row.correct = answer.correct;
      row.source = record::ResponseSource::kKey;
      row.reaction_time = answer.reaction_time;
      row.sequence = pass.last_sample;
      writer_.add_response(row);
    }
    std::vector<record::VariableRow> variables{
        {row_, 0, "probe", kNotKnown, trial.probe.empty() ? "no" : trial.probe.text()},
        {row_, 0, "trial", double(trial.trial), ""}};
    for (const GivenVariable& v : trial.variables) {
      variables.push_back({row_, v.interval, v.name, v.value, v.word});
    }
    std::vector<record::LevelRow> levels;
    for (const GivenLevel& l : trial.levels) {
      levels.push_back({row_, l.track, l.variable, l.asked, l.applied, l.outcome});
    }
    std::vector<record::StageRow> stages;
    for (const StageTime& s : trial.stages) {
      record::StageRow row;
      row.pass = row_;
      row.interval = s.interval;
      row.stage = s.stage;
      row.first_sample = pass.first_sample + s.first;
      row.last_sample = row.first_sample + s.ticks - 1;
      stages.push_back(row);
    }
    writer_.add(std::span<const record::VariableRow>(variables));
    writer_.add(std::span<const record::LevelRow>(levels));
    writer_.add(std::span<const record::StageRow>(stages));
  }

  record::SessionWriter& writer_;
  int ticks_;
  std::int32_t row_{0};
  std::uint64_t next_{0};
};

}  // namespace

TrialsData simulated_trials(const SimulatedTrials& study) {
  TrialsData data;
  for (int p = 0; p < study.participants; ++p) {
    const std::string name = fmt::format("P{:02}", p + 1);
    RandomStream people(study.seed, "person " + name);
    const double own = study.spread * people.normal();
    const double modulus = std::exp(1.0 + 0.5 * people.normal());
    data.sessions.push_back({name + ".h5", name, "", "simulated", true, false});
    int number = 0;
    for (int turn = 0; turn < study.conditions; ++turn) {
      const int condition = study.conditions > 1 && p % 2 == 1 ? 1 - turn : turn;
      const double person = own + study.interaction * people.normal() + study.effect * condition;
      StudyTrial base;
      base.session = static_cast<std::size_t>(p);
      base.block = turn + 1;
      base.condition = condition == 1 ? "on" : "off";
      base.variables = {{"light", 0, kNotKnown, base.condition}};
      const std::uint64_t seed = derived_seed(study.seed, fmt::format("{} {}", name, condition));
      SimulatedSession(study, seed, person, modulus).run(base, data.trials, number);
    }
  }
  return data;
}

TrialsPlan plan_of(const SimulatedTrials& study) {
  TrialsPlan plan;
  plan.kind = study.task == SimulatedTask::kDetection        ? AnalysisKind::kDetection
              : study.task == SimulatedTask::kMagnitude      ? AnalysisKind::kMagnitude
              : study.task == SimulatedTask::kIdentification ? AnalysisKind::kIdentification
              : study.task == SimulatedTask::kTimes          ? AnalysisKind::kTimes
                                                             : AnalysisKind::kPsychometric;
  if (study.conditions > 1) {
    plan.by = {"light"};
  }
  plan.functions = plan.kind == AnalysisKind::kPsychometric;
  plan.function = function_of(study, 0.0);
  plan.function_name = study.task == SimulatedTask::kComparison ? "norm" : "weibull";
  plan.guess_free = study.task == SimulatedTask::kComparison;
  plan.threshold_at = plan.guess_free ? 0.5 : 0.75;
  plan.reference = study.task == SimulatedTask::kComparison ? 10.0 : kStandard;
  if (study.task == SimulatedTask::kIdentification) {
    plan.stimulus = "shape";
    plan.choices = kShapes;
  }
  const bool rated =
      study.task == SimulatedTask::kDetection || study.task == SimulatedTask::kIdentification;
  plan.rating = rated ? "sure" : "";
  plan.level = study.task == SimulatedTask::kTimes ? "level" : "";
  plan.resamples = 0;
  plan.permutations = 0;
  plan.bayesian = false;
  return plan;
}

void write_sessions(const TrialsData& data, const std::filesystem::path& folder, int ticks,
                    const std::string& definition) {
  record::TableList tables = record::trial_tables();
  tables.push_back(&record::responses_table());
  for (std::size_t s = 0; s < data.sessions.size(); ++s) {
    record::SessionWriter writer(folder / data.sessions[s].file,
                                 info_of(data.sessions[s], definition), tables);
    SessionRows rows(writer, ticks);
    for (const StudyTrial& trial : data.trials) {
      if (trial.session == s) {
        rows.add(trial);
      }
    }
    writer.set_timing({}, {rows.ticks(), 0, 0});
    writer.close();
  }
}

}  // namespace haptrial::test
