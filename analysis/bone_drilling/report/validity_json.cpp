#include "analysis/bone_drilling/report/validity_json.h"

#include <nlohmann/json.hpp>

#include "analysis/bone_drilling/report/checklist_section.h"
#include "analysis/bone_drilling/report/crossing_section.h"
#include "analysis/bone_drilling/report/field_section.h"
#include "analysis/bone_drilling/report/nerve_section.h"
#include "analysis/bone_drilling/report/phase_section.h"
#include "analysis/document/finding_json_internal.h"
#include "analysis/learning/learning_json_internal.h"
#include "analysis/statistics/design/result_json_internal.h"

namespace haptrial::analysis::drilling {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json to_json(const Defined<T>& value);

Json to_json(double value) { return value; }

Json to_json(const Coefficient& c) {
  return {
      {"estimate", c.estimate}, {"standard_error", c.error}, {"df", c.df}, {"t", c.t}, {"p", c.p},
      {"low_95", c.low},        {"high_95", c.high}};
}

Json coefficients(const std::vector<Coefficient>& all) {
  Json rows = Json::array();
  for (const Coefficient& c : all) {
    rows.push_back(to_json(c));
  }
  return rows;
}

Json to_json(const MixedModel& m) {
  return {{"coefficients", coefficients(m.coefficients)},
          {"variance_between", m.variances.front()},
          {"variance_within", m.variance_within},
          {"at_boundary", m.at_boundary},
          {"participants", m.groups.front()},
          {"procedures", m.observations}};
}

Json to_json(const Correlation::Interval& i) { return {{"low_95", i.low}, {"high_95", i.high}}; }

Json to_json(const Correlation& c) {
  return {{"r", c.r}, {"p", c.p}, {"count", c.count}, {"interval", to_json(c.interval)}};
}

Json to_json(const Regression& r) {
  return {{"coefficients", coefficients(r.coefficients)},
          {"r_squared", r.r_squared},
          {"residual_deviation", r.deviation},
          {"df_error", r.df_error}};
}

Json to_json(const RocInterval& i) {
  return {{"standard_error", i.error}, {"low_95", i.low}, {"high_95", i.high}, {"p", i.p}};
}

Json to_json(const Roc& r) {
  Json points = Json::array();
  for (const RocPoint& p : r.curve) {
    points.push_back({p.false_positives, p.true_positives});
  }
  return {{"area", r.area}, {"interval", to_json(r.interval)}, {"curve", points}};
}

Json to_json(const IntraclassForm& f) {
  return {{"value", f.value},           {"low_95", f.low},        {"high_95", f.high}, {"f", f.f},
          {"df_targets", f.df_targets}, {"df_error", f.df_error}, {"p", f.p}};
}

Json to_json(const Intraclass& c) {
  return {{"targets", c.targets},
          {"raters", c.raters},
          {"mean_squares",
           {{"targets", c.mean_square_targets},
            {"raters", c.mean_square_raters},
            {"error", c.mean_square_error},
            {"within", c.mean_square_within}}},
          {"icc_1_1", to_json(c.one_way)},
          {"icc_2_1", to_json(c.random_raters)},
          {"icc_3_1", to_json(c.fixed_raters)},
          {"icc_1_k", to_json(c.one_way_mean)},
          {"icc_2_k", to_json(c.random_raters_mean)},
          {"icc_3_k", to_json(c.fixed_raters_mean)}};
}

Json to_json(const Agreement& a) { return {{"r", to_json(a.r)}, {"rmse", a.rmse}}; }

template <class T>
Json to_json(const Defined<T>& value) {
  return value ? to_json(*value) : Json{{"not_defined", value.because()}};
}

Json to_json(const std::vector<GroupValues>& groups) {
  Json rows = Json::array();
  for (const GroupValues& g : groups) {
    rows.push_back({{"group", g.group},
                    {"participants", g.participants},
                    {"procedures", g.procedures},
                    {"over_procedures", to_json(g.pooled)},
                    {"over_participant_means", to_json(g.participant_means)}});
  }
  return rows;
}

Json to_json(const Contrast& c) {
  return {{"student_over_procedures", to_json(c.pooled)},
          {"welch_over_participant_means", to_json(c.means)},
          {"hedges_g_of_participant_means", to_json(c.g)},
          {"mixed_model", to_json(c.mixed)},
          {"mixed_model_p_for_the_tail", to_json(c.mixed_p)},
          {"roc", to_json(c.roc)}};
}

const char* name_of(Expected experts) {
  return experts == Expected::kHigher ? "higher" : experts == Expected::kLower ? "lower" : "either";
}

Json to_json(const MetricValidity& m) {
  return {{"name", m.kind.name},
          {"unit", m.kind.unit},
          {"title", m.kind.title},
          {"experts_expected", name_of(m.kind.experts)},
          {"procedures", m.defined},
          {"groups", to_json(m.groups)},
          {"contrast", to_json(m.contrast)},
          {"contrast_p", to_json(m.contrast_p)},
          {"contrast_p_holm", to_json(m.contrast_holm)},
          {"rating_over_procedures", to_json(m.relation.pooled)},
          {"line_on_rating", to_json(m.relation.line)},
          {"rating_over_participant_means", to_json(m.relation.means)},
          {"rating_spearman_of_participant_means", to_json(m.relation.ranks)},
          {"rating_p_holm", to_json(m.relation_holm)},
          {"rating_spearman_p_holm", to_json(m.ranks_holm)}};
}

Json to_json(const CrossValidated& c, const std::vector<std::string>& metrics) {
  Json slopes = Json::object();
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    slopes[metrics[i]] = c.fit.slopes[static_cast<Eigen::Index>(i)];
  }
  return {{"cross_validated", to_json(c.validated)},
          {"resubstitution", to_json(c.resubstitution)},
          {"gain_over_mean", c.gain},
          {"lambda", c.lambda},
          {"lambdas", c.lambdas},
          {"standardised_slopes", slopes},
          {"predicted", std::vector<double>(c.predicted.begin(), c.predicted.end())}};
}

