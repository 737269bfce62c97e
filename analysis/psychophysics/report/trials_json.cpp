#include "analysis/psychophysics/report/trials_json.h"
#include "analysis/psychophysics/report/report_apparatus.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/document/finding_json_internal.h"
#include "analysis/psychophysics/report/report_hierarchical.h"
#include "analysis/psychophysics/report/report_surfaces.h"
#include "analysis/psychophysics/report/report_times.h"
#include "analysis/psychophysics/report/trials_findings.h"
#include "analysis/statistics/design/result_json_internal.h"

namespace haptrial::analysis::trials {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json to_json(const Defined<T>& value);

Json to_json(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json to_json(const Estimated& e) {
  return {{"estimate", to_json(e.value)}, {"low_95", to_json(e.low)}, {"high_95", to_json(e.high)}};
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

template <class T>
Json to_json(const Defined<T>& value) {
  using analysis::to_json;
  using trials::to_json;
  return value ? to_json(*value) : Json{{"not_defined", value.because()}};
}

Json to_json(const Quantity& q) {
  Json cells = Json::array();
  for (std::size_t cell = 0; cell < q.table.cells.size(); ++cell) {
    Json mean = to_json(q.means[cell]);
    if (const auto value = mean_of(q, cell)) {
      mean["mean"] = *value;
    }
    cells.push_back({{"condition", q.table.names[cell]},
                     {"participants", q.table.participants(cell)},
                     {"mean", mean}});
  }
  Json made{{"name", q.name}, {"title", q.title}, {"unit", q.unit}, {"conditions", cells}};
  if (q.compared) {
    made["tests"] = analysis::to_json(q.tests);
  }
  return made;
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

Json to_json(const UnusedTrials& unused) {
  return {{"count", unused.count}, {"because", unused.because}};
}

Json to_json(const CueTest& test) {
  return {{"test", to_json(test.test)}, {"p_holm", to_json(test.holm)}};
}

Json to_json(const TrialsResult& result, const CueLevel& level) {
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
          {"participants", json_of(cue_findings(result, level).rows)},
          {"left_out", level.left_out}};
}

Json cues_json(const TrialsResult& result) {
  const CuePlan& plan = *result.plan.cues;
  Json levels = Json::array();
  for (const CueLevel& level : result.cues->levels) {
    levels.push_back(to_json(result, level));
  }
  return {{"first", plan.first}, {"second", plan.second},     {"both", plan.both},
          {"at", plan.at},       {"conflict", plan.conflict}, {"levels", levels}};
}

/// The report's results, member by member.
class ResultsJson {
 public:
  ResultsJson(const TrialsResult& result, const std::vector<FindingList>& own)
      : result_(result), own_(own) {}

  std::string made() {
    const TrialsPlan& plan = result_.plan;
    add("title", result_.title);
    add("simulated", result_.simulated());
    add("kind", name_of(plan.kind));
    add("factors", plan.by);
    add_table(participant_findings(result_));
    if (const FindingList apparatus = apparatus_findings(result_); !apparatus.tables.empty()) {
      Json made = json_of(apparatus.findings);
      for (const FindingTable& table : apparatus.tables) {
        made[table.name] = json_of(table.rows);
      }
      add("apparatus", made);
    }
    if (plan.functions) {
      add_functions();
    }
    if (result_.cues) {
      add("cue_combination", cues_json(result_));
    }
    add_list("quantities", result_.quantities);
    add_table(track_findings(result_));
    add_table(detection_findings(result_));
    if (plan.kind == AnalysisKind::kIdentification) {
      add("choices", plan.choices);
      add_table(identification_findings(result_));
    }
    add_table(law_findings(result_));
    if (plan.kind == AnalysisKind::kTimes) {
      add_table(time_findings(result_));
    }
    add_rest();
    return root_.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  }

 private:
  void add(const char* name, const Json& value) { root_[name] = value; }

  template <class T>
  void add_list(const char* name, const std::vector<T>& values) {
    Json& list = root_[name] = Json::array();
    for (const T& value : values) {
      list.push_back(to_json(value));
    }
  }

  void add_table(const FindingTable& table) { root_[table.name] = json_of(table.rows); }

  void add_functions() {
    const TrialsPlan& plan = result_.plan;
    add("function", {{"sigmoid", plan.function_name},
                     {"axis_unit", plan.function.axis.x_unit()},
                     {"axis_origin", plan.function.axis.origin},
                     {"guess", plan.guess_free ? Json("free") : Json(plan.function.guess)},
                     {"threshold_at", plan.threshold_at},
                     {"reference", plan.reference ? Json(*plan.reference) : Json()}});
    add_table(function_findings(result_));
    add("population", to_json(result_.population));
    if (result_.hierarchical) {
      add("hierarchical_sentence", hierarchical_sentence(result_));
      add_table(hierarchical_group_findings(result_));
      add_table(hierarchical_people_findings(result_));
    }
    add_table(serial_findings(result_));
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
    if (const Json own = json_of(own_); !own.empty()) {
      add("own_findings", own);
    }
    if (!result_.unused.empty()) {
      add_list("unused_trials", result_.unused);
    }
    add("remarks", result_.remarks);
  }

  const TrialsResult& result_;
  const std::vector<FindingList>& own_;
  Json root_;
};

}  // namespace

std::string results_json(const TrialsResult& result, const std::vector<FindingList>& own) {
  return ResultsJson(result, own).made();
}

}  // namespace haptrial::analysis::trials
