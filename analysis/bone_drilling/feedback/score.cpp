#include "analysis/bone_drilling/feedback/score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/bone_drilling/feedback/procedure_tables.h"
#include "analysis/files/sha256.h"
#include "analysis/statistics/base/distributions.h"
#include "analysis/statistics/relation/centered_design.h"
#include "analysis/statistics/relation/cross_validated.h"

namespace haptrial::analysis::drilling {
namespace {

constexpr double kLowest = 1.0, kHighest = 5.0;  // of the raters' scale
constexpr double kBothTails = 0.975;

std::vector<ScoreMetric> candidates(const ProcedureSummary& summary) {
  std::vector<ScoreMetric> metrics;
  const auto add = [&metrics](const std::string& name, const std::string& title,
                              const std::string& unit) {
    ScoreMetric metric;
    metric.name = name;
    metric.title = title;
    metric.unit = unit == "1" ? "" : unit;
    metrics.push_back(metric);
  };
  for (const MetricKind& kind : shown_metrics()) {
    add(kind.name, kind.title, kind.unit);
  }
  for (const AchievedFigure& figure : figures_of(summary.achieved)) {
    add(figure.column, figure.title, figure.unit);
  }
  return metrics;
}

/// Metrics that every procedure has and that vary.
std::vector<ScoreMetric> usable_metrics(std::span<const RatedSummary> procedures) {
  std::vector<ScoreMetric> metrics = candidates(procedures.front().summary);
  std::erase_if(metrics, [&](ScoreMetric& metric) {
    std::vector<double> values;
    for (const RatedSummary& each : procedures) {
      if (const auto value = quantity(each.summary, metric.name)) {
        values.push_back(*value);
      }
    }
    if (values.size() < procedures.size()) {
      return true;
    }
    metric.low = *std::min_element(values.begin(), values.end());
    metric.high = *std::max_element(values.begin(), values.end());
    return !vary_beyond_rounding(values);
  });
  return metrics;
}

/// Why a procedure is not of the case of a model; empty if it is.
std::string other_case(const ScoreModel& model, const ProcedureSummary& summary,
                       const std::map<std::string, std::string>& rules) {
  if (model.version != kMetricsVersion) {
    return fmt::format(
        "its metrics are of version {}, those of this program of version {}; learn it anew",
        model.version, kMetricsVersion);
  }
  if (std::count(model.bones.begin(), model.bones.end(), bone_digest(*summary.bone)) == 0) {
    return "it was learned on another bone";
  }
  std::map<std::string, std::string> all = model.rules;
  all.insert(rules.begin(), rules.end());
  const auto value_in = [](const std::map<std::string, std::string>& in, const std::string& name) {
    const auto at = in.find(name);
    return at == in.end() ? std::string("none") : at->second;
  };
  for (const auto& [name, ignored] : all) {
    const std::string learned = value_in(model.rules, name), here = value_in(rules, name);
    if (learned != here) {
      return fmt::format("it was learned with another {} ({}; here {})", name, learned, here);
    }
  }
  return "";
}

}  // namespace

Defined<ScoreModel> learn_score(std::span<const RatedSummary> procedures) {
  if (procedures.empty()) {
    return Undefined{"no procedure is rated"};
  }
  ScoreModel model;
  model.metrics = usable_metrics(procedures);
  model.procedures = procedures.size();
  Eigen::MatrixXd predictors(static_cast<Eigen::Index>(procedures.size()),
                             static_cast<Eigen::Index>(model.metrics.size()));
  std::vector<double> ratings;
  std::vector<std::string> names;
  std::vector<std::size_t> who;
  for (std::size_t i = 0; i < procedures.size(); ++i) {
    const ProcedureSummary& s = procedures[i].summary;
    ratings.push_back(procedures[i].rating);
    const auto at = std::find(names.begin(), names.end(), s.participant);
    who.push_back(static_cast<std::size_t>(at - names.begin()));
    if (at == names.end()) {
      names.push_back(s.participant);
    }
    model.simulated = model.simulated || s.simulated;
    for (std::size_t m = 0; m < model.metrics.size(); ++m) {
      predictors(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(m)) =
          *quantity(s, model.metrics[m].name);
    }
  }
  const auto fit = cross_validated_ridge(ratings, predictors, who);
  if (!fit) {
    return Undefined{fit.because()};
  }
  model.participants = names.size();
  model.intercept = fit->fit.intercept;
  model.r = fit->validated.r ? *fit->validated.r : 0.0;
  model.half_width =
      t_quantile(kBothTails, static_cast<double>(names.size()) - 1.0) * fit->validated.rmse;
  for (std::size_t m = 0; m < model.metrics.size(); ++m) {
    const auto at = static_cast<Eigen::Index>(m);
    model.metrics[m].mean = fit->fit.mean[at];
    model.metrics[m].scale = fit->fit.scale[at];
    model.metrics[m].slope = fit->fit.slopes[at];
  }
  return model;
}

Defined<Score> score_of(const ScoreModel& model, const ProcedureSummary& summary,
                        const std::map<std::string, std::string>& rules) {
  if (const std::string why = other_case(model, summary, rules); !why.empty()) {
    return Undefined{why};
  }
  Score score;
  double sum = model.intercept;
  for (const ScoreMetric& metric : model.metrics) {
    const auto value = quantity(summary, metric.name);
    if (!value) {
      return Undefined{fmt::format("this procedure has no value of \"{}\"", metric.title)};
    }
    const double points = metric.slope * (*value - metric.mean) / metric.scale;
    sum += points;
    score.parts.push_back(
        {metric.title, metric.unit, *value, points, *value < metric.low || *value > metric.high});
  }
  std::stable_sort(score.parts.begin(), score.parts.end(),
                   [](const ScorePart& a, const ScorePart& b) { return a.points < b.points; });
  score.value = std::clamp(sum, kLowest, kHighest);
  score.low = std::clamp(sum - model.half_width, kLowest, kHighest);
  score.high = std::clamp(sum + model.half_width, kLowest, kHighest);
  return score;
}

std::string bone_digest(const bone::BoneModel& bone) {
  constexpr float kDensities = 255.0F;  // as files hold them
  std::string text = fmt::format("{} {} {} {}\n", bone.grid.size[0], bone.grid.size[1],
                                 bone.grid.size[2], bone.grid.spacing);
  text.append(bone.labels.begin(), bone.labels.end());
  for (const float density : bone.density) {
    text += static_cast<char>(std::lround(kDensities * std::clamp(density, 0.0F, 1.0F)));
  }
  for (const bone::Structure& structure : bone.structures) {
    text += fmt::format("\n{} {} {}", structure.name, structure.hardness, structure.vital);
  }
  return sha256_of(text);
}

}  // namespace haptrial::analysis::drilling
