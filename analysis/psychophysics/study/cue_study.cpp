#include "analysis/psychophysics/study/cue_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "analysis/psychophysics/study/cue_bias.h"
#include "analysis/psychophysics/study/quantity.h"
#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/base/p_adjust.h"

namespace haptrial::analysis::trials {
namespace {

using analysis::CuePrediction;
using Known = analysis::Estimated;  // with a standard error

constexpr double kNormal = 1.959963984540054;  // 95 %
constexpr double kSame = 1e-9;                 // as levels agree in nine digits

/// log of a standard deviation with its standard error; NaN: the error is not known.
struct LogSd {
  double value{0.0};
  double error{kNotKnown};

  Estimated sd() const {
    return {std::exp(value), std::exp(value - kNormal * error), std::exp(value + kNormal * error)};
  }
  /// The value as analysis/psychometric/models takes it.
  Known known() const {
    const double sd = std::exp(value);
    return {sd, std::isfinite(error) ? sd * error : 0.0};
  }
};

Estimated estimated_of(const CuePrediction& p, bool with_interval) {
  return with_interval ? Estimated{p.value, p.low, p.high} : Estimated{p.value};
}

/// The distance from a share of 1/2 to a share of Phi(1) in widths.
double sd_in_widths(const psychometric::PsychometricParameters& function) {
  const auto curve = psychometric::curve_of(function);
  const double z = curve.z_for(1.0 - normal_upper_tail(1.0)) - curve.z_for(0.5);
  return std::abs(z / curve.spread());
}

LogSd log_sd_of(const FunctionReadings& readings, double in_widths) {
  const Estimated& width = readings.width;
  LogSd made{std::log(in_widths * width.value)};
  if (width.low > 0.0 && std::isfinite(width.high) && width.high > width.low) {
    made.error = std::log(width.high / width.low) / (2.0 * kNormal);
  }
  return made;
}

LogSd geometric_mean(const std::vector<LogSd>& sds) {
  LogSd mean{0.0, 0.0};
  for (const LogSd& sd : sds) {
    mean.value += sd.value / static_cast<double>(sds.size());
    mean.error = std::hypot(mean.error, sd.error / static_cast<double>(sds.size()));
  }
  return mean;
}

/// Conditions of one participant in the comparison.
class PersonalCues {
 public:
  PersonalCues(const TrialsData& data, const std::vector<AnsweredSeries>& series,
               const std::vector<FunctionFit>& fits, const TrialsPlan& plan)
      : data_(data),
        series_(series),
        fits_(fits),
        plan_(plan),
        cues_(*plan.cues),
        in_widths_(sd_in_widths(plan.function)) {}

  std::string level_of_factor(const FunctionFit& fit, const std::string& factor) const {
    const auto at = std::find(plan_.by.begin(), plan_.by.end(), factor);
    return at == plan_.by.end() ? std::string()
                                : fit.levels[static_cast<std::size_t>(at - plan_.by.begin())];
  }

  bool shows(const FunctionFit& fit, const FactorLevels& levels) const {
    return std::all_of(levels.begin(), levels.end(), [&](const auto& each) {
      return level_of_factor(fit, each.first) == each.second;
    });
  }

  /// Levels of a factor under both cues, of one level of `at`; null: of all.
  std::set<std::string> levels_of_both(const std::string& factor, const std::string* at) const {
    std::set<std::string> levels;
    for (const FunctionFit& fit : fits_) {
      if (shows(fit, cues_.both) && (at == nullptr || level_of_factor(fit, cues_.at) == *at)) {
        levels.insert(level_of_factor(fit, factor));
      }
    }
    return levels;
  }

  Defined<CuePerson> person(const std::string& participant, const std::string& at) const {
    const auto first = alone(participant, cues_.first, at, false);
    const auto second = alone(participant, cues_.second, at, true);
    const auto both = both_of(participant, at);
    if (!first || !second || !both) {
      return Undefined{!first ? first.because() : !second ? second.because() : both.because()};
    }
    const auto weight = observed(*both);
    if (!weight) {
      return Undefined{weight.because()};
    }
    CuePerson made = *weight;
    made.participant = participant;
    const LogSd one = sd_of(*first), other = sd_of(*second);
    made.first_sd = one.sd();
    made.second_sd = other.sd();
    made.both_sd = sd_of(*both).sd();
    predict(one, other,
            cue_bias(fits_at(*first), fits_at(*second), fits_at(*both), plan_,
                     fmt::format("cue prediction {} {}", participant, at)),
            made);
    return made;
  }

 private:
  using Places = std::vector<std::size_t>;  // in fits_

