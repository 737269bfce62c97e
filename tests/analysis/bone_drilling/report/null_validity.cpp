#include "tests/analysis/bone_drilling/report/null_validity.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "analysis/bone_drilling/report/validity_table.h"
#include "analysis/files/csv.h"
#include "core/base/random.h"

namespace haptrial::test {
namespace {

namespace drilling = analysis::drilling;

constexpr double kAlpha = 0.05;

bool below(const analysis::Defined<double>& p) { return p && *p < kAlpha; }

template <class Test>
bool below(const analysis::Defined<Test>& test) {
  return test && test->p < kAlpha;
}

template <class T>
void shuffle(std::vector<T>& values, RandomStream& random) {
  for (std::size_t i = values.size(); i > 1; --i) {
    std::swap(values[i - 1], values[random.below(i)]);
  }
}

std::vector<std::string> participants_of(const RatedStudy& study) {
  std::vector<std::string> names;
  for (const auto& p : study.procedures) {
    if (std::find(names.begin(), names.end(), p.participant) == names.end()) {
      names.push_back(p.participant);
    }
  }
  return names;
}

void permute_groups(RatedStudy& study, RandomStream& random) {
  const auto names = participants_of(study);
  std::vector<std::string> groups;
  for (const auto& name : names) {
    groups.push_back(
        std::find_if(study.procedures.begin(), study.procedures.end(), [&](const auto& p) {
          return p.participant == name;
        })->group);
  }
  shuffle(groups, random);
  for (auto& p : study.procedures) {
    const auto at = std::find(names.begin(), names.end(), p.participant);
    p.group = groups[static_cast<std::size_t>(at - names.begin())];
  }
}

/// A session is one participant's here.
void permute_ratings(RatedStudy& study, RandomStream& random) {
  std::vector<std::string> sessions;
  for (const auto& p : study.procedures) {
    if (std::find(sessions.begin(), sessions.end(), p.session) == sessions.end()) {
      sessions.push_back(p.session);
    }
  }
  std::vector<std::string> others = sessions;
  shuffle(others, random);
  for (auto& rating : study.ratings) {
    const auto at = std::find(sessions.begin(), sessions.end(), rating.session);
    rating.session = others[static_cast<std::size_t>(at - sessions.begin())];
  }
}

bool excludes_half(const analysis::Defined<analysis::Roc>& roc) {
  return roc && roc->interval && (roc->interval->low > 0.5 || roc->interval->high < 0.5);
}

template <class Member>
bool any_metric(const drilling::Validity& v, Member&& found) {
  return std::any_of(v.metrics.begin(), v.metrics.end(), found);
}

void note_groups(NullLevels& levels, const drilling::Validity& v) {
  using Metric = drilling::MetricValidity;
  const drilling::Contrast& c = v.rating_contrast;
  levels.note("ratings: Welch's t over participants' means", true, below(c.means));
  levels.note("ratings: mixed model", false, below(c.mixed_p));
  levels.note("any metric: Welch's t after Holm", true,
              any_metric(v, [](const Metric& m) { return below(m.contrast_holm); }));
  for (const Metric& m : v.metrics) {
    levels.note("one metric: mixed model, not adjusted", false, below(m.contrast.mixed_p));
    levels.note("one metric: Welch's t, not adjusted", false, below(m.contrast.means));
    levels.note("one metric: 95 % CI of the ROC area without 0.5", false,
                excludes_half(m.contrast.roc));
    levels.note("as published: one metric, Student's t over procedures", false,
                below(m.contrast.pooled));
  }
  levels.note("ratings: 95 % CI of the ROC area without 0.5", false, excludes_half(c.roc));
  levels.note("as published: ratings, Student's t over procedures", false, below(c.pooled));
}

void note_ratings(NullLevels& levels, const drilling::Validity& v) {
  using Metric = drilling::MetricValidity;
  levels.note("any metric: R over participants' means after Holm", true,
              any_metric(v, [](const Metric& m) { return below(m.relation_holm); }));
  levels.note("any metric: Spearman's rho after Holm", false,
              any_metric(v, [](const Metric& m) { return below(m.ranks_holm); }));
  for (const Metric& m : v.metrics) {
    levels.note("one metric: R over participants' means, not adjusted", false,
                below(m.relation.means));
    levels.note("one metric: Spearman's rho, not adjusted", false, below(m.relation.ranks));
    levels.note("as published: one metric, R over procedures", false, below(m.relation.pooled));
  }
  if (const auto& fit = v.combined.fit) {
    levels.note("all metrics: squared error lower for participants left out (no test)", false,
                fit->gain > 0.0);
    levels.note("all metrics: R above 0 for participants left out (no test)", false,
                fit->validated.r && *fit->validated.r > 0.0);
    levels.note("all metrics: R above 0.4 for participants left out (no test)", false,
                fit->validated.r && *fit->validated.r > 0.4);
    levels.note("all metrics: R above 0.5 on the fitted data (no test)", false,
                fit->resubstitution.r && *fit->resubstitution.r > 0.5);
  }
}

NullLevels relabelled(const RatedStudy& study, NullLabels labels, std::size_t number,
                      std::uint64_t seed) {
  RandomStream random(seed, fmt::format("null {} {}", name_of(labels), number));
  RatedStudy own = study;
  const bool groups = labels == NullLabels::kGroups;
  groups ? permute_groups(own, random) : permute_ratings(own, random);
  const auto v = drilling::validity(own.procedures, {}, own.ratings, own.plan);
  NullLevels levels;
  groups ? note_groups(levels, v) : note_ratings(levels, v);
  return levels;
}

NullLevels spreads_of(std::size_t number, std::uint64_t seed) {
  RandomStream random(seed, fmt::format("null spreads {}", number));
  drilling::ValueTable table;
  for (std::size_t person = 0; person < 15; ++person) {
    const bool expert = person < 4;
    const double level = (expert ? 0.9 : 0.3) * random.normal();
    for (const double procedure : {1.0, 2.0}) {
      table.rows.push_back({3.0 + level + 0.1 * random.normal(), person, "", expert, procedure});
    }
  }
  const auto c = drilling::contrast(table, drilling::Expected::kEither);
  NullLevels levels;
  levels.note("ratings: Welch's t over participants' means", true, below(c.means));
  levels.note("ratings: mixed model", false, below(c.mixed_p));
  levels.note("as published: ratings, Student's t over procedures", false, below(c.pooled));
  return levels;
}

constexpr std::uint32_t kVoxels = 60;
constexpr std::size_t kPeople = 14;

/// Two procedures of everybody; a person has a liking for each voxel, which both procedures share.
NullLevels regions_of(std::size_t number, std::uint64_t seed) {
  RandomStream random(seed, fmt::format("null regions {}", number));
  std::vector<std::vector<std::uint32_t>> voxels(2 * kPeople);
  std::vector<drilling::RemovedRegion> regions;
  for (std::size_t person = 0; person < kPeople; ++person) {
    const double reach = 0.3 * random.normal();
    for (std::uint32_t v = 0; v < kVoxels; ++v) {
      const double liking = reach + random.normal();
      for (const std::size_t procedure : {2 * person, 2 * person + 1}) {
        if (liking + 0.3 * random.normal() > 0.0) {
          voxels[procedure].push_back(v);
        }
      }
    }
    for (const std::size_t procedure : {2 * person, 2 * person + 1}) {
      regions.push_back({fmt::format("S{:02}", person), person % 2 == 0, voxels[procedure]});
    }
  }
  const auto scores = drilling::region_log_ratios(regions, drilling::RegionTraining::kLeavePairOut);
  drilling::ValueTable table;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    table.rows.push_back(
        {scores[i], i / 2, "", regions[i].expert, 1.0 + static_cast<double>(i % 2)});
  }
  const auto c = drilling::contrast(table, drilling::Expected::kHigher);
  const auto test = drilling::region_label_test(regions, number, 99);
  NullLevels levels;
  levels.note("region: permuted labels", true, test && test->p <= kAlpha);
  levels.note("region: mixed model", false, below(c.mixed_p));
  levels.note("region: Welch's t over participants' means", false, below(c.means));
  levels.note("as published: region, Student's t over procedures", false, below(c.pooled));
  return levels;
}

}  // namespace

