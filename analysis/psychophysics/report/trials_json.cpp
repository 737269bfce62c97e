#include "analysis/psychophysics/report/trials_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/psychophysics/report/report_surfaces.h"
#include "analysis/statistics/design/result_json_internal.h"

namespace haptrial::analysis::trials {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const PowerLaw& law);

template <class T>
Json to_json(const Defined<T>& value);
Json to_json(const PowerLaw& law);

Json to_json(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json to_json(const Estimated& e) {
  return {{"estimate", to_json(e.value)}, {"low_95", to_json(e.low)}, {"high_95", to_json(e.high)}};
}

Json to_json(const FunctionReadings& r) {
  return {{"threshold", to_json(r.threshold)},  {"threshold_on_axis", to_json(r.x)},
          {"width", to_json(r.width)},          {"slope", to_json(r.slope)},
          {"weber_fraction", to_json(r.weber)}, {"lapse_rate", to_json(r.lapse)},
          {"guess_rate", to_json(r.guess)}};
}

Json to_json(const BinomialCoefficient& c) {
  return {{"estimate", c.estimate}, {"standard_error", c.error}, {"z", c.z}, {"p", c.p},
          {"low_95", c.low},        {"high_95", c.high}};
}

Json to_json(const EqualityPoint& e) {
  return {{"point_on_axis", e.point},      {"point_low_95", e.point_low},
          {"point_high_95", e.point_high}, {"jnd_on_axis", e.jnd},
          {"jnd_low_95", e.jnd_low},       {"jnd_high_95", e.jnd_high}};
}

Json to_json(const PopulationModel& m) {
  Json coefficients = Json::object(), points = Json::array();
  for (std::size_t i = 0; i < m.names.size(); ++i) {
    coefficients[m.names[i]] = to_json(m.model.fixed.coefficients[i]);
  }
  for (const PopulationPoint& p : m.points) {
    points.push_back({{"condition", p.condition}, {"crossing", to_json(p.point)}});
  }
  return {{"centre_on_axis", m.centre},
          {"scale_on_axis", m.scale},
          {"coefficients", coefficients},
          {"log_likelihood", m.model.fixed.log_likelihood},
          {"at_boundary", m.model.at_boundary},
          {"points", points},
          {"condition_p", to_json(m.condition_p)},
          {"condition_df", m.condition_df}};
}

Json to_json(const Detection& d) {
  return {{"hit_rate", d.hit_rate},    {"false_alarm_rate", d.false_alarm_rate},
          {"d_prime", d.d_prime},      {"d_prime_low_95", d.low},
          {"d_prime_high_95", d.high}, {"criterion", d.criterion},
          {"log_beta", d.log_beta}};
}

Json to_json(const RocInterval& i) { return {{"low_95", i.low}, {"high_95", i.high}}; }
Json to_json(const Roc& r) { return {{"area", r.area}, {"interval", to_json(r.interval)}}; }
Json to_json(const BinormalRoc& r) {
  return {{"a", r.a},
          {"b", r.b},
          {"d_a", r.d_a},
          {"area", r.area},
          {"low_95", r.area_low},
          {"high_95", r.area_high}};
}

template <class T>
Json to_json(const Defined<T>& value) {
  using analysis::to_json;
  using trials::to_json;
  return value ? to_json(*value) : Json{{"not_defined", value.because()}};
}

Json to_json(const FunctionFit& fit) {
  Json blocks = Json::array();
  for (const TrialBlock& b : fit.blocks) {
    blocks.push_back({{"level", to_json(b.level)}, {"ones", b.correct}, {"trials", b.total}});
  }
  return {{"participant", fit.participant},
          {"condition", fit.condition},
          {"trials", fit.trials},
          {"estimates_from", fit.adaptive ? "posterior" : "profile likelihood and bootstrap"},
          {method_of(fit), to_json(fit.stated)},
          {"no_interval_because", fit.no_interval},
          {"bayesian", to_json(fit.bayesian)},
          {"deviance", to_json(fit.deviance)},
          {"deviance_p", to_json(fit.deviance_p)},
          {"overdispersion_eta", to_json(fit.overdispersion)},
          {"warnings", fit.warnings},
          {"answers", blocks}};
}

Json to_json(const TrackEstimate& track) {
  Json estimates = Json::array();
  for (const auto& e : track.estimates) {
    estimates.push_back({{"name", e.name},
                         {"value", to_json(e.value)},
                         {"deviation", e.deviation ? to_json(*e.deviation) : Json()},
                         {"low_95", e.interval ? to_json(e.interval->low) : Json()},
                         {"high_95", e.interval ? to_json(e.interval->high) : Json()},
                         {"remark", e.remark}});
  }
  return {{"participant", track.participant},
          {"track", track.track},
          {"variable", track.variable},
          {"trials", track.steps.size()},
          {"trials_at_an_end_of_the_range", track.at_end},
          {"estimates", estimates},
          {"none_because", track.because},
          {"no_interval_because", track.no_interval}};
}

Json to_json(const Quantity& q) {
  Json cells = Json::array();
  for (std::size_t cell = 0; cell < q.table.cells.size(); ++cell) {
    cells.push_back({{"condition", q.table.names[cell]},
                     {"participants", q.table.participants(cell)},
                     {"mean", to_json(q.means[cell])}});
  }
  Json made{{"name", q.name}, {"title", q.title}, {"unit", q.unit}, {"conditions", cells}};
  if (q.compared) {
    made["tests"] = analysis::to_json(q.tests);
  }
  return made;
}

Json to_json(const SerialEffects& s) {
  return {{"participant", s.participant},
          {"trials", s.trials},
          {"drift_log_odds", to_json(s.effects.drift)},
          {"drift_standard_error", s.effects.drift ? to_json(s.effects.drift_error) : Json()},
          {"drift_log_odds_by_chance", to_json(s.by_chance.drift)},
          {"repetition_log_odds", to_json(s.effects.repetition)},
          {"repetition_standard_error",
           s.effects.repetition ? to_json(s.effects.repetition_error) : Json()},
          {"repetition_log_odds_by_chance", to_json(s.by_chance.repetition)},
          {"easy_trials", s.easy},
          {"easy_trials_with_answer_0", s.easy_wrong},
          {"trials_with_another_level_than_asked", s.limited}};
}

Json to_json(const DetectedCondition& one) {
  return {{"participant", one.participant},
          {"condition", one.condition},
          {"hits", one.counts.hits},
          {"misses", one.counts.misses},
          {"false_alarms", one.counts.false_alarms},
          {"correct_rejections", one.counts.correct_rejections},
          {"detection", to_json(one.detection)},
          {"ratings_of_noise", one.ratings.noise},
          {"ratings_of_signal", one.ratings.signal},
          {"roc", to_json(one.roc)},
          {"binormal_roc", to_json(one.binormal)}};
}

Json to_json(const IdentifiedCondition& one) {
  return {{"participant", one.participant},
          {"condition", one.condition},
          {"stimuli", one.confusions.stimuli},
          {"answers", one.confusions.answers},
          {"trials", one.trials},
          {"right", one.right},
          {"share", one.share},
          {"share_low_95", one.low},
          {"share_high_95", one.high},
          {"d_prime", to_json(one.d_prime)},
          {"d_prime_low_95", to_json(one.d_low)},
          {"d_prime_high_95", to_json(one.d_high)},
          {"mean_rating_right", to_json(one.sure_right)},
          {"mean_rating_wrong", to_json(one.sure_wrong)},
          {"roc_of_ratings", to_json(one.sureness)}};
}

Json to_json(const PowerLaw& law) {
  Json levels = Json::array();
  for (const MagnitudeLevel& l : law.levels) {
    levels.push_back({{"level", l.level},
                      {"geometric_mean", l.mean},
                      {"low_95", l.low},
                      {"high_95", l.high},
                      {"participants", l.participants}});
  }
  return {
      {"exponent", law.exponent},     {"standard_error", law.error}, {"low_95", to_json(law.low)},
      {"high_95", to_json(law.high)}, {"constant", law.constant},    {"r_squared", law.r_squared},
      {"exponents", law.exponents},   {"moduli", law.moduli},        {"levels", levels}};
}

Json to_json(const MagnitudeCondition& one) {
  return {{"condition", one.condition},
          {"participants", one.participants},
          {"answers_not_above_0", one.not_positive},
          {"law", to_json(one.law)}};
}

Json to_json(const ParticipantTrials& p) {
  return {{"participant", p.participant},
          {"group", p.group},
          {"sessions", p.sessions},
          {"trials", p.counted},
          {"planned_trials_at_most", p.planned},
          {"practice", p.practice},
          {"aborted", p.aborted},
          {"median_reaction_time_s", to_json(p.reaction_time)},
          {"share_of_trials_at_force_limit_by_stage", p.at_limit}};
}

Json to_json(const markers::MarkerTimes& times) {
  return {{"way", record::name_of(times.way)},
          {"markers", times.sent},
          {"lost", times.lost},
          {"median_latency_s", to_json(times.median)},
          {"p99_latency_s", to_json(times.p99)},
          {"largest_latency_s", to_json(times.largest)}};
}

Json scores_json(const std::vector<PageScore>& scores) {
  Json all = Json::array();
  for (const PageScore& s : scores) {
    all.push_back({{"participant", s.participant},
                   {"group", s.group},
                   {"page", s.page},
                   {"when", s.when},
                   {"score", s.score},
                   {"value", s.value}});
  }
  return all;
}

Json to_json(const CuePerson& p) {
  return {{"participant", p.participant},
          {"first_weight", to_json(p.weight)},
          {"first_weight_predicted", to_json(p.predicted_weight)},
          {"first_sd", to_json(p.first_sd)},
          {"second_sd", to_json(p.second_sd)},
          {"both_sd", to_json(p.both_sd)},
          {"both_sd_predicted", to_json(p.predicted_sd)},
          {"bias", to_json(p.bias)},
          {"conflicts", p.conflicts}};
}

Json to_json(const CueTest& test) {
  return {{"test", to_json(test.test)}, {"p_holm", to_json(test.holm)}};
}

Json to_json(const CueLevel& level);

template <class T>
Json list_of(const std::vector<T>& values) {
  Json list = Json::array();
  for (const T& value : values) {
    list.push_back(to_json(value));
  }
  return list;
}

Json to_json(const CueLevel& level) {
  const auto mean = [&](Estimated CuePerson::*number, bool geometric) {
    return trials::to_json(mean_of(level, number, geometric));
  };
  return {{"level", level.level},
          {"means",
           {{"first_weight", mean(&CuePerson::weight, false)},
            {"first_weight_predicted", mean(&CuePerson::predicted_weight, false)},
            {"first_sd", mean(&CuePerson::first_sd, true)},
            {"second_sd", mean(&CuePerson::second_sd, true)},
            {"both_sd", mean(&CuePerson::both_sd, true)},
            {"both_sd_predicted", mean(&CuePerson::predicted_sd, true)}}},
          {"weight_observed_less_predicted", to_json(level.weight)},
          {"log_sd_observed_less_predicted", to_json(level.log_sd)},
          {"log_sd_observed_less_better_cue", to_json(level.beats_best)},
          {"participants", list_of(level.people)},
          {"left_out", level.left_out}};
}

Json cues_json(const CuePlan& plan, const CueStudy& cues) {
  return {{"first", plan.first}, {"second", plan.second},     {"both", plan.both},
          {"at", plan.at},       {"conflict", plan.conflict}, {"levels", list_of(cues.levels)}};
}

std::string laid_out(const Json& value) {
  return value.dump(2, ' ', false, Json::error_handler_t::replace);
}

/// The report's results, member by member.
class ResultsJson {
 public:
  ResultsJson(const TrialsResult& result, const JsonPieces::Take& take)
      : result_(result), pieces_(take) {}

  void write() {
    const TrialsPlan& plan = result_.plan;
    add("title", result_.title);
    add("simulated", result_.simulated());
    add("kind", name_of(plan.kind));
    add("factors", plan.by);
    add_list("participants", result_.participants);
    if (plan.functions) {
      add_functions();
    }
    if (result_.cues) {
      add("cue_combination", cues_json(*plan.cues, *result_.cues));
    }
    add_list("quantities", result_.quantities);
    add_list("tracks", result_.tracks);
    add_list("detection", result_.detected);
    if (plan.kind == AnalysisKind::kIdentification) {
      add("choices", plan.choices);
      add_list("identification", result_.identified);
    }
    add_list("magnitudes", result_.magnitudes);
    add_rest();
    pieces_.end();
  }

 private:
  void add(const char* name, const Json& value) { pieces_.member(name, laid_out(value)); }

  template <class T>
  void add_list(const char* name, const std::vector<T>& values) {
    pieces_.list(name, values.size(), [&](std::size_t i) { return laid_out(to_json(values[i])); });
  }

  void add_functions() {
    const TrialsPlan& plan = result_.plan;
    add("function", {{"sigmoid", plan.function_name},
                     {"axis_unit", plan.function.axis.x_unit()},
                     {"axis_origin", plan.function.axis.origin},
                     {"guess", plan.guess_free ? Json("free") : Json(plan.function.guess)},
                     {"threshold_at", plan.threshold_at},
                     {"reference", plan.reference ? Json(*plan.reference) : Json()}});
    add_list("functions", result_.fits);
    add("population", to_json(result_.population));
    add_list("serial_effects", result_.serial);
    add("drift_over_participants", to_json(result_.drift));
    add("repetition_over_participants", to_json(result_.repetition));
  }

  void add_rest() {
    if (!result_.surfaces.empty()) {
      add("surfaces", Json::parse(surfaces_json(result_)));
    }
    if (result_.reaching) {
      add("reaching", Json::parse(reaching_json(*result_.reaching)));
    }
    if (const auto times = result_.data.markers.times(); !times.empty()) {
      add_list("markers", times);  // of sessions that recorded any
    }
    if (!result_.page_scores.empty()) {
      add("page_scores", scores_json(result_.page_scores));
    }
    add("remarks", result_.remarks);
  }

  const TrialsResult& result_;
  JsonPieces pieces_;
};

}  // namespace

void results_json(const TrialsResult& result, const JsonPieces::Take& take) {
  ResultsJson(result, take).write();
}

}  // namespace haptrial::analysis::trials