  /// Prediction for somebody who combines these cues best in these trials.
  static void predict(const LogSd& first, const LogSd& second, const CueBias& bias,
                      CuePerson& made) {
    const bool known = std::isfinite(first.error) && std::isfinite(second.error);
    const CombinedCues predicted = predict_combination(first.known(), second.known());
    made.predicted_weight = estimated_of(predicted.first_weight, known);
    made.predicted_sd = estimated_of(predicted.combined_sd, known);
    for (double Estimated::*part : {&Estimated::value, &Estimated::low, &Estimated::high}) {
      made.predicted_sd.*part *= std::exp(bias.log_sd);
      made.predicted_weight.*part = std::clamp(made.predicted_weight.*part - bias.weight, 0.0, 1.0);
    }
  }

  std::vector<const FunctionFit*> fits_at(const Places& places) const {
    std::vector<const FunctionFit*> fits;
    for (const std::size_t i : places) {
      fits.push_back(&fits_[i]);
    }
    return fits;
  }

  Places places_of(const std::string& participant, const FactorLevels& levels,
                   const std::string* at) const {
    Places places;
    for (std::size_t i = 0; i < fits_.size(); ++i) {
      const bool here =
          at == nullptr || cues_.at.empty() || level_of_factor(fits_[i], cues_.at) == *at;
      if (fits_[i].participant == participant && shows(fits_[i], levels) && here) {
        places.push_back(i);
      }
    }
    return places;
  }

  std::string called(const FactorLevels& levels, const std::string& at) const {
    const std::string name = name_of_cue(levels);
    return cues_.at.empty() ? name : fmt::format("{} at {} {}", name, cues_.at, at);
  }

  /// The reason, if one of these functions is not defined.
  const FunctionFit* undefined_in(const Places& places) const {
    for (const std::size_t i : places) {
      if (!fits_[i].stated) {
        return &fits_[i];
      }
    }
    return nullptr;
  }

  Undefined because_of(const FunctionFit& fit) const {
    return {fmt::format("the function of {} is not defined, because {}", fit.condition,
                        fit.stated.because())};
  }

  LogSd sd_of(const Places& places) const {
    std::vector<LogSd> sds;
    for (const std::size_t i : places) {
      sds.push_back(log_sd_of(*fits_[i].stated, in_widths_));
    }
    return geometric_mean(sds);
  }

  Defined<Places> alone(const std::string& participant, const FactorLevels& levels,
                        const std::string& at, bool elsewhere) const {
    Places places = places_of(participant, levels, &at);
    if (places.empty() && elsewhere) {  // this cue does not change with `at`
      places = places_of(participant, levels, nullptr);
      const auto level = [&](std::size_t i) { return level_of_factor(fits_[i], cues_.at); };
      if (std::any_of(places.begin(), places.end(),
                      [&](std::size_t i) { return level(i) != level(places.front()); })) {
        places.clear();
      }
    }
    if (places.empty()) {
      return Undefined{"there are no answers of " + called(levels, at)};
    }
    if (const FunctionFit* fit = undefined_in(places)) {
      return because_of(*fit);
    }
    return places;
  }

  /// The functions of all conflicts that anybody has at this level.
  Defined<Places> both_of(const std::string& participant, const std::string& at) const {
    const Places places = places_of(participant, cues_.both, &at);
    if (places.empty()) {
      return Undefined{"there are no answers of " + called(cues_.both, at)};
    }
    std::set<std::string> missing = levels_of_both(cues_.conflict, &at);
    for (const std::size_t i : places) {
      missing.erase(level_of_factor(fits_[i], cues_.conflict));
    }
    if (!missing.empty()) {
      return Undefined{fmt::format("there are no answers of {} with {} {}", called(cues_.both, at),
                                   cues_.conflict, fmt::join(missing, ", "))};
    }
    if (const FunctionFit* fit = undefined_in(places)) {
      return because_of(*fit);
    }
    return places;
  }

  /// Level of the standard's cue in a series, on the axis.
  Defined<double> shown(const AnsweredSeries& series, const std::string& variable) const {
    double low = INFINITY, high = -INFINITY;
    for (const LevelTrial& each : series.trials) {
      const StudyTrial& trial = data_.trials[each.trial];
      const GivenVariable* place = variable_of(trial, "interval." + cues_.standard);
      if (place == nullptr || !std::isfinite(place->value)) {
        return Undefined{fmt::format("the sessions do not say when \"{}\" came", cues_.standard)};
      }
      const GivenVariable* given = variable_of(trial, variable, static_cast<int>(place->value));
      given = given == nullptr ? variable_of(trial, variable) : given;
      const double x = given == nullptr ? kNotKnown : plan_.function.axis.at(given->value);
      if (!std::isfinite(x)) {
        return Undefined{fmt::format("\"{}\" has no number in some trials", variable)};
      }
      low = std::min(low, x);
      high = std::max(high, x);
    }
    if (high - low > kSame * std::max(std::abs(low), std::abs(high))) {
      return Undefined{
          fmt::format("\"{}\" of the standard varies within {}", variable, series.condition())};
    }
    return low;
  }

