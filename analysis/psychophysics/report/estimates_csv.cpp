#include "analysis/psychophysics/report/estimates_csv.h"

#include <cmath>

#include "analysis/files/delimited.h"
#include "analysis/psychophysics/report/trials_words.h"

namespace haptrial::analysis::trials {
namespace {

using exchange::RowText;

/// Rows of the table, one after the other.
class Estimates {
 public:
  explicit Estimates(const TrialsResult& result)
      : result_(result), row_(text_, exchange::Delimited::kCsv) {
    row_.add("participant");
    for (const std::string& factor : result.plan.by) {
      row_.add(factor);
    }
    for (const char* name : {"track", "source", "name", "estimate", "low", "high", "unit"}) {
      row_.add(name);
    }
    row_.end();
  }

  std::string take() { return std::move(text_); }

  void add(const std::string& participant, const std::vector<std::string>& levels,
           const std::string& track, const char* source, const char* name, const Estimated& e,
           const std::string& unit) {
    if (!std::isfinite(e.value)) {
      return;
    }
    row_.add(participant);
    for (std::size_t f = 0; f < result_.plan.by.size(); ++f) {
      f < levels.size() ? row_.add(levels[f]) : row_.add_missing();
    }
    row_.add(track).add(source).add(name).add(e.value).add(e.low).add(e.high).add(unit);
    row_.end();
  }

  void add(const FunctionFit& fit, const Defined<FunctionReadings>& readings, const char* source) {
    if (!readings) {
      return;
    }
    const psychometric::Axis& axis = result_.plan.function.axis;
    const FunctionReadings& r = *readings;
    const auto one = [&](const char* name, const Estimated& e, const std::string& unit) {
      add(fit.participant, fit.levels, "", source, name, e, unit);
    };
    one("threshold", r.threshold, axis.unit);
    one("threshold_on_axis", r.x, axis.x_unit());
    one("width", r.width, axis.x_unit());
    one("slope", r.slope, axis.unit.empty() ? "" : "1/(" + axis.unit + ")");
    one("weber_fraction", r.weber, "");
    one("lapse_rate", r.lapse, "");
    one("guess_rate", r.guess, "");
  }

  /// Adds the likelihood's estimates of adaptive trials, for comparison with other programs; their
  /// intervals would not hold the truth and are left out.
  void add_likeliest(const FunctionFit& fit) {
    const psychometric::Axis& axis = result_.plan.function.axis;
    const FittedParameters& p = *fit.likeliest;
    add(fit.participant, fit.levels, "", "likelihood", "threshold", {axis.level(p.threshold)},
        axis.unit);
    add(fit.participant, fit.levels, "", "likelihood", "width", {p.width}, axis.x_unit());
  }

 private:
  const TrialsResult& result_;
  std::string text_;
  RowText row_;
};

void add_detection(const DetectedCondition& one, Estimates& rows) {
  const auto add = [&](const char* name, const Estimated& e) {
    rows.add(one.participant, one.levels, "", "detection", name, e, "");
  };
  if (one.detection) {
    const Detection& d = *one.detection;
    add("d_prime", {d.d_prime, d.low, d.high});
    add("criterion", {d.criterion});
    add("hit_rate", {d.hit_rate});
    add("false_alarm_rate", {d.false_alarm_rate});
  }
  if (one.roc) {
    const auto& i = one.roc->interval;
    add("roc_area", {one.roc->area, i ? i->low : kNotKnown, i ? i->high : kNotKnown});
  }
  if (one.binormal) {
    add("roc_area_binormal", {one.binormal->area, one.binormal->area_low, one.binormal->area_high});
    add("d_a", {one.binormal->d_a});
  }
}

void add_cue_rows(const TrialsResult& result, Estimates& rows) {
  const CuePlan& plan = *result.plan.cues;
  const std::string unit = result.plan.function.axis.x_unit();
  for (const CueLevel& level : result.cues->levels) {
    std::vector<std::string> levels;  // of `at` alone
    for (const std::string& factor : result.plan.by) {
      levels.push_back(factor == plan.at ? level.level : std::string());
    }
    for (const CuePerson& p : level.people) {
      const auto add = [&](const char* name, const Estimated& e, const std::string& of) {
        rows.add(p.participant, levels, "", "cues", name, e, of);
      };
      add("first_weight", p.weight, "");
      add("first_weight_predicted", p.predicted_weight, "");
      add("first_sd", p.first_sd, unit);
      add("second_sd", p.second_sd, unit);
      add("both_sd", p.both_sd, unit);
      add("both_sd_predicted", p.predicted_sd, unit);
    }
  }
}

}  // namespace

std::string estimates_csv(const TrialsResult& result) {
  Estimates rows(result);
  for (const FunctionFit& fit : result.fits) {
    rows.add(fit, fit.stated, method_of(fit));
    if (fit.adaptive && fit.likeliest) {
      rows.add_likeliest(fit);
    }
    rows.add(fit, fit.bayesian, "bayesian");
  }
  if (result.cues) {
    add_cue_rows(result, rows);
  }
  for (const TrackEstimate& track : result.tracks) {
    for (const psychometric::Estimate& e : track.estimates) {
      rows.add(track.participant, {}, track.track, "procedure", e.name.c_str(), estimated(e), "");
    }
  }
  for (const DetectedCondition& one : result.detected) {
    add_detection(one, rows);
  }
  for (const IdentifiedCondition& one : result.identified) {
    const auto add = [&](const char* name, const Estimated& e) {
      rows.add(one.participant, one.levels, "", "identification", name, e, "");
    };
    add("share_right", {one.share, one.low, one.high});
    if (one.d_prime) {
      add("d_prime", {*one.d_prime, one.d_low, one.d_high});
    }
    if (one.sureness) {
      add("rating_area", {one.sureness->area});
    }
  }
  for (const MagnitudeCondition& one : result.magnitudes) {
    for (std::size_t i = 0; one.law && i < one.law->participants.size(); ++i) {
      rows.add(one.participants[one.law->participants[i]], one.levels, "", "magnitude", "exponent",
               {one.law->exponents[i]}, "");
    }
  }
  return rows.take();
}

}  // namespace haptrial::analysis::trials
