#include "analysis/bone_drilling/feedback/safe_values.h"

#include <algorithm>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "core/bone/model/distance_field.h"

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

std::vector<NearestRemoval> nearest_structures(const Procedure& procedure,
                                               std::span<const std::string> names,
                                               StudyBones& bones, double reach) {
  constexpr double kMostVoxels = 250.0;  // that a distance field reaches
  const bone::BoneModel& bone = *procedure.bone;
  std::vector<std::shared_ptr<const bone::DistanceField>> fields;
  for (const std::string& name : names) {
    fields.push_back(bones.field(procedure.bone, bone::labels_named(bone, name),
                                 std::min(reach, kMostVoxels * bone.grid.spacing)));
  }
  std::vector<NearestRemoval> nearest;
  nearest.reserve(procedure.removals.size());
  for (const Removal& removal : procedure.removals) {
    const bone::NearestStructure found = bone::nearest_structure(fields, removal.voxel);
    nearest.push_back(
        {found.structure,
         {found.distance, static_cast<float>(removal.force), static_cast<float>(removal.speed)}});
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
