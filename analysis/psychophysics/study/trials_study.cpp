#include "analysis/psychophysics/study/trials_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "analysis/psychophysics/study/produced_quantities.h"
#include "core/base/error.h"
#include "core/base/parallel.h"

namespace haptrial::analysis::trials {
namespace {

std::vector<ParticipantTrials> participants_of(const TrialsData& data, const TrialsPlan& plan) {
  std::map<std::string, ParticipantTrials> people;
  std::map<std::string, std::vector<double>> times;
  for (const StudySession& session : data.sessions) {
    ParticipantTrials& own = people[session.participant];
    own.participant = session.participant;
    own.group = session.group;
    ++own.sessions;
    own.planned += session.planned;
  }
  for (const StudyTrial& trial : data.trials) {
    ParticipantTrials& own = people[data.session_of(trial).participant];
    if (!trial.completed || trial.again || trial.damaged) {
      ++own.aborted;
    } else if (trial.practice) {
      ++own.practice;
    } else if (!trial.left_out) {
      ++own.counted;
      std::set<std::string> limited;
      for (const StageTime& stage : trial.stages) {
        if (stage.at_limit) {
          limited.insert(stage.stage);
        }
      }
      for (const std::string& stage : limited) {
        own.at_limit[stage] += 1.0;
      }
      const GivenAnswer* answer = answer_to(trial, plan.question);
      if (answer != nullptr && answer->reaction_time == answer->reaction_time) {
        times[own.participant].push_back(answer->reaction_time);
      }
    }
  }
  std::vector<ParticipantTrials> all;
  for (auto& [name, own] : people) {
    for (auto& [stage, trials] : own.at_limit) {
      trials /= static_cast<double>(own.counted);
    }
    if (!times[name].empty()) {
      own.reaction_time = quantile(times[name], 0.5);
    }
    all.push_back(std::move(own));
  }
  return all;
}

template <class Value>
std::vector<QuantityValue> values_of(const std::vector<FunctionFit>& fits, Value&& value) {
  std::vector<QuantityValue> values;
  for (const FunctionFit& fit : fits) {
    if (fit.stated) {
      values.push_back({fit.participant, fit.levels, value(*fit.stated), fit.stated->open()});
    }
  }
  return values;
}

/// A track's range is that of the series if it set the level that counts.
void widen(AnsweredSeries& series, const TrackEstimate& track, const TrialsPlan& plan) {
  if (!track.range || (!plan.level.empty() && plan.level != track.variable)) {
    return;
  }
  if (!series.range) {
    series.range = track.range;
  }
  series.range->low = std::min(series.range->low, track.range->low);
  series.range->high = std::max(series.range->high, track.range->high);
}

/// Series with a track whose procedure chose levels by the answers.
void mark_adaptive(TrialsResult& result) {
  std::map<std::pair<std::string, std::string>, const TrackEstimate*> adaptive;
  for (const TrackEstimate& track : result.tracks) {
    if (track.adaptive) {
      adaptive[{track.participant, track.track}] = &track;
    }
  }
  for (AnsweredSeries& series : result.series) {
    for (const LevelTrial& trial : series.trials) {
      if (const auto at = adaptive.find({series.participant, trial.track}); at != adaptive.end()) {
        series.adaptive = true;
        widen(series, *at->second, result.plan);
      }
    }
  }
}

/// Half of the way from a quarter to three quarters of the answers 1, as a share of the width.
double limen_of_width(psychometric::PsychometricParameters p) {
  p.axis = {};
  p.threshold = 0.0;
  p.width = 1.0;
  p.falling = false;
  const psychometric::PsychometricFunction function(p);
  return 0.5 * (function.level_for_share(0.75) - function.level_for_share(0.25));
}

void add_difference_limens(TrialsResult& result) {
  const TrialsPlan& plan = result.plan;
  const double share = limen_of_width(plan.function);
  const auto limen = [share](const FunctionReadings& r) { return share * r.width.value; };
  result.quantities.push_back(quantity("difference_limen", "just noticeable difference",
                                       plan.function.axis.unit, values_of(result.fits, limen), plan,
                                       ValueRange::kPositive));
  result.quantities.back().compared = false;  // it says again what the width says
}

void add_functions(TrialsResult& result, const ProcedureOf& procedure_of, int threads) {
  const TrialsPlan& plan = result.plan;
  result.series = series_of(result.data, plan);
  mark_adaptive(result);
  if (result.series.empty() && !result.surfaces.empty()) {
    return;
  }
  result.fits.resize(result.series.size());
  in_groups(result.series.size(), 1, threads, [&] {
    return
        [&](std::size_t i, std::size_t) { result.fits[i] = fit_series(result.series[i], plan, 1); };
  });
  const std::string unit = plan.function.axis.x_unit();
  result.quantities.push_back(
      quantity("threshold", "threshold", unit,
               values_of(result.fits, [](const FunctionReadings& r) { return r.x.value; }), plan));
  result.quantities.back().on_axis = plan.baseline.empty();  // a change is no level
  result.quantities.push_back(quantity(
      "log_width", "logarithm of the width", "",
      values_of(result.fits, [](const FunctionReadings& r) { return std::log(r.width.value); }),
      without_directions(plan)));
  if (!(plan.function.guess > 0.0) && plan.function.axis.scale == psychometric::Scale::kLinear) {
    add_difference_limens(result);
  }
  if (plan.reference) {
    result.quantities.push_back(
        quantity("weber_fraction", "Weber fraction", "",
                 values_of(result.fits, [](const FunctionReadings& r) { return r.weber.value; }),
                 plan, ValueRange::kPositive));
    result.quantities.back().compared = false;  // it says again what the threshold says
  }
  if (plan.serial) {
    result.serial = serial_effects(result.data, result.series, result.fits, result.tracks, plan,
                                   procedure_of, threads);
    result.drift = against_zero(drifts(result.serial));
    result.repetition = against_zero(repetitions(result.serial));
  }
  if (plan.population) {
    result.population = population_model(result.series, plan);
  }
  if (plan.hierarchical) {
    result.hierarchical = hierarchical_functions(result.series, plan, threads);
  }
  if (plan.cues) {
    result.cues = cue_study(result.data, result.series, result.fits, plan);
  }
}

void add_detection(TrialsResult& result) {
  result.detected = detected(result.data, result.plan);
  std::vector<QuantityValue> d_prime, criterion, area, d_a, log_sd;
  for (const DetectedCondition& one : result.detected) {
    if (one.detection) {
      d_prime.push_back({one.participant, one.levels, one.detection->d_prime});
      criterion.push_back({one.participant, one.levels, one.detection->criterion});
    }
    if (one.roc) {
      area.push_back({one.participant, one.levels, one.roc->area});
    }
    if (one.binormal) {
      d_a.push_back({one.participant, one.levels, one.binormal->d_a});
      log_sd.push_back({one.participant, one.levels, -std::log(one.binormal->b)});
    }
  }
  const std::size_t first = result.quantities.size();
  const bool chosen = std::ranges::any_of(result.tracks, &TrackEstimate::adaptive);
  const std::string at = chosen ? " at the levels that the procedure chose" : "";
  const auto add = [&](const char* name, const std::string& title, const auto& values,
                       const TrialsPlan& plan, ValueRange range = ValueRange::kAny) {
    result.quantities.push_back(quantity(name, title + at, "", values, plan, range));
  };
  const TrialsPlan two_sided = without_directions(result.plan);
  add("d_prime", "sensitivity d'", d_prime, result.plan);
  add("criterion", "criterion c", criterion, two_sided);
  if (!area.empty()) {
    add("roc_area", "area under the ROC curve of ratings", area, result.plan, ValueRange::kShare);
  }
  if (!d_a.empty()) {
    add("d_a", "sensitivity d_a of unequal variances", d_a, result.plan);
    add("log_signal_sd", "logarithm of the signal's standard deviation over the noise's", log_sd,
        two_sided);
  }
  if (result.plan.metacognition) {
    std::ranges::move(metacognition_quantities(result.detected, result.plan),
                      std::back_inserter(result.quantities));
  }
  for (std::size_t i = first; i < result.quantities.size(); ++i) {
    result.quantities[i].headline = !chosen;  // another grid of levels would change them
  }
}

void add_identification(TrialsResult& result) {
  result.identified = identified(result.data, result.plan);
  std::vector<QuantityValue> share, d_prime, information, area;
  for (const IdentifiedCondition& one : result.identified) {
    share.push_back({one.participant, one.levels, one.share});
    if (one.d_prime) {
      d_prime.push_back({one.participant, one.levels, *one.d_prime});
    }
    if (one.information) {
      information.push_back({one.participant, one.levels, *one.information});
    }
    if (one.sureness) {
      area.push_back({one.participant, one.levels, one.sureness->area});
    }
  }
  result.quantities.push_back(quantity("share_right", "share of right answers", "", share,
                                       result.plan, ValueRange::kShare));
  result.quantities.push_back(quantity("d_prime", "sensitivity d'", "", d_prime, result.plan));
  if (!information.empty()) {
    result.quantities.push_back(
        quantity("information_transfer", "information transfer", "bit", information, result.plan));
  }
  if (!area.empty()) {
    result.quantities.push_back(quantity("rating_area",
                                         "area under the ROC curve of ratings, right against wrong",
                                         "", area, result.plan, ValueRange::kShare));
  }
  if (result.plan.metacognition) {
    std::ranges::move(metacognition_quantities(result.identified, result.plan),
                      std::back_inserter(result.quantities));
  }
}

void add_magnitudes(TrialsResult& result) {
  result.magnitudes = magnitudes(result.data, result.plan);
  std::vector<QuantityValue> exponents;
  for (const MagnitudeCondition& one : result.magnitudes) {
    for (std::size_t i = 0; one.law && i < one.law->participants.size(); ++i) {
      exponents.push_back(
          {one.participants[one.law->participants[i]], one.levels, one.law->exponents[i]});
    }
  }
  result.quantities.push_back(quantity("exponent", "exponent", "", exponents, result.plan));
}

/// One value of each participant and condition that has one.
template <class Value>
std::vector<QuantityValue> timed_values(const std::vector<TimedCondition>& timed, Value&& value) {
  std::vector<QuantityValue> values;
  for (const TimedCondition& one : timed) {
    values.push_back({one.participant, one.levels, value(one)});
  }
  return values;
}

void add_lines(TrialsResult& result, const std::string& what) {
  const TrialsPlan& plan = result.plan;
  const auto coefficient = [&](std::size_t which) {
    return timed_values(result.timed, [which](const TimedCondition& one) {
      return one.line ? one.line->coefficients[which].estimate : kNotKnown;
    });
  };
  result.quantities.push_back(quantity("slope",
                                       fmt::format("slope of the {} over {}", what, plan.level),
                                       slope_unit(plan), coefficient(1), plan));
  result.quantities.push_back(quantity("intercept", fmt::format("{} at {} = 0", what, plan.level),
                                       "s", coefficient(0), plan));
}

void add_times(TrialsResult& result) {
  const TrialsPlan& plan = result.plan;
  result.timed = timed(result.data, plan);
  const std::string what =
      plan.stage.empty() ? "reaction time" : fmt::format("duration of {}", plan.stage);
  result.quantities.push_back(quantity(
      plan.stage.empty() ? "reaction_time" : "duration", "mean " + what, "s",
      timed_values(result.timed,
                   [](const TimedCondition& one) { return one.mean ? *one.mean : kNotKnown; }),
      plan, ValueRange::kPositive));
  if (!plan.level.empty()) {
    add_lines(result, what);
  }
  if (std::ranges::any_of(result.timed, &TimedCondition::judged)) {
    result.quantities.push_back(quantity(
        "share_wrong", "share of wrong answers", "",
        timed_values(result.timed, [](const TimedCondition& one) { return one.share_wrong(); }),
        plan, ValueRange::kShare));
  }
  if (plan.diffusion) {
    std::ranges::move(diffusion_quantities(result.timed, plan),
                      std::back_inserter(result.quantities));
  }
}

/// The mean threshold of surfaces over several other variables; nothing is known of those with a
/// threshold beyond the levels, which are left out as open.
std::vector<QuantityValue> placed_values(const TrialsResult& result) {
  std::vector<QuantityValue> values;
  for (const SurfaceCondition& one : result.surfaces) {
    double sum = 0.0;
    for (const PlacedThreshold& each : one.placed) {
      sum += each.median;
    }
    if (!one.placed.empty()) {
      values.push_back({one.participant, one.levels, sum / static_cast<double>(one.placed.size()),
                        std::isnan(sum)});
    }
  }
  return values;
}

/// A number of each surface's threshold over its other variable; nothing is known of surfaces whose
/// threshold is not single everywhere, which are left out as open.
template <class Value>
std::vector<QuantityValue> surface_values(const TrialsResult& result, Value&& value) {
  std::vector<QuantityValue> values;
  for (const SurfaceCondition& one : result.surfaces) {
    if (one.points.empty()) {
      continue;
    }
    const bool single = std::ranges::all_of(
        one.points, [](const ContourPoint& point) { return point.second.size() == 1; });
    values.push_back(
        {one.participant, one.levels, single ? value(one.points) : kNotKnown, !single});
  }
  return values;
}

double mean_threshold(const std::vector<ContourPoint>& points) {
  double sum = 0.0;
  for (const ContourPoint& point : points) {
    sum += point.second.front();
  }
  return sum / static_cast<double>(points.size());
}

/// Rise of the threshold over the other variable, by least squares.
double threshold_slope(const std::vector<ContourPoint>& points) {
  const double middle = 0.5 * (points.front().first + points.back().first);  // evenly spaced
  double products = 0.0, squares = 0.0;
  for (const ContourPoint& point : points) {
    products += (point.first - middle) * point.second.front();
    squares += (point.first - middle) * (point.first - middle);
  }
  return products / squares;
}

/// Conditions are compared in the mean threshold of each participant over the other variables, and
/// in its slope over a single one.
void add_surface_quantities(TrialsResult& result) {
  const auto placed =
      std::ranges::find_if(result.surfaces, [](const auto& one) { return !one.placed.empty(); });
  if (!result.plan.by.empty() && placed != result.surfaces.end()) {
    result.quantities.push_back(quantity(
        "surface_threshold", "mean threshold of " + placed->variables.front() + " over the others",
        result.plan.function.axis.unit, placed_values(result), result.plan));
    return;
  }
  const auto drawn =
      std::ranges::find_if(result.surfaces, [](const auto& one) { return !one.points.empty(); });
  if (result.plan.by.empty() || drawn == result.surfaces.end()) {
    return;
  }
  const std::string& unit = result.plan.function.axis.unit;
  const std::string& over = drawn->variables[0];
  const std::string of = fmt::format("threshold of {} over {}", drawn->variables[1], over);
  result.quantities.push_back(quantity("surface_threshold", "mean " + of, unit,
                                       surface_values(result, mean_threshold), result.plan));
  result.quantities.push_back(quantity("surface_slope", "slope of the " + of,
                                       fmt::format("{} per {}", unit.empty() ? "1" : unit, over),
                                       surface_values(result, threshold_slope),
                                       without_directions(result.plan)));
}

/// A participant's setting under a condition: the mean of their tracks' own estimates.
/// The condition of all presentations of a track; nothing if they have several.
std::optional<std::vector<std::string>> condition_of(const TrackEstimate& track,
                                                     const TrialsResult& result) {
  std::optional<std::vector<std::string>> condition;
  for (const TrackStep& step : track.steps) {
    auto levels = factors_of(result.data, result.data.trials[step.trial], result.plan);
    if (condition && *condition != levels) {
      return std::nullopt;
    }
    condition = std::move(levels);
  }
  return condition;
}

void add_settings(TrialsResult& result) {
  std::map<std::pair<std::string, std::vector<std::string>>, std::vector<double>> settings;
  std::vector<std::string> missing;
  for (const TrackEstimate& track : result.tracks) {
    const auto condition = condition_of(track, result);
    std::string why = track.steps.empty()       ? "nothing was presented"
                      : track.estimates.empty() ? "no adjustment ended with a setting"
                      : !condition              ? "it is of several conditions"
                                                : track.estimates.front().remark;
    if (!why.empty()) {
      missing.push_back(fmt::format("{}, {}: {}", track.participant, track.track, why));
    }
    if (condition && !track.estimates.empty()) {
      settings[{track.participant, *condition}].push_back(track.estimates.front().value);
    }
  }
  std::vector<QuantityValue> values;
  for (const auto& [of, each] : settings) {
    values.push_back(
        {of.first, of.second,
         std::accumulate(each.begin(), each.end(), 0.0) / static_cast<double>(each.size())});
  }
  result.quantities.push_back(
      quantity("setting", "setting", result.plan.function.axis.unit, values, result.plan));
  result.quantities.back().missing = std::move(missing);
}

void add_tests(const Quantity& q, std::vector<NamedTest>& tests) {
  for (const auto& effect : q.tests.effects) {
    if (effect) {
      const auto held = effect->test.find("covariance");
      tests.push_back(
          {q.title + ": " + effect->factor + (held == std::string::npos ? "" : ", " + effect->test),
           effect->p});
    }
  }
  if (q.tests.ranks) {
    tests.push_back({q.title + ": on ranks", q.tests.ranks->p});
  }
  const auto add_family = [&](const TestFamily& family) {
    const auto named = named_tests(family, fmt::format("{}: {} ", q.title, family.name));
    tests.insert(tests.end(), named.begin(), named.end());
  };
  add_family(q.tests.planned);
  for (const TestFamily& family : q.tests.families) {
    add_family(family);
  }
}

void add_tests(const CueStudy& cues, std::vector<NamedTest>& tests) {
  for (const CueLevel& level : cues.levels) {
    const std::string at = level.level.empty() ? std::string() : " at " + level.level;
    for (const auto& [name, of] : {std::pair("weight, observed and predicted", &level.weight),
                                   {"standard deviation, observed and predicted", &level.log_sd},
                                   {"both cues and the better one", &level.beats_best}}) {
      if (of->test) {
        tests.push_back({fmt::format("cues{}: {}", at, name), of->test->p});
      }
    }
  }
}

}  // namespace

/// The sessions by the names that the definition gives them.
static void name_sessions(const TrialsPlan& plan, TrialsData& data) {
  for (StudySession& session : data.sessions) {
    const auto at = static_cast<std::size_t>(session.session - 1);
    session.name = at < plan.sessions.size() ? plan.sessions[at] : std::string();
  }
}

TrialsResult analyze(TrialsData data, const TrialsPlan& plan, const ProcedureOf& procedure_of,
                     int threads) {
  TrialsResult result;
  result.plan = plan;
  result.data = std::move(data);
  name_sessions(plan, result.data);
  if (std::none_of(result.data.trials.begin(), result.data.trials.end(),
                   [](const StudyTrial& trial) { return trial.counts(); })) {
    throw InputError("no session holds a completed trial of the study, so nothing can be analysed");
  }
  result.participants = participants_of(result.data, plan);
  result.unused = unused_trials(result.data, plan);
  result.tracks = track_estimates(result.data, procedure_of);
  if (plan.track_intervals) {
    add_track_intervals(result.tracks, plan, procedure_of, threads);
  }
  if (plan.kind == AnalysisKind::kDetection) {
    add_detection(result);
  }
  if (plan.kind == AnalysisKind::kIdentification) {
    add_identification(result);
  }
  if (plan.level.empty() && (plan.functions || plan.kind == AnalysisKind::kDetection)) {
    result.surfaces = surface_conditions(result.data, plan.by, plan.threshold_at, procedure_of);
    add_surface_quantities(result);
  }
  if (plan.functions) {
    add_functions(result, procedure_of, threads);
  }
  if (plan.kind == AnalysisKind::kMagnitude) {
    add_magnitudes(result);
  }
  if (plan.kind == AnalysisKind::kAdjustment) {
    add_settings(result);
  }
  if (plan.kind == AnalysisKind::kTimes) {
    add_times(result);
  }
  return result;
}

std::vector<NamedTest> tests_of(const TrialsResult& result) {
  std::vector<NamedTest> tests;
  for (const Quantity& q : result.quantities) {
    if (q.compared) {
      add_tests(q, tests);
    }
  }
  if (result.cues) {
    add_tests(*result.cues, tests);
  }
  if (result.reaching) {
    for (const ReachContrast& each : result.reaching->contrasts) {
      if (each.contrast) {
        tests.push_back({each.name, each.contrast->test.p});
      }
    }
  }
  if (result.drift) {
    tests.push_back({"drift over the trials", result.drift->p});
  }
  if (result.repetition) {
    tests.push_back({"repetition of the answer before", result.repetition->p});
  }
  if (result.population && result.population->condition_p) {
    tests.push_back({"probit mixed model: conditions", *result.population->condition_p});
  }
  return tests;
}

}  // namespace haptrial::analysis::trials
