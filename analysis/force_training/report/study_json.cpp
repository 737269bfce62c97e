#include "analysis/force_training/report/study_json.h"

#include <nlohmann/json.hpp>

#include <cmath>

#include "analysis/document/finding_json_internal.h"
#include "analysis/force_training/report/recall_frequency_findings.h"
#include "analysis/force_training/study/identity_json_internal.h"
#include "analysis/force_training/study/quality_summary.h"
#include "analysis/learning/learning_json_internal.h"
#include "analysis/statistics/design/result_json_internal.h"

namespace haptrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(double value) { return value; }

Json to_json(const Anova& a) {
  return {{"f", a.f},
          {"df_between", a.df_between},
          {"df_within", a.df_within},
          {"squares_between", a.squares_between},
          {"squares_within", a.squares_within},
          {"p", a.p},
          {"eta_squared", a.eta_squared}};
}

Json to_json(const RepeatedAnova& a) {
  return {{"participants", a.participants},
          {"conditions", a.conditions},
          {"f", a.f},
          {"df_condition", a.df_condition},
          {"df_error", a.df_error},
          {"squares_condition", a.squares_condition},
          {"squares_participants", a.squares_participants},
          {"squares_error", a.squares_error},
          {"p", a.p},
          {"greenhouse_geisser_epsilon", a.epsilon},
          {"p_corrected", a.p_corrected},
          {"partial_eta_squared", a.partial_eta_squared}};
}

Json to_json(const RankAnova& r) {
  return {{"chi_squared", r.chi_squared}, {"df", r.df}, {"p", r.p}, {"exact", r.exact}};
}

Json to_json(const ShapiroWilk& s) { return {{"w", s.w}, {"p", s.p}}; }

Json to_json(const Mauchly& m) { return {{"w", m.w}, {"p", m.p}}; }

Json to_json(const Coefficient& c) {
  return {{"estimate", c.estimate},
          {"standard_error", c.error},
          {"df_satterthwaite", c.df},
          {"t", c.t},
          {"p", c.p},
          {"low_95", c.low},
          {"high_95", c.high}};
}

Json to_json(const JointTest& t) {
  return {{"f", t.f},
          {"df_numerator", t.df_numerator},
          {"df_denominator_satterthwaite", t.df_denominator},
          {"p", t.p}};
}

Json to_json(const TimingPercentiles& p) {
  return {{"median_ns", p.median_ns},
          {"p99_ns", p.p99_ns},
          {"p99_9_ns", p.p999_ns},
          {"highest_ns", p.highest_ns}};
}

template <class T>
Json to_json(const Defined<T>& value) {
  return value ? to_json(*value) : Json{{"not_defined", value.because()}};
}

Json conditions(const StudyStatistics& s) {
  Json rows = Json::array();
  for (const auto& c : s.summaries) {
    rows.push_back({{"condition", c.condition},
                    {"trials", c.count},
                    {"participants", c.people},
                    {"mean", to_json(c.mean)},
                    {"pooled_trials", to_json(c.trials)},
                    {"participant_means", to_json(c.participants)}});
  }
  return rows;
}

Json comparisons(const StudyStatistics& s) {
  Json rows = Json::array();
  for (const auto& c : s.comparisons) {
    rows.push_back({{"test", text_of(c.sides)},
                    {"student", to_json(c.student)},
                    {"welch", to_json(c.welch)},
                    {"cohens_d", to_json(c.d)}});
  }
  return rows;
}

Json random_terms(const StudyMixed& mixed) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < mixed.terms.size(); ++k) {
    const StudyTerm& term = mixed.terms[k];
    rows.push_back({{"term", term.words},
                    {"lme4", term.notation},
                    {"groups", term.groups},
                    {"variance", mixed.model->variances[k]},
                    {"standard_deviation", std::sqrt(mixed.model->variances[k])}});
  }
  return rows;
}

Json mixed_pairs(const StudyMixed& mixed) {
  Json rows = Json::array();
  for (const MixedPair& pair : mixed.pairs) {
    rows.push_back({{"conditions", {pair.a, pair.b}},
                    {"difference", to_json(pair.difference)},
                    {"p_holm", to_json(pair.holm)}});
  }
  return rows;
}

