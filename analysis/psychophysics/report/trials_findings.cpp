#include "analysis/psychophysics/report/trials_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/psychophysics/report/report_hierarchical.h"
#include "analysis/psychophysics/report/report_times.h"
#include "analysis/psychophysics/report/trials_words.h"
#include "analysis/statistics/design/result_json_internal.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::trials {
namespace {

using Json = nlohmann::ordered_json;

/// A number, word or list; its own key in JSON. @returns it, for what else there is to say
Finding& add(FindingRow& row, const std::string& name, const std::string& title,
             FindingValue value) {
  return row.emplace_back(
      Finding{.name = name, .title = title, .value = std::move(value), .form = JsonForm::kPlain});
}

Finding& add(FindingRow& row, const std::string& name, const std::string& title, const Estimated& e,
             JsonForm form, const std::string& csv = "", const std::string& unit = "") {
  Finding& f = add(row, name, title, e.value);
  f.low = e.low;
  f.high = e.high;
  f.unit = unit;
  f.csv = csv;
  f.form = form;
  return f;
}

/// A list or an object of JSON alone.
void add_json(FindingRow& row, const std::string& name, const Json& value) {
  add(row, name, "", FindingValue()).json =
      value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Finding& add_missing(FindingRow& row, const std::string& name, const std::string& title,
                     const std::string& because) {
  Finding& f = add(row, name, title, FindingValue());
  f.why_not = because;
  return f;
}

Finding& add_defined(FindingRow& row, const std::string& name, const std::string& title,
                     const Defined<double>& value) {
  return value ? add(row, name, title, *value) : add_missing(row, name, title, value.because());
}

/// A word of the report or of estimates.csv alone.
void add_word(FindingRow& row, const std::string& name, const std::string& title,
              const std::string& text) {
  add(row, name, title, text).form = JsonForm::kAbsent;
}

std::string factor_label(const std::string& factor) { return "by/" + factor; }

/// A row that begins with whose findings these are.
FindingRow row_of(const TrialsResult& result, const std::string& participant,
                  const std::vector<std::string>& levels, const std::string& source) {
  FindingRow row;
  add(row, "participant", "participant", participant);
  for (std::size_t f = 0; f < levels.size(); ++f) {
    add_word(row, factor_label(result.plan.by[f]), "", levels[f]);
  }
  add_word(row, "source", "", source);
  return row;
}

/// @param end  adds the ends of the interval to estimates.csv, too
void add_roc(FindingRow& row, const std::string& name, const std::string& title,
             const Defined<Roc>& roc, const std::string& csv, bool ends) {
  if (!roc) {
    add_missing(row, name, title, roc.because());
    return;
  }
  Finding& area = add(row, name + "/area", title, roc->area);
  area.csv = csv;
  const auto& i = roc->interval;
  if (!i) {
    add_missing(row, name + "/interval", "", i.because());
    return;
  }
  if (ends) {
    area.low = i->low;
    area.high = i->high;
  }
  add_json(row, name + "/interval", {{"low_95", i->low}, {"high_95", i->high}});
}

void add_meta(FindingRow& row, const TrialsResult& result, const Defined<MetaD>& meta) {
  if (!result.plan.metacognition) {
    return;
  }
  if (!meta) {
    add_missing(row, "meta", "M-ratio", meta.because());
    return;
  }
  add(row, "meta/meta_d", "meta-d'", {meta->meta_d, meta->low, meta->high}, JsonForm::kEstimate,
      "meta_d");
  add(row, "meta/m_ratio", "M-ratio", {meta->ratio, meta->ratio_low, meta->ratio_high},
      JsonForm::kEstimate, "m_ratio");
  add(row, "meta/d_prime", "", meta->d_prime);
  add(row, "meta/log_likelihood", "", meta->log_likelihood);
}

std::string title_if(bool shown, const char* title) { return shown ? title : ""; }

/// Adds the readings of one way of fitting. @param shown  in the report
void add_readings(FindingRow& row, const TrialsResult& result, const std::string& name,
                  const Defined<FunctionReadings>& readings, bool shown, bool lapse_told) {
  const auto title = [&](const char* text, bool also = true) {
    return title_if(shown && also, text);
  };
  if (!readings) {
    add_missing(row, name, title("threshold"), readings.because());
    return;
  }
  const TrialsPlan& plan = result.plan;
  const psychometric::Axis& axis = plan.function.axis;
  const FunctionReadings& r = *readings;
  const auto one = [&](const char* key, const std::string& heading, const Estimated& e,
                       const std::string& unit) {
    add(row, name + "/" + key, heading, e, JsonForm::kEstimate, key, unit);
  };
  one("threshold", title("threshold"), r.threshold, axis.unit);
  one("threshold_on_axis", "", r.x, axis.x_unit());
  one("width", title("width"), r.width, axis.x_unit());
  one("slope", "", r.slope, axis.unit.empty() ? "" : "1/(" + axis.unit + ")");
  one("weber_fraction", title("Weber fraction", plan.reference.has_value()), r.weber, "");
  one("lapse_rate", title("lapse rate", lapse_told), r.lapse, "");
  if (!lapse_told) {
    add_word(row, "", title("lapse rate"), "not told by the answers");
  }
  one("guess_rate", title("guess rate", plan.guess_free), r.guess, "");
}

std::string deviance_word(const FunctionFit& fit) {
  return std::isfinite(fit.deviance_p)
             ? fmt::format("{:.1f}, {}", fit.deviance, p_value(fit.deviance_p))
             : fmt::format("{:.1f}", fit.deviance);
}

FindingRow row_of(const TrialsResult& result, const FunctionFit& fit) {
  constexpr const char* kDeviance = "deviance, or overdispersion";
  const bool bayesian = result.plan.bayesian;
  FindingRow row = row_of(result, fit.participant, fit.levels, "");
  add(row, "condition", "condition", fit.condition);
  add(row, "trials", "trials", fit.trials);
  add(row, "estimates_from", "",
      fit.adaptive                ? "posterior"
      : result.plan.resamples > 0 ? "profile likelihood and bootstrap"
                                  : "profile likelihood");
  add_word(row, "source", "fit", method_of(fit));
  add_readings(row, result, method_of(fit), fit.stated, true, fit.lapse_told);
  add_word(row, "", title_if(bool(fit.stated), kDeviance), deviance_word(fit));
  add(row, "no_interval_because", "", fit.no_interval);
  if (fit.adaptive && fit.likeliest) {
    // The intervals of the likelihood would not hold the truth; its estimates are there for
    // comparison with other programs.
    const psychometric::Axis& axis = result.plan.function.axis;
    add_word(row, "source", "", "likelihood");
    add(row, "", "", {axis.level(fit.likeliest->threshold)}, JsonForm::kAbsent, "threshold",
        axis.unit);
    add(row, "", "", {fit.likeliest->width}, JsonForm::kAbsent, "width", axis.x_unit());
  }
  add_word(row, "source", title_if(bayesian, "fit"), "bayesian");
  add_readings(row, result, "bayesian", fit.bayesian, bayesian, true);
  add_word(row, "", title_if(bayesian && fit.bayesian, kDeviance),
           fmt::format("η {:.2f}", fit.overdispersion));
  add(row, "deviance", "", fit.deviance);
  add(row, "deviance_p", "", fit.deviance_p);
  add(row, "overdispersion_eta", "", fit.overdispersion);
  add_json(row, "warnings", fit.warnings);
  Json blocks = Json::array();
  for (const TrialBlock& b : fit.blocks) {
    blocks.push_back({{"level", b.level}, {"ones", b.correct}, {"trials", b.total}});
  }
  add_json(row, "answers", blocks);
  return row;
}

/// A coefficient and, by the normal distribution, its interval for one participant.
void add_effect(FindingRow& row, const std::string& name, const std::string& title,
                const Defined<double>& effect, double error, const Defined<double>& by_chance) {
  constexpr double kNormal = 1.959964;
  Finding& f = add_defined(row, name + "_log_odds", title, effect);
  if (effect) {
    f.low = *effect - kNormal * error;
    f.high = *effect + kNormal * error;
  }
  add(row, name + "_standard_error", "", effect ? FindingValue(error) : FindingValue());
  add_defined(row, name + "_log_odds_by_chance", "", by_chance);
}

}  // namespace

FindingTable participant_findings(const TrialsResult& result) {
  FindingTable table{"participants", "Participants and trials"};
  for (const ParticipantTrials& p : result.participants) {
    FindingRow& row = table.rows.emplace_back();
    add(row, "participant", "participant", p.participant);
    add(row, "group", "group", p.group);
    add(row, "sessions", "sessions", p.sessions);
    add(row, "trials", "trials", p.counted);
    add(row, "planned_trials_at_most", title_if(p.planned > 0, "planned at most"), p.planned);
    add(row, "practice", "practice", p.practice);
    add(row, "aborted", "aborted or damaged passes", p.aborted);
    const char* time = "median reaction time";  // nothing is asked in reaches
    add_defined(row, "median_reaction_time_s", title_if(!result.reaching, time), p.reaction_time)
        .unit = "s";
    add_json(row, "share_of_trials_at_force_limit_by_stage", p.at_limit);
  }
  return table;
}

FindingTable function_findings(const TrialsResult& result) {
  FindingTable table{"functions", "Every participant's function"};
  for (const FunctionFit& fit : result.fits) {
    table.rows.push_back(row_of(result, fit));
  }
  return table;
}

FindingTable serial_findings(const TrialsResult& result) {
  FindingTable table{"serial_effects", "Serial effects"};
  for (const SerialEffects& s : result.serial) {
    FindingRow& row = table.rows.emplace_back();
    add(row, "participant", "participant", s.participant);
    add(row, "trials", "", s.trials);
    add_effect(row, "drift", "drift (log odds, first to last trial)", s.effects.drift,
               s.effects.drift_error, s.by_chance.drift);
    add_effect(row, "repetition", "repetition (log odds)", s.effects.repetition,
               s.effects.repetition_error, s.by_chance.repetition);
    add(row, "easy_trials", "trials where the function is above 99 %", s.easy);
    add(row, "easy_trials_with_answer_0", "of them with answer 0", s.easy_wrong);
    add(row, "trials_with_another_level_than_asked", "trials with another level than asked for",
        s.limited);
  }
  return table;
}

FindingTable track_findings(const TrialsResult& result) {
  const bool settings = result.plan.kind == AnalysisKind::kAdjustment;
  FindingTable table{"tracks", settings ? "Every participant's settings" : "Every track"};
  for (const TrackEstimate& track : result.tracks) {
    const bool shown = settings || track.adaptive;  // listed levels have no turns and no estimate
    FindingRow& row = table.rows.emplace_back();
    add(row, "participant", title_if(shown, "participant"), track.participant);
    add(row, "track", title_if(shown, "track"), track.track);
    add_word(row, "source", "", "procedure");
    add(row, "variable", "", track.variable);
    add(row, "trials", title_if(shown, "trials"), track.steps.size());
    add(row, "turns", title_if(shown, "turns"),
        std::ranges::count_if(track.steps, &TrackStep::reversal))
        .form = JsonForm::kAbsent;
    add(row, "trials_at_an_end_of_the_range", "", track.at_end);
    Json estimates = Json::array();
    for (const psychometric::Estimate& e : track.estimates) {
      add_word(row, "", title_if(shown, "estimate of the procedure"), e.name);
      const Estimated known = estimated(e);
      add(row, "", title_if(shown, "level"), known, JsonForm::kAbsent, e.name);
      add_word(row, "", title_if(shown && !e.remark.empty(), "remark"), e.remark);
      estimates.push_back({{"name", e.name},
                           {"value", e.value},
                           {"deviation", e.deviation ? Json(*e.deviation) : Json()},
                           {"low_95", known.low},
                           {"high_95", known.high},
                           {"remark", e.remark}});
    }
    add_json(row, "estimates", estimates);
    if (track.estimates.empty()) {
      add_missing(row, "", title_if(shown, "estimate of the procedure"), track.because).form =
          JsonForm::kAbsent;
    }
    add(row, "none_because", "", track.because);
    add(row, "no_interval_because", "", track.no_interval);
  }
  return table;
}

FindingTable detection_findings(const TrialsResult& result) {
  FindingTable table{"detection", "Every participant's detection"};
  for (const DetectedCondition& one : result.detected) {
    FindingRow row = row_of(result, one.participant, one.levels, "detection");
    add(row, "condition", "condition", one.condition);
    const DetectionCounts& c = one.counts;
    add_word(row, "", "hits", fmt::format("{:g} of {:g}", c.hits, c.hits + c.misses));
    add_word(row, "", "false alarms",
             fmt::format("{:g} of {:g}", c.false_alarms, c.false_alarms + c.correct_rejections));
    add(row, "hits", "", c.hits);
    add(row, "misses", "", c.misses);
    add(row, "false_alarms", "", c.false_alarms);
    add(row, "correct_rejections", "", c.correct_rejections);
    if (const auto& d = one.detection) {
      add(row, "detection/d_prime", "d'", {d->d_prime, d->low, d->high}, JsonForm::kBeside,
          "d_prime");
      add(row, "detection/criterion", "criterion c", d->criterion).csv = "criterion";
      add(row, "detection/hit_rate", "", d->hit_rate).csv = "hit_rate";
      add(row, "detection/false_alarm_rate", "", d->false_alarm_rate).csv = "false_alarm_rate";
      add(row, "detection/log_beta", "", d->log_beta);
    } else {
      add_missing(row, "detection", "d'", d.because());
    }
    add_json(row, "ratings_of_noise", one.ratings.noise);
    add_json(row, "ratings_of_signal", one.ratings.signal);
    add_roc(row, "roc", "ROC area, trapezoids", one.roc, "roc_area", true);
    if (const auto& b = one.binormal) {
      add(row, "binormal_roc/area", "ROC area, binormal", {b->area, b->area_low, b->area_high},
          JsonForm::kPlain, "roc_area_binormal");
      add(row, "binormal_roc/low_95", "", b->area_low);
      add(row, "binormal_roc/high_95", "", b->area_high);
      add(row, "binormal_roc/a", "", b->a);
      add(row, "binormal_roc/b", "b = sd of noise / sd of signal", b->b).csv = "binormal_b";
      add(row, "binormal_roc/d_a", "d_a", b->d_a).csv = "d_a";
    } else {
      add_missing(row, "binormal_roc", "", b.because());
    }
    add_meta(row, result, one.meta);
    table.rows.push_back(std::move(row));
  }
  return table;
}

FindingTable identification_findings(const TrialsResult& result) {
  FindingTable table{"identification", "Every participant's identification"};
  for (const IdentifiedCondition& one : result.identified) {
    FindingRow row = row_of(result, one.participant, one.levels, "identification");
    add(row, "condition", "condition", one.condition);
    add_json(row, "stimuli", one.confusions.stimuli);
    add_json(row, "answers", one.confusions.answers);
    add(row, "trials", "trials", one.trials);
    add(row, "right", "right", one.right);
    add(row, "share", "share", {one.share, one.low, one.high}, JsonForm::kBeside, "share_right");
    Finding& d_prime = add_defined(row, "d_prime", "d'", one.d_prime);
    d_prime.low = one.d_low;
    d_prime.high = one.d_high;
    d_prime.form = JsonForm::kBeside;
    d_prime.csv = "d_prime";
    if (one.information) {
      add(row, "information_transfer_bit", "information transfer (bit)", *one.information);
    }
    add_defined(row, "mean_rating_right", "rating where right", one.sure_right);
    add_defined(row, "mean_rating_wrong", "rating where wrong", one.sure_wrong);
    add_roc(row, "roc_of_ratings", "ROC area of ratings", one.sureness, "rating_area", false);
    add_meta(row, result, one.meta);
    table.rows.push_back(std::move(row));
  }
  return table;
}

FindingTable law_findings(const TrialsResult& result) {
  FindingTable table{"magnitudes", "Power laws"};
  for (const MagnitudeCondition& one : result.magnitudes) {
    FindingRow& row = table.rows.emplace_back();
    add(row, "condition", "condition", one.condition);
    add_json(row, "participants", one.participants);
    add(row, "answers_not_above_0", "answers of 0 or below left out", one.not_positive);
    if (!one.one_level.empty()) {
      add(row, "left_out", "left out, as they answered at one level only",
          fmt::format("{}", fmt::join(one.one_level, ", ")));
    }
    if (!one.law) {
      add_missing(row, "law", "exponent", one.law.because());
      continue;
    }
    const PowerLaw& law = *one.law;
    Finding& exponent = add(row, "law/exponent", "exponent", law.exponent);
    exponent.low = law.low ? *law.low : kNotKnown;
    exponent.high = law.high ? *law.high : kNotKnown;
    add(row, "law/standard_error", "", law.error);
    add_defined(row, "law/low_95", "", law.low);
    add_defined(row, "law/high_95", "", law.high);
    add(row, "law/constant", "constant", law.constant);
    add(row, "law/r_squared", "R² of the levels' means", law.r_squared);
    add_json(row, "law/exponents", law.exponents);
    add_json(row, "law/moduli", law.moduli);
    Json lines = Json::array();
    for (const PersonalLine& line : law.lines) {
      lines.push_back({{"low_95", line.low},
                       {"high_95", line.high},
                       {"r_squared", line.r_squared},
                       {"residual_standard_deviation", line.deviation}});
    }
    add_json(row, "law/lines", lines);
    Json levels = Json::array();
    for (const MagnitudeLevel& l : law.levels) {
      levels.push_back({{"level", l.level},
                        {"geometric_mean", l.mean},
                        {"low_95", l.low},
                        {"high_95", l.high},
                        {"participants", l.participants}});
      if (!result.plan.measured.empty()) {
        levels.back()["measured"] = l.measured;
      }
    }
    add_json(row, "law/levels", levels);
  }
  return table;
}

FindingTable exponent_findings(const TrialsResult& result) {
  FindingTable table{"exponents", "Every participant's exponent"};
  for (const MagnitudeCondition& one : result.magnitudes) {
    for (std::size_t i = 0; one.law && i < one.law->participants.size(); ++i) {
      const PowerLaw& law = *one.law;
      FindingRow row =
          row_of(result, one.participants[law.participants[i]], one.levels, "magnitude");
      add(row, "condition", "condition", one.condition);
      add(row, "", "", law.exponents[i]).csv = "exponent";
      add(row, "", "exponent", {law.exponents[i], law.lines[i].low, law.lines[i].high},
          JsonForm::kAbsent);
      add(row, "", "modulus", law.moduli[i]);
      add(row, "", "R²", law.lines[i].r_squared);
      add(row, "", "SD of the residuals (ln)", law.lines[i].deviation);
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

FindingTable cue_findings(const TrialsResult& result, const CueLevel& level) {
  const CuePlan& cues = *result.plan.cues;
  const std::string unit = result.plan.function.axis.x_unit();
  FindingTable table{"participants", "Every participant's weights and standard deviations"};
  for (const CuePerson& p : level.people) {
    FindingRow& row = table.rows.emplace_back();
    add(row, "participant", "participant", p.participant);
    add_word(row, factor_label(cues.at), cues.at, level.level);
    add_word(row, "source", "", "cues");
    const auto one = [&](const char* name, const std::string& title, const Estimated& e,
                         const std::string& of) {
      add(row, name, title, e, JsonForm::kEstimate, name, of);
    };
    one("first_weight", "weight, observed", p.weight, "");
    one("first_weight_predicted", "weight, predicted", p.predicted_weight, "");
    one("first_sd", "σ of " + name_of_cue(cues.first), p.first_sd, unit);
    one("second_sd", "σ of " + name_of_cue(cues.second), p.second_sd, unit);
    one("both_sd", "σ of " + name_of_cue(cues.both), p.both_sd, unit);
    one("both_sd_predicted", "σ, predicted", p.predicted_sd, unit);
    add(row, "bias", "bias", p.bias).unit = unit;
    add(row, "conflicts", "conflicts", p.conflicts);
  }
  return table;
}

FindingTable contrast_findings(const ReachingResult& reaching) {
  FindingTable table{"contrasts", "Adaptation and aftereffect"};
  for (const ReachContrast& each : reaching.contrasts) {
    FindingRow& row = table.rows.emplace_back();
    add(row, "name", "comparison", each.name);
    add(row, "unit", "", each.unit);
    if (!each.contrast) {
      add(row, "not_defined", "", each.contrast.because());
      add_word(row, "", "paired t-test, not adjusted",
               t_result(Undefined{each.contrast.because()}));
      continue;
    }
    const TTest& test = each.contrast->test;
    const double scale = each.unit.empty() ? 1.0 : kMillimetres;
    add(row, "participants", "participants", each.contrast->participants);
    add(row, "left_out", "", each.contrast->left_out);
    add_word(row, "", "difference [95 %]",
             estimate_word({scale * test.difference, scale * test.low, scale * test.high}) +
                 (each.unit.empty() ? "" : " mm"));
    add_json(row, "test", analysis::to_json(test));
    add_word(row, "", "paired t-test, not adjusted", t_result(test));
    add(row, "p_holm", "", *each.holm);
    add_word(row, "", "p after Holm", p_result(each.holm));
  }
  return table;
}

FindingTable reach_quality_findings(const ReachingResult& reaching) {
  FindingTable table{"quality", "Reaches"};
  for (const ReachQuality& q : reaching.quality) {
    FindingRow& row = table.rows.emplace_back();
    add(row, "participant", "participant", q.participant);
    add(row, "reaches", "reaches", q.reaches);
    add(row, "not_recorded", "not recorded", q.not_recorded);
    add(row, "no_onset", "no onset, or moving at the start", q.no_onset);
    add(row, "anticipated", "before the go signal", q.anticipated);
    add(row, "never_slowed", "never slowed", q.never_slowed);
    add(row, "not_arrived", "not arrived in time", q.not_arrived);
    add(row, "missed_target", "ended off target", q.missed_target);
    add(row, "saturated", "at the force limit", q.saturated);
  }
  return table;
}

std::string estimates_csv(const TrialsResult& result) {
  std::vector<CsvLabel> labels{{"participant", "participant"}};
  for (const std::string& factor : result.plan.by) {
    labels.emplace_back(factor, factor_label(factor));
  }
  labels.emplace_back("track", "track");
  labels.emplace_back("source", "source");
  std::vector<FindingTable> tables{function_findings(result)};
  if (result.cues) {
    for (const CueLevel& level : result.cues->levels) {
      tables.push_back(cue_findings(result, level));
    }
  }
  for (const auto table :
       {track_findings, detection_findings, identification_findings, exponent_findings,
        time_findings, hierarchical_group_findings, hierarchical_people_findings}) {
    tables.push_back(table(result));
  }
  return findings_csv(tables, labels);
}

}  // namespace haptrial::analysis::trials
