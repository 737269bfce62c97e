#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "analysis/document/finding_json_internal.h"
#include "analysis/psychophysics/report/trials_findings.h"
#include "analysis/psychophysics/report/trials_json.h"
#include "analysis/psychophysics/report/trials_report.h"
#include "analysis/psychophysics/report/trials_words.h"
#include "analysis/statistics/design/result_json_internal.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::trials {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t kMostPaths = 24;

std::string interval_word(const Mean& mean, double scale) {
  if (const auto& whole = mean.interval) {
    return estimate_word({scale * whole->mean, scale * whole->low, scale * whole->high});
  }
  return mean.value ? estimate_word({scale * *mean.value}) : "–";
}

void add_block_means(Document& document, const ReachingResult& reaching) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  constexpr double kSquareCentimetres = 1e4;
  Rows rows;
  for (std::size_t b = 0; b < reaching.blocks.size(); ++b) {
    const BlockMeans& m = reaching.means[b];
    rows.push_back({reaching.blocks[b].name, std::to_string(reaching.blocks[b].trials),
                    interval_word(m.movement_time, 1.0), interval_word(m.peak_speed, 1.0),
                    interval_word(m.error, kMillimetres),
                    interval_word(m.error_at_150_ms, kMillimetres),
                    interval_word(m.direction, kDegrees), interval_word(m.area, kSquareCentimetres),
                    interval_word(m.compensation, 1.0)});
  }
  document.table({"block", "trials", "movement time (s)", "peak speed (m/s)",
                  "largest perpendicular error (mm)", "error at 150 ms (mm)",
                  "direction error at 150 ms (°)", "signed area (cm²)", "force compensation"},
                 rows);
  document.paragraph(
      "Means over participants [95 %] of the reaches without a probe; force compensation is that "
      "of reaches in a channel. Signs are turned so that the participant's field pushes to +.");
}

/// Estimates of a table with their intervals over resampled participants, and what the sentences
/// below it say of the intervals that are missing or left draws out.
class Resampled {
 public:
  explicit Resampled(std::size_t draws) : draws_(draws) {}

  /// @param name  of the estimate, such as "amplitude of adaptation"
  std::string word(const std::string& name, double value,
                   const Defined<BootstrapInterval>& interval, double scale) {
    if (!interval) {
      notes_.push_back(fmt::format("{}: no interval, because {}", name, interval.because()));
      return number(scale * value);
    }
    if (interval->resamples < draws_) {
      notes_.push_back(
          fmt::format("{}: {} of {} resamples are left out, for which it does not exist", name,
                      draws_ - interval->resamples, draws_));
    }
    return estimate_word({scale * value, scale * interval->low, scale * interval->high});
  }
  void add_notes(Document& document) const {
    if (!notes_.empty()) {
      document.points(notes_);
    }
  }

 private:
  std::size_t draws_;
  std::vector<std::string> notes_;
};

void add_exponentials(Document& document, const ReachingResult& reaching) {
  Rows rows;
  Resampled resampled(reaching.plan.resamples);
  for (const ReachBlock& block : reaching.blocks) {
    if (!block.learns) {
      continue;
    }
    if (!block.fit) {
      rows.push_back(
          {block.name, "not defined, because " + block.fit.because(), "–", "–", "–", "–"});
      continue;
    }
    const LearningFit& f = *block.fit;
    const auto word = [&](const char* what, double value, const auto& interval, double scale) {
      return resampled.word(fmt::format("{} of {}", what, block.name), value, interval, scale);
    };
    rows.push_back({block.name, word("amplitude", f.fit.amplitude, f.amplitude, kMillimetres),
                    word("asymptote", f.fit.asymptote, f.asymptote, kMillimetres),
                    word("time constant", f.fit.time_constant, f.time_constant, 1.0),
                    number(f.fit.rate()), fmt::format("{:.3f}", f.fit.r_squared)});
  }
  if (rows.empty()) {
    document.paragraph("No block has another field than the block before, so no curve is fitted.");
    return;
  }
  document.table({"block", "amplitude (mm)", "asymptote (mm)", "time constant (cycles)",
                  "rate (per cycle)", "R² of the means"},
                 rows);
  document.paragraph(
      fmt::format("Error = asymptote + amplitude exp(-n / time constant), n = 0 in the first "
                  "cycle; a cycle has "
                  "{}. Intervals [95 %] resample participants.",
                  counted(reaching.plan.cycle, "trial")));
  resampled.add_notes(document);
}

