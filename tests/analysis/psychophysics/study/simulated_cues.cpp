#include "tests/analysis/psychophysics/study/simulated_cues.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/statistics/base/distributions.h"
#include "core/base/random.h"

namespace haptrial::test {
namespace {

using namespace analysis::trials;

constexpr double kStandardSize = 0.055;  // [m]
constexpr std::array kLevels{0.043, 0.047, 0.051, 0.055, 0.059, 0.063, 0.067};
constexpr std::array kConflicts{-0.006, 0.0, 0.006};

/// Trials of one condition.
struct Shown {
  std::string modality;
  std::size_t noise{0};
  double conflict{0.0};
  double pse{kStandardSize};
  double sd{0.005};
};

std::vector<Shown> conditions_of(const SimulatedCues& study, int participant) {
  std::vector<Shown> all{{"hand", 0, 0.0, kStandardSize, true_cues(study, participant, 0).hand}};
  for (std::size_t noise = 0; noise < study.eye_sd.size(); ++noise) {
    const TrueCues own = true_cues(study, participant, noise);
    all.push_back({"eye", noise, 0.0, kStandardSize, own.eye});
    for (const double conflict : kConflicts) {
      const double pse = kStandardSize + (own.weight - 0.5) * conflict;
      all.push_back({"both", noise, conflict, pse, own.both});
    }
  }
  return all;
}

class Answers {
 public:
  Answers(const SimulatedCues& study, const std::string& name)
      : study_(study), random_(study.seed, "answers " + name) {}

  void add(StudyTrial base, const Shown& shown, std::vector<StudyTrial>& trials) {
    const double half = 0.5 * shown.conflict;
    // Variables as sessions have them: those of the whole trial, and the place in which the
    // standard came.
    base.variables = {{"modality", 0, kNotKnown, shown.modality},
                      {"noise", 0, static_cast<double>(shown.noise), ""},
                      {"conflict", 0, shown.conflict, ""},
                      {"interval.standard", 0, 0.0, ""}};
    for (const double level : kLevels) {
      for (int i = 0; i < study_.repetitions; ++i) {
        StudyTrial trial = base;
        trial.trial = ++number_;
        const int place = 1 + number_ % 2;
        trial.variables.back().value = place;
        trial.variables.push_back({"seen", place, kStandardSize + half, ""});
        trial.variables.push_back({"felt", place, kStandardSize - half, ""});
        trial.variables.push_back({"seen", 3 - place, level, ""});
        trial.variables.push_back({"felt", 3 - place, level, ""});
        const double outcome = taller(shown, level, i) ? 1.0 : 0.0;
        trial.levels = {{"all", "level", level, level, outcome}};
        trials.push_back(std::move(trial));
      }
    }
  }

 private:
  bool taller(const Shown& shown, double level, int i) {
    const double z = (level - shown.pse) / shown.sd;
    const double p = 0.5 * study_.lapse + (1.0 - study_.lapse) * analysis::normal_upper_tail(-z);
    return study_.exact ? i + 0.5 < p * study_.repetitions : random_.uniform() < p;
  }

  const SimulatedCues& study_;
  RandomStream random_;
  int number_{0};
};

}  // namespace

TrueCues true_cues(const SimulatedCues& study, int participant, std::size_t noise) {
  RandomStream people(study.seed, fmt::format("person {}", participant));
  TrueCues own;
  own.eye = study.eye_sd[noise] * std::exp(study.spread * people.normal());
  own.hand = study.hand_sd * std::exp(study.spread * people.normal());
  const double eye = own.eye * own.eye, hand = own.hand * own.hand;
  if (study.use == CueUse::kLeastVariance) {
    own.weight = hand / (eye + hand);
    own.both = std::sqrt(eye * hand / (eye + hand));
  } else {
    own.weight = own.eye < own.hand ? 1.0 : 0.0;
    own.both = std::min(own.eye, own.hand);
  }
  return own;
}

TrialsData simulated_cues(const SimulatedCues& study) {
  TrialsData data;
  for (int p = 0; p < study.participants; ++p) {
    const std::string name = fmt::format("P{:02}", p + 1);
    data.sessions.push_back({name + ".h5", name, "", "simulated", true, false});
    Answers answers(study, name);
    StudyTrial base;
    base.session = static_cast<std::size_t>(p);
    for (const Shown& shown : conditions_of(study, p)) {
      answers.add(base, shown, data.trials);
    }
  }
  return data;
}

TrialsPlan plan_of(const SimulatedCues& study) {
  TrialsPlan plan;
  plan.kind = AnalysisKind::kPsychometric;
  plan.by = {"modality", "noise", "conflict"};
  plan.functions = true;
  plan.function = psychometric::parameters_named("norm", 0.0);
  plan.function.axis.unit = "m";
  plan.threshold_at = 0.5;
  plan.bayesian = false;
  plan.resamples = 0;
  plan.permutations = 0;
  plan.seed = study.seed;
  plan.cues = CuePlan{{{"modality", "eye"}},
                      {{"modality", "hand"}},
                      {{"modality", "both"}},
                      "noise",
                      "conflict",
                      "standard",
                      "seen",
                      "felt"};
  return plan;
}

}  // namespace haptrial::test
