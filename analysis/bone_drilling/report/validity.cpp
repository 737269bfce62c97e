#include "analysis/bone_drilling/report/validity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "analysis/bone_drilling/report/validity_table.h"
#include "analysis/statistics/base/p_adjust.h"
#include "analysis/statistics/relation/centered_design.h"
#include "core/base/error.h"

namespace haptrial::analysis::drilling {
namespace {

// Every participant gets a number, every procedure its side.
void add_people(Validity& v, std::span<const ProcedureSummary> procedures) {
  for (const std::string& expert : v.plan.expert_groups) {
    if (std::count(v.plan.groups.begin(), v.plan.groups.end(), expert) == 0) {
      throw InputError(fmt::format("expert group '{}' is not a group; allowed: {}", expert,
                                   fmt::join(v.plan.groups, ", ")));
    }
  }
  std::map<std::string, std::pair<std::size_t, std::string>> people;
  for (const ProcedureSummary& p : procedures) {
    if (std::count(v.plan.groups.begin(), v.plan.groups.end(), p.group) == 0) {
      throw InputError(fmt::format("{}: participant {} is in group '{}'; allowed: {}", p.session,
                                   p.participant, p.group, fmt::join(v.plan.groups, ", ")));
    }
    const auto [at, is_new] = people.try_emplace(p.participant, people.size(), p.group);
    if (at->second.second != p.group) {
      throw InputError(fmt::format("{}: participant {} is in group '{}' and in '{}'; choose one",
                                   p.session, p.participant, p.group, at->second.second));
    }
    v.participant.push_back(at->second.first);
    v.expert.push_back(
        std::count(v.plan.expert_groups.begin(), v.plan.expert_groups.end(), p.group) > 0);
    v.simulated = v.simulated || p.simulated;
  }
}

// (procedures x raters), NaN where there is none.
Eigen::MatrixXd rating_table(Validity& v, std::span<const ProcedureSummary> procedures,
                             const std::vector<Rating>& ratings) {
  std::set<std::string> names;
  for (const Rating& r : ratings) {
    names.insert(r.rater);
    v.simulated_raters = v.simulated_raters || r.simulated;
  }
  v.simulated = v.simulated || v.simulated_raters;
  v.raters.assign(names.begin(), names.end());
  Eigen::MatrixXd table = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(procedures.size()),
                                                    static_cast<Eigen::Index>(names.size()),
                                                    std::numeric_limits<double>::quiet_NaN());
  for (const Rating& r : ratings) {
    const auto at =
        std::find_if(procedures.begin(), procedures.end(), [&](const ProcedureSummary& p) {
          return p.session == r.session && p.number == r.procedure;
        });
    if (at == procedures.end()) {
      throw InputError(fmt::format(
          "rater {} rated procedure {} of {}, which is not among the {} procedures of the study",
          r.rater, r.procedure, r.session, procedures.size()));
    }
    table(at - procedures.begin(), std::distance(names.begin(), names.find(r.rater))) = r.score;
  }
  return table;
}

void add_ratings(Validity& v, const Eigen::MatrixXd& table) {
  std::vector<Eigen::Index> complete;
  for (Eigen::Index i = 0; i < table.rows(); ++i) {
    const Eigen::RowVectorXd row = table.row(i);
    double sum = 0.0, count = 0.0;
    for (const double score : row) {
      sum += score == score ? score : 0.0;
      count += score == score ? 1.0 : 0.0;
    }
    v.rating.push_back(count > 0.0 ? std::optional<double>(sum / count) : std::nullopt);
    v.rated += count > 0.0 ? 1 : 0;
    if (row.size() > 0 && row.allFinite()) {
      complete.push_back(i);
    }
  }
  for (const auto& scores : table.colwise()) {
    v.scored.push_back(static_cast<std::size_t>(scores.array().isFinite().count()));
  }
  if (table.cols() > 0) {
    v.agreement = intraclass_correlation(table(complete, Eigen::all));
  }
}

RatingRelation relation_of(const ValueTable& quantity, const ValueTable& rating) {
  RatingRelation relation;
  const auto both = paired(quantity, rating);
  const auto means = paired(participant_means(quantity), participant_means(rating));
  relation.pooled = pearson_correlation(both.second, both.first);
  relation.line = linear_regression(both.second, both.first);
  relation.means = pearson_correlation(means.second, means.first);
  relation.ranks = spearman_correlation(means.second, means.first);
  return relation;
}

ValueTable metric_table(const Validity& v, std::span<const ProcedureSummary> procedures,
                        std::size_t metric) {
  ValueTable table = table_of(v, procedures);
  for (std::size_t i = 0; i < procedures.size(); ++i) {
    table.rows[i].value = procedures[i].values[metric];
  }
  return table;
}

// p of experts against novices, see MetricValidity::contrast_p.
Defined<double> contrast_p(const MetricValidity& metric,
                           const std::optional<RegionLabelTest>& region_test) {
  const Defined<TTest>& welch = metric.contrast.means;
  if (!welch) {
    return Undefined{welch.because()};
  }
  if (metric.kind.name != kRegionMetric) {
    return welch->p;
  }
  return region_test ? Defined<double>(region_test->p)
                     : Undefined{"the labels of participants were not permuted"};
}

void adjust(std::vector<MetricValidity>& metrics) {
  std::vector<Defined<Correlation>> relations;
  std::vector<Defined<Correlation>> ranks;
  std::vector<double> contrasts;
  for (const MetricValidity& metric : metrics) {
    relations.push_back(metric.relation.means);
    ranks.push_back(metric.relation.ranks);
    if (metric.contrast_p) {
      contrasts.push_back(*metric.contrast_p);
    }
  }
  const auto relation_holm = holm_over(relations);
  const auto ranks_holm = holm_over(ranks);
  const std::vector<double> contrast_holm = holm_adjusted(contrasts);
  std::size_t next = 0;
  for (std::size_t m = 0; m < metrics.size(); ++m) {
    metrics[m].relation_holm = relation_holm[m];
    metrics[m].ranks_holm = ranks_holm[m];
    const Defined<double>& p = metrics[m].contrast_p;
    metrics[m].contrast_holm = p ? Defined<double>(contrast_holm[next++]) : Undefined{p.because()};
  }
}

void add_metrics(Validity& v, std::span<const ProcedureSummary> procedures,
                 const ValueTable& rating, const std::optional<RegionLabelTest>& region_test) {
  const std::vector<MetricKind> kinds = metric_kinds();
  for (std::size_t m = 0; m < kinds.size(); ++m) {
    const ValueTable table = metric_table(v, procedures, m);
    MetricValidity metric{.kind = kinds[m], .groups = {}, .contrast = {}, .relation = {}};
    metric.defined = static_cast<std::size_t>(std::count_if(
        table.rows.begin(), table.rows.end(), [](const auto& row) { return row.value; }));
    metric.groups = group_values(table, v.plan);
    metric.contrast = contrast(table, kinds[m].experts);
    metric.relation = relation_of(table, rating);
    metric.contrast_p = contrast_p(metric, region_test);
    v.metrics.push_back(std::move(metric));
  }
  adjust(v.metrics);
}

Defined<Roc> roc_of(const Validity& v, const std::vector<std::size_t>& rows,
                    const Eigen::VectorXd& values) {
  std::vector<RocCase> cases;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    cases.push_back(
        {values[static_cast<Eigen::Index>(i)], v.expert[rows[i]], v.participant[rows[i]]});
  }
  return roc(cases);
}