RatedStudy read_rated_study(const std::filesystem::path& folder) {
  const auto table = analysis::CsvTable::load(folder / "metrics.csv");
  RatedStudy study;
  study.ratings = drilling::load_ratings(folder / "ratings.csv");
  const std::size_t first_metric = table.column("completed") + 1;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto text = [&](std::size_t column) { return std::string(table.text(row, column)); };
    drilling::ProcedureSummary p;
    p.session = text(table.column("session"));
    p.participant = text(table.column("participant"));
    p.group = text(table.column("group"));
    p.number = std::stoi(text(table.column("procedure")));
    for (std::size_t m = first_metric; m < table.columns().size(); ++m) {
      p.values.push_back(text(m).empty() ? std::nullopt : std::optional(std::stod(text(m))));
    }
    auto& groups = study.plan.groups;
    if (std::find(groups.begin(), groups.end(), p.group) == groups.end()) {
      groups.push_back(p.group);
      if (p.group != "novices") {
        study.plan.expert_groups.push_back(p.group);
      }
    }
    study.procedures.push_back(std::move(p));
  }
  return study;
}

const char* name_of(NullLabels labels) {
  return labels == NullLabels::kGroups ? "groups permuted over participants"
                                       : "ratings permuted over participants";
}

std::vector<NullLevel> null_validity(const RatedStudy& study, NullLabels labels,
                                     std::size_t replications, std::uint64_t seed, int threads) {
  return null_levels(replications, threads,
                     [&](std::size_t i) { return relabelled(study, labels, i, seed); });
}

std::vector<NullLevel> null_spreads(std::size_t replications, std::uint64_t seed, int threads) {
  return null_levels(replications, threads, [&](std::size_t i) { return spreads_of(i, seed); });
}

std::vector<NullLevel> null_regions(std::size_t replications, std::uint64_t seed, int threads) {
  return null_levels(replications, threads, [&](std::size_t i) { return regions_of(i, seed); });
}

}  // namespace haptrial::test
