#include "analysis/bone_drilling/metrics/region_likelihood.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "core/base/random.h"

namespace haptrial::analysis::drilling {
namespace {

using Counts = std::vector<std::uint16_t>;  // by place: how many procedures removed the voxel

struct Person {
  bool expert{false};
  int procedures{0};
  Counts counts;
};

/// Counts of a group in training: how many procedures, and how many of them removed a voxel.
struct Group {
  int procedures{0};
  Counts counts;

  void add(const Person& person) { change(person, 1); }
  void leave_out(const Person& person) { change(person, -1); }

 private:
  void change(const Person& person, int sign) {
    procedures += sign * person.procedures;
    for (std::size_t v = 0; v < counts.size(); ++v) {
      counts[v] = static_cast<std::uint16_t>(counts[v] + sign * person.counts[v]);
    }
  }
};

/// log p and log (1 - p) by the number of procedures that removed a voxel.
struct Logs {
  std::vector<double> removed, left;

  Logs(int procedures, double smoothing) {
    for (int k = 0; k <= procedures; ++k) {
      const double all = procedures + 2.0 * smoothing;
      removed.push_back(std::log((k + smoothing) / all));
      left.push_back(std::log((procedures - k + smoothing) / all));
    }
  }
};

class Regions {
 public:
  explicit Regions(std::span<const RemovedRegion> regions) {
    std::vector<std::uint32_t> voxels;  // that anyone removed; all others say nothing
    for (const RemovedRegion& region : regions) {
      voxels.insert(voxels.end(), region.voxels.begin(), region.voxels.end());
    }
    std::sort(voxels.begin(), voxels.end());
    voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
    experts_.counts.assign(voxels.size(), 0);
    novices_.counts.assign(voxels.size(), 0);
    for (const RemovedRegion& region : regions) {
      places_.push_back(places_of(voxels, region.voxels));
      add(region);
    }
    fill_groups();
  }

  /// Whether each participant is an expert, in the order of their names.
  std::vector<bool> labels() const {
    std::vector<bool> experts;
    for (const auto& [name, person] : people_) {
      experts.push_back(person.expert);
    }
    return experts;
  }
  void relabel(const std::vector<bool>& experts) {
    std::size_t at = 0;
    for (auto& [name, person] : people_) {
      person.expert = experts[at++];
    }
    fill_groups();
  }

  /// Mean over participants of their mean scores, experts minus novices.
  std::optional<double> gap(std::span<const RemovedRegion> regions,
                            const std::vector<std::optional<double>>& scores) const {
    std::map<std::string, double> sums;
    for (std::size_t r = 0; r < regions.size(); ++r) {
      if (!scores[r]) {
        return std::nullopt;
      }
      sums[regions[r].participant] += *scores[r];
    }
    double means[2] = {0.0, 0.0};
    int counts[2] = {0, 0};
    for (const auto& [name, person] : people_) {
      means[person.expert] += sums[name] / person.procedures;
      ++counts[person.expert];
    }
    if (counts[0] == 0 || counts[1] == 0) {
      return std::nullopt;
    }
    return means[1] / counts[1] - means[0] / counts[0];
  }

  std::vector<std::optional<double>> score(std::span<const RemovedRegion> regions,
                                           RegionTraining training, RegionTerms terms) {
    std::vector<std::optional<double>> scores(regions.size());
    if (training == RegionTraining::kResubstitution) {
      add_scores(regions, nullptr, terms, scores);
      return scores;
    }
    for (const auto& [name, person] : people_) {
      group(person.expert).leave_out(person);
      if (training == RegionTraining::kLeaveSubjectOut) {
        add_scores(regions, &name, terms, scores);
      } else {
        leave_each_other_out(regions, name, person, terms, scores);
      }
      group(person.expert).add(person);
    }
    return scores;
  }

 private:
  static std::vector<std::uint32_t> places_of(const std::vector<std::uint32_t>& voxels,
                                              std::span<const std::uint32_t> region) {
    std::vector<std::uint32_t> places;
    auto at = voxels.begin();
    for (const std::uint32_t voxel : region) {
      at = std::lower_bound(at, voxels.end(), voxel);
      if (at == voxels.end() || *at != voxel ||
          (!places.empty() && voxels[places.back()] >= voxel)) {
        throw std::invalid_argument("region likelihood: voxels must be ascending, each once");
      }
      places.push_back(static_cast<std::uint32_t>(at - voxels.begin()));
    }
    return places;
  }

  void add(const RemovedRegion& region) {
    const auto [at, fresh] = people_.try_emplace(region.participant);
    Person& person = at->second;
    if (fresh) {
      person.expert = region.expert;
      person.counts.assign(experts_.counts.size(), 0);
    } else if (person.expert != region.expert) {
      throw std::invalid_argument("region likelihood: a participant is in both groups");
    }
    ++person.procedures;
    for (const std::uint32_t place : places_.back()) {
      ++person.counts[place];
    }
  }

  void fill_groups() {
    for (Group* group : {&experts_, &novices_}) {
      group->procedures = 0;
      std::fill(group->counts.begin(), group->counts.end(), std::uint16_t{0});
    }
    for (const auto& [name, person] : people_) {
      group(person.expert).add(person);
    }
  }