// Metrics that every rated procedure has and that differ, as columns.
void add_combined(Validity& v, std::span<const ProcedureSummary> procedures) {
  Combined& c = v.combined;
  for (std::size_t i = 0; i < procedures.size(); ++i) {
    if (v.rating[i]) {
      c.rows.push_back(i);
    }
  }
  std::vector<std::vector<double>> columns;
  for (std::size_t m = 0; m < v.metrics.size(); ++m) {
    std::vector<double> column;
    for (const std::size_t i : c.rows) {
      if (procedures[i].values[m]) {
        column.push_back(*procedures[i].values[m]);
      }
    }
    const bool differs = column.size() == c.rows.size() && vary_beyond_rounding(column);
    (differs ? c.metrics : c.left_out).push_back(v.metrics[m].kind.name);
    if (differs) {
      columns.push_back(std::move(column));
    }
  }
  std::vector<double> response;
  std::vector<std::size_t> who;
  Eigen::MatrixXd predictors(static_cast<Eigen::Index>(c.rows.size()),
                             static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < c.rows.size(); ++i) {
    response.push_back(*v.rating[c.rows[i]]);
    who.push_back(v.participant[c.rows[i]]);
    for (std::size_t m = 0; m < columns.size(); ++m) {
      predictors(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(m)) = columns[m][i];
    }
  }
  c.fit = c.rows.empty() ? Defined<CrossValidated>(Undefined{"nothing is rated"})
                         : cross_validated_ridge(response, predictors, who);
  if (c.fit) {
    c.roc = roc_of(v, c.rows, c.fit->predicted);
    c.resubstitution_roc = roc_of(v, c.rows, c.fit->resubstituted);
  } else {
    c.roc = c.resubstitution_roc = Undefined{c.fit.because()};
  }
}

void add_regions(Validity& v, std::span<const ProcedureSummary> procedures,
                 std::span<const RegionScores> regions, const ValueTable& rating) {
  using Member = std::optional<double> RegionScores::*;
  const std::array<std::pair<const char*, Member>, 6> scores{{
      {"all voxels, one participant of each side left out (used here)", &RegionScores::score},
      {"all voxels, the participant left out", &RegionScores::leave_subject_out},
      {"all voxels, tested on the training data", &RegionScores::resubstitution},
      {"removed voxels, one participant of each side left out", &RegionScores::removed_only},
      {"removed voxels, the participant left out", &RegionScores::removed_leave_subject_out},
      {"removed voxels, tested on the training data (as published)",
       &RegionScores::removed_resubstitution},
  }};
  for (const auto& [name, member] : scores) {
    ValueTable table = table_of(v, procedures);
    for (std::size_t i = 0; i < regions.size() && i < table.rows.size(); ++i) {
      table.rows[i].value = regions[i].*member;
    }
    const RatingRelation relation = relation_of(table, rating);
    v.regions.push_back(
        {name, relation.pooled, relation.means, contrast(table, Expected::kHigher).roc});
  }
}

}  // namespace

Validity validity(std::span<const ProcedureSummary> procedures,
                  std::span<const RegionScores> regions, const std::vector<Rating>& ratings,
                  const ValidityPlan& plan, const std::optional<RegionLabelTest>& region_test) {
  Validity v;
  v.plan = plan;
  add_people(v, procedures);
  add_ratings(v, rating_table(v, procedures, ratings));
  ValueTable rating = table_of(v, procedures);
  for (std::size_t i = 0; i < procedures.size(); ++i) {
    rating.rows[i].value = v.rating[i];
  }
  v.rating_groups = group_values(rating, plan);
  v.rating_contrast = contrast(rating, Expected::kHigher);
  add_metrics(v, procedures, rating, region_test);
  add_combined(v, procedures);
  add_regions(v, procedures, regions, rating);
  return v;
}

}  // namespace haptrial::analysis::drilling
