#include "analysis/bone_drilling/feedback/safe_values.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace haptrial::analysis::drilling {
namespace {

using Weighted = std::pair<double, double>;  // value and weight

/// @param values  at least one, ascending
double weighted_quantile(const std::vector<Weighted>& values, double fraction) {
  double all = 0.0;
  for (const Weighted& value : values) {
    all += value.second;
  }
  constexpr double kRounding = 1e-9;  // of the sum of weights
  double sum = 0.0;
  for (const auto& [value, weight] : values) {
    sum += weight;
    if (sum >= (fraction - kRounding) * all) {
      return value;
    }
  }
  return values.back().first;
}

SafeRange range_of(std::vector<Weighted> values, const SafeOptions& options) {
  std::sort(values.begin(), values.end());
  return {weighted_quantile(values, options.low), weighted_quantile(values, 0.5),
          weighted_quantile(values, options.high)};
}

using ByParticipant = std::map<std::string, std::vector<NearRemoval>>;

std::vector<Weighted> weighted(const ByParticipant& removals, float NearRemoval::*value) {
  std::vector<Weighted> values;
  for (const auto& [participant, own] : removals) {
    for (const NearRemoval& removal : own) {
      values.emplace_back(static_cast<double>(removal.*value),
                          1.0 / static_cast<double>(own.size()));
    }
  }
  return values;
}

std::size_t bin_of(double distance, const NearBins& bins) {
  return static_cast<std::size_t>(std::max(0.0, distance / bins.width));
}

SafeBin bin_from(const ByParticipant& removals, std::size_t number, const SafeOptions& options) {
  SafeBin bin;
  bin.low = options.bins.width * static_cast<double>(number);
  bin.high = bin.low + options.bins.width;
  bin.participants = removals.size();
  for (const auto& [participant, own] : removals) {
    bin.removals += own.size();
  }
  if (bin.removals >= std::max<std::size_t>(options.fewest, 1)) {
    bin.force = range_of(weighted(removals, &NearRemoval::force), options);
    bin.speed = range_of(weighted(removals, &NearRemoval::speed), options);
  }
  return bin;
}

}  // namespace

std::vector<std::string> vital_structures(const bone::BoneModel& bone) {
  std::vector<bool> there(256, false);
  for (const std::uint8_t label : bone.labels) {
    there[label] = true;
  }
  std::vector<std::string> names;
  for (std::size_t label = 1; label < bone.structures.size(); ++label) {
    const bone::Structure& structure = bone.structures[label];
    if (structure.vital && there[label] &&
        std::find(names.begin(), names.end(), structure.name) == names.end()) {
      names.push_back(structure.name);
    }
  }
  return names;
}

std::vector<NearestRemoval> nearest_structures(const Procedure& procedure,
                                               std::span<const std::string> names,
                                               StudyBones& bones, double reach) {
  constexpr double kMostVoxels = 250.0;  // that a distance field reaches
  const bone::BoneModel& bone = *procedure.bone;
  std::vector<NearestRemoval> nearest(procedure.removals.size());
  for (std::size_t name = 0; name < names.size(); ++name) {
    std::vector<bool> labels(bone.structures.size(), false);
    for (std::size_t label = 1; label < labels.size(); ++label) {
      labels[label] = bone.structures[label].name == names[name];
    }
    const auto field =
        bones.field(procedure.bone, labels, std::min(reach, kMostVoxels * bone.grid.spacing));
    for (std::size_t n = 0; n < nearest.size(); ++n) {
      const auto distance = field->at(procedure.removals[n].voxel);
      const bool first = nearest[n].structure < 0;
      if (distance && (first || static_cast<float>(*distance) < nearest[n].at.distance)) {
        nearest[n].structure = static_cast<std::int32_t>(name);
        nearest[n].at.distance = static_cast<float>(*distance);
      }
    }
  }
  for (std::size_t n = 0; n < nearest.size(); ++n) {
    nearest[n].at.force = static_cast<float>(procedure.removals[n].force);
    nearest[n].at.speed = static_cast<float>(procedure.removals[n].speed);
  }
  return nearest;
}

const SafeBin* SafeProfile::at(double distance) const noexcept {
  if (bins.empty() || distance < 0.0) {
    return nullptr;
  }
  const auto number = static_cast<std::size_t>(distance / (bins.front().high - bins.front().low));
  return number < bins.size() ? &bins[number] : nullptr;
}

std::vector<SafeProfile> learn_safe_values(std::span<const SafeCase> experts,
                                           std::span<const std::string> names,
                                           const SafeOptions& options) {
  if (!(options.low >= 0.0 && options.low < options.high && options.high < 1.0)) {
    throw std::invalid_argument("SafeOptions: low and high are no range of shares");
  }
  const std::size_t bins = options.bins.count();
  std::vector<std::vector<ByParticipant>> found(names.size(), std::vector<ByParticipant>(bins));
  for (const SafeCase& expert : experts) {
    for (const NearestRemoval& removal : expert.removals) {
      const std::size_t bin = bin_of(static_cast<double>(removal.at.distance), options.bins);
      if (removal.structure >= 0 && bin < bins) {
        found.at(static_cast<std::size_t>(removal.structure))[bin][expert.participant].push_back(
            removal.at);
      }
    }
  }
  std::vector<SafeProfile> profiles;
  for (std::size_t name = 0; name < names.size(); ++name) {
    SafeProfile profile{names[name], {}};
    for (std::size_t bin = 0; bin < bins; ++bin) {
      profile.bins.push_back(bin_from(found[name][bin], bin, options));
    }
    profiles.push_back(std::move(profile));
  }
  return profiles;
}

}  // namespace haptrial::analysis::drilling