  Group& group(bool expert) { return expert ? experts_ : novices_; }

  void leave_each_other_out(std::span<const RemovedRegion> regions, const std::string& name,
                            const Person& person, RegionTerms terms,
                            std::vector<std::optional<double>>& scores) {
    std::vector<std::optional<double>> sums(regions.size());
    int others = 0;
    for (const auto& [other_name, other] : people_) {
      if (other.expert == person.expert) {
        continue;
      }
      group(other.expert).leave_out(other);
      std::vector<std::optional<double>> own(regions.size());
      add_scores(regions, &name, terms, own);
      group(other.expert).add(other);
      ++others;
      for (std::size_t r = 0; r < regions.size(); ++r) {
        if (own[r]) {
          sums[r] = sums[r].value_or(0.0) + *own[r];
        } else if (regions[r].participant == name) {
          return;  // a group is left without procedures
        }
      }
    }
    for (std::size_t r = 0; r < regions.size(); ++r) {
      if (sums[r]) {
        scores[r] = *sums[r] / others;
      }
    }
  }

  /// Scores the regions of one participant, or of all, from what the groups hold now.
  void add_scores(std::span<const RemovedRegion> regions, const std::string* only,
                  RegionTerms terms, std::vector<std::optional<double>>& scores) const {
    if (experts_.procedures == 0 || novices_.procedures == 0) {
      return;
    }
    const double mean = 0.5 * (experts_.procedures + novices_.procedures);
    const Logs e(experts_.procedures, experts_.procedures / mean);
    const Logs n(novices_.procedures, novices_.procedures / mean);
    double all_left = 0.0;
    if (terms == RegionTerms::kAll) {
      for (std::size_t v = 0; v < experts_.counts.size(); ++v) {
        all_left += e.left[experts_.counts[v]] - n.left[novices_.counts[v]];
      }
    }
    for (std::size_t r = 0; r < regions.size(); ++r) {
      if (only != nullptr && regions[r].participant != *only) {
        continue;
      }
      double sum = all_left;
      for (const std::uint32_t place : places_[r]) {
        const std::size_t ke = experts_.counts[place];
        const std::size_t kn = novices_.counts[place];
        sum += e.removed[ke] - n.removed[kn];
        if (terms == RegionTerms::kAll) {
          sum -= e.left[ke] - n.left[kn];
        }
      }
      scores[r] = sum;
    }
  }

  std::map<std::string, Person> people_;
  std::vector<std::vector<std::uint32_t>> places_;  // (regions) in counts
  Group experts_, novices_;
};

}  // namespace

std::vector<std::optional<double>> region_log_ratios(std::span<const RemovedRegion> regions,
                                                     RegionTraining training, RegionTerms terms) {
  return Regions(regions).score(regions, training, terms);
}

std::vector<RegionScores> region_scores(std::span<const RemovedRegion> regions) {
  Regions all(regions);
  std::vector<RegionScores> scores(regions.size());
  const auto fill = [&](RegionTraining training, RegionTerms terms,
                        std::optional<double> RegionScores::*field) {
    const auto values = all.score(regions, training, terms);
    for (std::size_t r = 0; r < regions.size(); ++r) {
      scores[r].*field = values[r];
    }
  };
  using enum RegionTraining;
  using enum RegionTerms;
  fill(kLeavePairOut, RegionTerms::kAll, &RegionScores::score);
  fill(kLeaveSubjectOut, RegionTerms::kAll, &RegionScores::leave_subject_out);
  fill(kResubstitution, RegionTerms::kAll, &RegionScores::resubstitution);
  fill(kLeavePairOut, kRemoved, &RegionScores::removed_only);
  fill(kLeaveSubjectOut, kRemoved, &RegionScores::removed_leave_subject_out);
  fill(kResubstitution, kRemoved, &RegionScores::removed_resubstitution);
  return scores;
}

std::optional<RegionLabelTest> region_label_test(std::span<const RemovedRegion> regions,
                                                 std::uint64_t seed, int rounds,
                                                 RegionTerms terms) {
  if (rounds < 1) {
    throw std::invalid_argument("region_label_test: at least one round is needed");
  }
  Regions all(regions);
  const auto gap = [&] {
    return all.gap(regions, all.score(regions, RegionTraining::kLeavePairOut, terms));
  };
  const std::optional<double> found = gap();
  if (!found) {
    return std::nullopt;
  }
  RandomStream random(seed, "labels of participants");
  std::vector<bool> labels = all.labels();
  int as_large = 0;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t left = labels.size(); left > 1; --left) {
      const auto other = static_cast<std::size_t>(random.below(left));
      const bool held = labels[left - 1];
      labels[left - 1] = labels[other];
      labels[other] = held;
    }
    all.relabel(labels);
    const std::optional<double> dealt = gap();
    as_large += dealt && *dealt >= *found - 1e-9 * std::abs(*found) ? 1 : 0;
  }
  return RegionLabelTest{*found, (1.0 + as_large) / (1.0 + rounds), rounds};
}

}  // namespace haptrial::analysis::drilling