Json mixed_model(const StudyMixed& mixed) {
  if (!mixed.model) {
    return {{"not_defined", mixed.model.because()}};
  }
  Json coefficients = Json::array();
  for (std::size_t i = 0; i < mixed.conditions.size(); ++i) {
    Json row = to_json(mixed.model->coefficients[i]);
    row["effect"] =
        i == 0 ? mixed.conditions[0] : mixed.conditions[i] + " - " + mixed.conditions[0];
    coefficients.push_back(std::move(row));
  }
  return {{"formula", mixed.formula},
          {"random_terms", random_terms(mixed)},
          {"terms_left_out", mixed.left_out},
          {"variance_residual", mixed.model->variance_within},
          {"standard_deviation_residual", std::sqrt(mixed.model->variance_within)},
          {"at_boundary", mixed.model->at_boundary},
          {"log_likelihood_reml", mixed.model->log_likelihood},
          {"conditions_differ", to_json(mixed.omnibus)},
          {"coefficients", coefficients},
          {"pairs", mixed_pairs(mixed)}};
}

Json blocks(const StudyStatistics& s) {
  Json rows = Json::array();
  for (const auto& point : s.blocks) {
    rows.push_back({{"block", point.block},
                    {"participants", point.participants},
                    {"mean", to_json(point.mean)},
                    {"interval", to_json(point.interval)}});
  }
  return rows;
}

Json published(const StudyStatistics& s) {
  return {{"one_way_anova", to_json(s.anova)},
          {"eta_squared", to_json(s.eta)},
          {"kruskal_wallis", to_json(s.ranks)},
          {"levene_about_medians", to_json(s.levene)},
          {"shapiro_wilk_of_residuals", to_json(s.normality)},
          {"comparisons", comparisons(s)}};
}

Json repeated(const StudyStatistics& s) {
  Json all{{"anova", to_json(s.repeated)},
           {"partial_eta_squared", to_json(s.partial_eta)},
           {"generalized_eta_squared", to_json(s.generalized_eta)},
           {"friedman", to_json(s.friedman)}};
  if (s.repeated) {
    all["mauchly"] = to_json(s.repeated->sphericity.mauchly);
    all["huynh_feldt_epsilon"] = to_json(s.repeated->sphericity.huynh_feldt);
    all["p_huynh_feldt"] = to_json(s.repeated->p_huynh_feldt);
  }
  return all;
}

Json table_1(const StudyStatistics& s) {
  Json rows = Json::array();
  for (const auto& row : s.table_1) {
    Json means;
    for (std::size_t c = 0; c < row.means.size(); ++c) {
      means[s.conditions[c]] = row.means[c];
    }
    rows.push_back(
        {{"subject", row.subject}, {"best", row.best}, {"worst", row.worst}, {"means", means}});
  }
  return rows;
}

Json repetitions(const StudyStatistics& s) {
  Json rows = Json::array();
  for (const auto& point : s.learning) {
    rows.push_back({{"condition", point.condition},
                    {"repetition", point.repetition},
                    {"participants", point.participants},
                    {"mean", to_json(point.mean)},
                    {"interval", to_json(point.interval)}});
  }
  return rows;
}

/// Pace in place of the lag, which is not defined at the participants' own pace.
Json pace(const TrackingSummary& t) {
  return {{"subject", t.subject},
          {"passes", t.passes},
          {"run_s", to_json(t.run)},
          {"run_standard_deviation_s", to_json(t.run_deviation)},
          {"rms_distance_m", to_json(t.rms_error)},
          {"rms_distance_in_plane_m", to_json(t.rms_error_in_plane)}};
}

Json tracking(const TrackingSummary& t, bool own_pace) {
  if (own_pace) {
    return pace(t);
  }
  return {{"subject", t.subject},
          {"passes", t.passes},
          {"passes_without_lag", t.passes_without_lag},
          {"lag_s", to_json(t.lag)},
          {"lag_standard_deviation_s", to_json(t.lag_deviation)},
          {"rms_error_m", to_json(t.rms_error)},
          {"rms_error_in_plane_m", to_json(t.rms_error_in_plane)}};
}

Json timing(const SessionSummary& session) {
  const auto& t = session.timing;
  Json row{{"subject", session.info.subject}, {"applies", t.applies}, {"complete", t.complete}};
  if (t.complete) {
    row.update(Json{{"ticks", t.ticks},
                    {"overruns", t.overruns},
                    {"dropped", t.dropped},
                    {"missing", t.missing}});
  }
  if (t.applies) {
    row["period"] = to_json(t.period);
    row["lateness"] = to_json(t.lateness);
    row["compute"] = to_json(t.compute);
  }
  return row;
}

