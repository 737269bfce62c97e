#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/document/finding_json_internal.h"
#include "analysis/psychophysics/report/trials_findings.h"
#include "analysis/psychophysics/report/trials_json.h"
#include "analysis/statistics/design/result_json_internal.h"

namespace haptrial::analysis::trials {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json defined(const Defined<T>& value) {
  return value ? analysis::to_json(*value) : Json{{"not_defined", value.because()}};
}

Json interval(double estimate, const Defined<BootstrapInterval>& of) {
  Json made{{"estimate", estimate}};
  if (of) {
    made["low_95"] = of->low;
    made["high_95"] = of->high;
  } else {
    made["interval"] = {{"not_defined", of.because()}};
  }
  return made;
}

Json fit_json(const Defined<LearningFit>& fit) {
  if (!fit) {
    return {{"not_defined", fit.because()}};
  }
  return {{"asymptote_m", interval(fit->fit.asymptote, fit->asymptote)},
          {"amplitude_m", interval(fit->fit.amplitude, fit->amplitude)},
          {"time_constant_cycles", interval(fit->fit.time_constant, fit->time_constant)},
          {"rate_per_cycle", fit->fit.rate()},
          {"r_squared", fit->fit.r_squared}};
}

Json curve_json(const ReachCurve& curve) {
  Json points = Json::array();
  for (std::size_t c = 0; c < curve.points.size(); ++c) {
    const CyclePoint& point = curve.points[c];
    if (point.participants == 0) {
      continue;
    }
    const auto& limits = point.between;
    points.push_back({{"cycle", c + 1},
                      {"participants", point.participants},
                      {"mean", point.mean},
                      {"low_95", limits ? Json(limits->low) : Json()},
                      {"high_95", limits ? Json(limits->high) : Json()}});
  }
  return points;
}

Json blocks_json(const ReachingResult& reaching) {
  Json blocks = Json::array();
  for (std::size_t b = 0; b < reaching.blocks.size(); ++b) {
    const ReachBlock& block = reaching.blocks[b];
    const BlockMeans& m = reaching.means[b];
    Json one{{"block", block.name},
             {"trials", block.trials},
             {"first_cycle", block.first_cycle + 1},
             {"cycles", block.cycles},
             {"perturbation", block.perturbation}};
    one["means"] = {{"movement_time_s", defined(m.movement_time)},
                    {"peak_speed_m_per_s", defined(m.peak_speed)},
                    {"maximum_perpendicular_error_m", defined(m.error)},
                    {"perpendicular_error_at_150_ms_m", defined(m.error_at_150_ms)},
                    {"direction_error_at_150_ms_rad", defined(m.direction)},
                    {"signed_area_m2", defined(m.area)},
                    {"force_compensation", defined(m.compensation)}};
    one["exponential"] = fit_json(block.fit);
    blocks.push_back(std::move(one));
  }
  return blocks;
}

Json two_rate_json(const ReachingResult& reaching) {
  if (!reaching.two_rate) {
    return {{"not_defined", reaching.two_rate.because()}};
  }
  const TwoRateLearning& t = *reaching.two_rate;
  const TwoRateModel& m = t.fit.model;
  return {{"fast_retention", interval(m.fast.retention, t.fast_retention)},
          {"fast_learning", interval(m.fast.learning, t.fast_learning)},
          {"slow_retention", interval(m.slow.retention, t.slow_retention)},
          {"slow_learning", interval(m.slow.learning, t.slow_learning)},
          {"error_without_adaptation_m", m.error_scale * reaching.two_rate_unit},
          {"measured", t.fit.count}};
}

}  // namespace

std::string reaching_json(const ReachingResult& reaching) {
  const Json root{{"stage", reaching.plan.stage},
                  {"field", reaching.plan.field},
                  {"trials_of_a_cycle", reaching.plan.cycle},
                  {"error", reaching.plan.at_150_ms ? "perpendicular_error_at_150_ms_m"
                                                    : "maximum_perpendicular_error_m"},
                  {"blocks", blocks_json(reaching)},
                  {"learning_curve", curve_json(reaching.plain)},
                  {"catch_trials", curve_json(reaching.catches)},
                  {"force_compensation", curve_json(reaching.clamps)},
                  {"contrasts", json_of(contrast_findings(reaching).rows)},
                  {"two_rate", two_rate_json(reaching)},
                  {"quality", json_of(reach_quality_findings(reaching).rows)}};
  return root.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace haptrial::analysis::trials