Json to_json(const Combined& c) {
  return {{"metrics", c.metrics},
          {"left_out", c.left_out},
          {"fit", c.fit ? to_json(*c.fit, c.metrics) : Json{{"not_defined", c.fit.because()}}},
          {"roc", to_json(c.roc)},
          {"roc_resubstitution", to_json(c.resubstitution_roc)}};
}

Json procedures_of(const Validity& v, std::span<const ProcedureSummary> procedures) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < procedures.size(); ++i) {
    const ProcedureSummary& p = procedures[i];
    Json row{{"session", p.session},  {"participant", p.participant}, {"group", p.group},
             {"procedure", p.number}, {"simulated", p.simulated},     {"completed", p.completed}};
    row["rating"] = v.rating[i] ? Json(*v.rating[i]) : Json{{"not_defined", "it was not rated"}};
    rows.push_back(std::move(row));
  }
  return rows;
}

/// The bins of Figure 20 for experts, or for novices, the nearest first.
Json profile_of(const ValidityResult& result, bool expert, NearQuantity quantity) {
  std::vector<NearCase> side;
  for (std::size_t i = 0; i < result.procedures.size(); ++i) {
    for (const NearRemovals& near : result.procedures[i].near) {
      if (near.structure == result.structure && result.validity.expert[i] == expert) {
        side.push_back({result.procedures[i].participant, &near});
      }
    }
  }
  Json bins = Json::array();
  for (const ProfileBin& bin : near_profile(side, quantity, result.bins)) {
    bins.push_back({{"from", bin.low},
                    {"to", bin.high},
                    {"removals", bin.removals},
                    {"participants", bin.participants},
                    {"over_removals", to_json(bin.pooled)},
                    {"over_participant_means", to_json(bin.by_participant)}});
  }
  return bins;
}

Json near_of(const ValidityResult& result) {
  Json near{{"structure", result.structure}, {"distance_unit", "m"}};
  for (const bool expert : {true, false}) {
    near[expert ? "experts" : "novices"] = {
        {"force", profile_of(result, expert, NearQuantity::kForce)},
        {"speed", profile_of(result, expert, NearQuantity::kSpeed)}};
  }
  return near;
}

Json hints_of(const ValidityResult& result) {
  Json procedures = Json::array();
  for (const HintProcedure& p : result.hints) {
    Json row{{"session", p.session},  {"participant", p.participant},
             {"procedure", p.number}, {"condition", p.condition},
             {"shown", p.given},      {"drilling_s", p.drilling}};
    for (const auto kind : hint::kAllHintKinds) {
      const HintCounts& counts = p.of(kind);
      row[std::string(hint::name_of(kind))] = {
          {"hints", counts.hints}, {"removals", counts.removals}, {"time_s", counts.time}};
    }
    procedures.push_back(std::move(row));
  }
  Json effects = Json::array();
  for (const HintEffect& each : result.hint_effects) {
    effects.push_back({{"name", each.name},
                       {"unit", each.unit},
                       {"participants", each.effect.participants},
                       {"paired_t_of_participant_means", to_json(each.effect.test)},
                       {"p_holm", to_json(each.holm)}});
  }
  return {{"procedures", procedures}, {"with_less_without", effects}};
}

Json findings_of(const Validity& v, std::span<const ProcedureSummary> procedures) {
  Json root;
  root["simulated"] = v.simulated;
  root["simulated_raters"] = v.simulated_raters;
  root["groups"] = v.plan.groups;
  root["expert_groups"] = v.plan.expert_groups;
  root["raters"] = v.raters;
  root["rated_procedures"] = v.rated;
  root["agreement_between_raters"] = to_json(v.agreement);
  root["ratings"] = {{"groups", to_json(v.rating_groups)},
                     {"contrast", to_json(v.rating_contrast)}};
  root["metrics"] = Json::array();
  for (const MetricValidity& m : v.metrics) {
    root["metrics"].push_back(to_json(m));
  }
  root["combined"] = to_json(v.combined);
  root["region_score_by_training"] = Json::array();
  for (const RegionWay& way : v.regions) {
    root["region_score_by_training"].push_back(
        {{"way", way.name},
         {"rating_over_procedures", to_json(way.pooled)},
         {"rating_over_participant_means", to_json(way.means)},
         {"roc", to_json(way.roc)}});
  }
  root["procedures"] = procedures_of(v, procedures);
  return root;
}

std::string text_of(const Json& root) {
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string validity_json(const Validity& v, std::span<const ProcedureSummary> procedures) {
  return text_of(findings_of(v, procedures));
}

std::string validity_json(const ValidityResult& result, const std::vector<FindingList>& own) {
  Json root = findings_of(result.validity, result.procedures);
  if (!result.structure.empty()) {
    root["near_structure"] = near_of(result);
  }
  if (!result.learned.outcomes.empty()) {
    root["learning"] = learning_json(result.learned);
  }
  if (!result.hints.empty()) {
    root["hints"] = hints_of(result);
  }
  const Json sections = json_of(std::vector<FindingList>{
      nerve_findings(result.nerves), crossing_findings(result.crossings), phase_findings(result),
      checklist_findings(result.checked, result.procedures, result.validity.plan.groups),
      field_findings(result.procedures)});
  root.update(sections);
  if (Json values = json_of(own); !values.empty()) {
    root["own_findings"] = std::move(values);
  }
  return text_of(root);
}

}  // namespace haptrial::analysis::drilling