Json session(const SessionSummary& s) {
  return {{"subject", s.info.subject},
          {"file", s.file},
          {"simulated", s.info.simulated},
          {"device", s.info.device},
          {"clock", s.info.clock},
          {"rate_hz", s.info.rate},
          {"seed", s.info.seed},
          {"start_utc", s.info.start_utc},
          {"definition", s.info.definition_name},
          {"program_version", s.info.program_version},
          {"program_commit", s.info.program_commit},
          {"test_passes", s.test_passes},
          {"scored", s.scored}};
}

Json to_json(const std::optional<Spread>& s) {
  return s ? Json{{"median", s->median}, {"lowest", s->low}, {"highest", s->high}}
           : Json{{"not_defined", "it is not known"}};
}

Json quality(const StudyResult& study) {
  Json all{{"participants", Json::array()}, {"flagged", Json::array()}};
  const std::vector<TrialScore> trials = judged_trials(study.scores, study.tests);
  for (const ParticipantQuality& p : participant_quality(trials)) {
    all["participants"].push_back({{"subject", p.subject},
                                   {"trials", p.trials},
                                   {"flagged", p.flagged},
                                   {"saturation", to_json(p.saturation)},
                                   {"training_saturation", to_json(p.training_saturation)},
                                   {"duration_s", to_json(p.duration)},
                                   {"lag_s", to_json(p.lag)}});
  }
  for (const TrialScore& score : trials) {
    for (const TrialFlag& flag : flags_of(score.quality)) {
      all["flagged"].push_back({{"subject", score.subject},
                                {"session", score.session},
                                {"trial", score.trial},
                                {"flag", flag.name},
                                {"reason", flag.reason}});
    }
  }
  return all;
}

void add_session_json(Json& root, const StudyResult& study) {
  root["quality"] = quality(study);
  root["tracking"] = {{"overall", tracking(study.tracking, study.over_path)},
                      {"participants", Json::array()}};
  root["timing"] = Json::array();
  root["sessions"] = Json::array();
  for (const auto& one : study.sessions) {
    root["tracking"]["participants"].push_back(tracking(one.tracking, study.over_path));
    root["timing"].push_back(timing(one));
    root["sessions"].push_back(session(one));
  }
}

}  // namespace

std::string statistics_json(const StudyResult& study, const std::vector<FindingList>& own) {
  const auto& s = study.statistics;
  Json root;
  root["simulated"] = study.simulated();
  root["participants"] = s.subjects.size();
  root["trials"] = study.scores.size();
  root["conditions"] = conditions(s);
  root["participants_as_unit"] = to_json(s.tests);
  root["repeated_measures"] = repeated(s);
  root["mixed_model"] = mixed_model(s.mixed);
  root["published"] = published(s);
  root["table_1"] = table_1(s);
  if (study.path) {  // [mm]
    root["path"] = {{"conditions", conditions(*study.path)},
                    {"participants_as_unit", to_json(study.path->tests)},
                    {"repeated_measures", repeated(*study.path)}};
  }
  root["learning"] = repetitions(s);
  if (!study.learned.outcomes.empty()) {
    root["learning_from_session_to_session"] = learning_json(study.learned);
  }
  root["blocks"] = blocks(s);
  root["change_per_block"] = to_json(s.slope);
  if (study.curves_from.empty()) {
    add_session_json(root, study);
  } else {
    root["curves_from"] = study.curves_from;
  }
  root["identities"] = to_json(identities(study));
  root["exclusions"] = Json::array();
  for (const auto& e : study.exclusions) {
    root["exclusions"].push_back(
        {{"subject", e.subject}, {"trial", e.trial}, {"reason", e.reason}});
  }
  for (const auto& [name, value] : study.parameters) {
    root["parameters"][name] = value;
  }
  const FindingList recalled = recall_frequency_findings(study.frequencies, study.simulated());
  if (const Json values = json_of({recalled}); !values.empty()) {
    root[recalled.name] = values.at(recalled.name);
  }
  if (Json values = json_of(own); !values.empty()) {
    root["own_findings"] = std::move(values);
  }
  // Bytes that are not UTF-8 came from a file: shown as the replacement character.
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace haptrial::analysis