  /// Point at which a function is 1/2, on the axis, with its standard error; NaN: not known.
  Known equality(const FunctionFit& fit) const {
    const psychometric::Axis& axis = plan_.function.axis;
    Known pse{axis.at(read_off(fit.function(plan_), {Reading::kLevelOfShare, 0.5})), kNotKnown};
    for (const BandPoint& point : fit.band) {
      if (point.share == 0.5) {
        pse.error = (axis.at(point.level.high) - axis.at(point.level.low)) / (2.0 * kNormal);
      }
    }
    return pse;
  }

  /// Weight and bias from the conflicts.
  Defined<CuePerson> observed(const Places& places) const {
    std::vector<ConflictPse> conflicts;
    bool known = true;
    for (const std::size_t i : places) {
      const auto first = shown(series_[i], cues_.first_shows);
      const auto second = shown(series_[i], cues_.second_shows);
      if (!first || !second) {
        return Undefined{first ? second.because() : first.because()};
      }
      conflicts.push_back({*first, *second, equality(fits_[i])});
      known =
          known && std::isfinite(conflicts.back().pse.error) && conflicts.back().pse.error > 0.0;
    }
    for (ConflictPse& each : conflicts) {
      each.pse.error = known ? each.pse.error : 1.0;  // all alike
    }
    const auto weight = observed_weight(conflicts);
    if (!weight) {
      return Undefined{weight.because()};
    }
    CuePerson made;
    made.weight = estimated_of(weight->first_weight, known);
    made.bias = weight->bias;
    made.conflicts = conflicts.size();
    return made;
  }

  const TrialsData& data_;
  const std::vector<AnsweredSeries>& series_;
  const std::vector<FunctionFit>& fits_;
  const TrialsPlan& plan_;
  const CuePlan& cues_;
  double in_widths_;
};

/// Numbers by their size, words as they sort.
std::vector<std::string> in_order(const std::set<std::string>& words) {
  std::vector<std::string> sorted(words.begin(), words.end());
  const auto value = [](const std::string& word) {
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    return end != word.c_str() && *end == '\0' ? number : kNotKnown;
  };
  if (std::all_of(sorted.begin(), sorted.end(),
                  [&](const std::string& word) { return std::isfinite(value(word)); })) {
    std::stable_sort(sorted.begin(), sorted.end(), [&](const std::string& a, const std::string& b) {
      return value(a) < value(b);
    });
  }
  return sorted;
}

void compare(CueLevel& level) {
  std::vector<CueParticipant> people;
  for (const CuePerson& person : level.people) {
    people.push_back({person.first_sd.value, person.second_sd.value, person.both_sd.value,
                      person.weight.value, person.predicted_sd.value,
                      person.predicted_weight.value});
  }
  if (people.empty()) {
    return;
  }
  const CueComparison comparison = compare_cues(people);
  level.weight.test = comparison.weight;
  level.log_sd.test = comparison.log_sd;
  level.beats_best.test = comparison.beats_best;
}

void adjust(std::vector<CueLevel>& levels, CueTest CueLevel::*which) {
  std::vector<Defined<TTest>> tests;
  for (const CueLevel& level : levels) {
    tests.push_back((level.*which).test);
  }
  const auto adjusted = holm_over(tests);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    (levels[i].*which).holm = adjusted[i];
  }
}

}  // namespace

CueStudy cue_study(const TrialsData& data, const std::vector<AnsweredSeries>& series,
                   const std::vector<FunctionFit>& fits, const TrialsPlan& plan) {
  const PersonalCues cues(data, series, fits, plan);
  std::set<std::string> participants;
  for (const StudySession& session : data.sessions) {
    participants.insert(session.participant);
  }
  CueStudy study;
  for (const std::string& at : in_order(cues.levels_of_both(plan.cues->at, nullptr))) {
    CueLevel level;
    level.level = at;
    for (const std::string& participant : participants) {
      const auto person = cues.person(participant, at);
      if (person) {
        level.people.push_back(*person);
      } else {
        level.left_out.push_back(participant + ": " + person.because());
      }
    }
    compare(level);
    study.levels.push_back(std::move(level));
  }
  for (const auto which : {&CueLevel::weight, &CueLevel::log_sd, &CueLevel::beats_best}) {
    adjust(study.levels, which);
  }
  return study;
}

Estimated mean_of(const CueLevel& level, Estimated CuePerson::*number, bool geometric) {
  std::vector<double> values;
  for (const CuePerson& person : level.people) {
    const double value = (person.*number).value;
    values.push_back(geometric ? std::log(value) : value);
  }
  const auto back = [&](double value) { return geometric ? std::exp(value) : value; };
  if (const auto found = mean_interval(values)) {
    const bool share = number == &CuePerson::predicted_weight;  // the observed one may exceed 1
    const MeanInterval mean = within_range(*found, share ? ValueRange::kShare : ValueRange::kAny);
    return {back(mean.mean), back(mean.low), back(mean.high)};
  }
  return values.empty() ? Estimated{} : Estimated{back(values.front())};
}

}  // namespace haptrial::analysis::trials