void add_two_rate(Document& document, const ReachingResult& reaching) {
  document.subheading("Two rates");
  if (!reaching.two_rate) {
    document.paragraph("The two-rate model is not defined, because " + reaching.two_rate.because() +
                       ".");
    return;
  }
  const TwoRateLearning& t = *reaching.two_rate;
  const TwoRateModel& m = t.fit.model;
  Resampled resampled(reaching.plan.resamples);
  document.table(
      {"process", "retention [95 %]", "learning [95 %]"},
      {{"fast", resampled.word("fast retention", m.fast.retention, t.fast_retention, 1.0),
        resampled.word("fast learning", m.fast.learning, t.fast_learning, 1.0)},
       {"slow", resampled.word("slow retention", m.slow.retention, t.slow_retention, 1.0),
        resampled.word("slow learning", m.slow.learning, t.slow_learning, 1.0)}});
  resampled.add_notes(document);
  document.paragraph(fmt::format(
      "One model for all trials of all participants{}, {} measured values. Without adaptation the "
      "field makes an error of {} mm at 150 ms. Errors at 150 ms, before feedback has acted much, "
      "are taken as proportional to what is not compensated; breaks are not modelled.",
      reaching.blocks.front().session != reaching.blocks.back().session
          ? " in the first session in a field"
          : "",
      t.fit.count, number(kMillimetres * m.error_scale * reaching.two_rate_unit)));
}

}  // namespace

void add_reaching(Document& document, const TrialsResult& result,
                  const std::vector<Drawing>& drawings) {
  const ReachingResult& reaching = *result.reaching;
  add_section(document, result, "Reaches");
  add_pictures(document, drawings, "learning-curve", 1);
  add_block_means(document, reaching);
  document.subheading("Adaptation and aftereffect");
  add_table(document, contrast_findings(reaching), false);
  document.subheading("Learning curves");
  add_exponentials(document, reaching);
  add_pictures(document, drawings, "force-compensation", 1);
  add_two_rate(document, reaching);
  document.subheading("Speeds and paths");
  add_pictures(document, drawings, "speed-profiles", 1);
  add_pictures(document, drawings, "trajectories-", kMostPaths);
}

void add_reach_quality(Document& document, const TrialsResult& result) {
  if (!result.reaching) {
    return;
  }
  add_table(document, reach_quality_findings(*result.reaching), false);
  document.paragraph(
      "Reaches without an onset have no metrics and take part in nothing; those that never "
      "slowed have no movement time, end and throughput; all others take part.");
}

void add_reaching_methods(Document& document, const ReachingPlan& plan) {
  document.paragraph(fmt::format(
      "A reach lasts from the first to the last tick of the stage {}, on the way from {} to {}. "
      "Positions pass a low-pass of fourth order at 20 Hz without delay. Onset: the last rise "
      "above "
      "0.03 m/s before a tenth of the peak speed; end: the first fall below 0.05 m/s for 0.1 s. "
      "Learning is about {}. Force compensation is the slope of the channel's lateral force over "
      "that of the field{} at the same velocity.",
      plan.stage, plan.start, plan.target,
      plan.at_150_ms ? "the perpendicular error 150 ms after onset"
                     : "the largest perpendicular error",
      plan.field.empty() ? "" : " " + plan.field));
  document.paragraph(
      "Participants are compared with themselves by paired t-tests, two-sided, of the means of "
      "cycles; p values of all comparisons are adjusted together by Holm's method.");
}

namespace {

using Json = nlohmann::ordered_json;

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
    one["means"] = {{"movement_time_s", analysis::to_json(m.movement_time)},
                    {"peak_speed_m_per_s", analysis::to_json(m.peak_speed)},
                    {"maximum_perpendicular_error_m", analysis::to_json(m.error)},
                    {"perpendicular_error_at_150_ms_m", analysis::to_json(m.error_at_150_ms)},
                    {"direction_error_at_150_ms_rad", analysis::to_json(m.direction)},
                    {"signed_area_m2", analysis::to_json(m.area)},
                    {"force_compensation", analysis::to_json(m.compensation)}};
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
