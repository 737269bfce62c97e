#include "analysis/bone_drilling/metrics/near_structure.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace haptrial::analysis::drilling {
namespace {

std::optional<double> mean(const std::vector<NearRemoval>& removals, double within,
                           float NearRemoval::*value) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const NearRemoval& removal : removals) {
    if (removal.distance <= static_cast<float>(within)) {
      sum += static_cast<double>(removal.*value);
      ++count;
    }
  }
  if (count == 0) {
    return std::nullopt;
  }
  return sum / static_cast<double>(count);
}

struct BinValues {
  std::vector<double> all;
  std::map<std::string, std::vector<double>> by_participant;
};

ProfileBin bin_of(const BinValues& values, double low, double high) {
  ProfileBin bin;
  bin.low = low;
  bin.high = high;
  bin.removals = values.all.size();
  bin.participants = values.by_participant.size();
  if (values.all.empty()) {
    return bin;
  }
  bin.pooled = mean_interval(values.all);
  std::vector<double> means;
  for (const auto& [participant, own] : values.by_participant) {
    if (const auto m = moments(own)) {
      means.push_back(m->mean());
    }
  }
  bin.by_participant = mean_interval(means);
  return bin;
}

}  // namespace

std::size_t NearBins::count() const {
  if (!(width > 0.0 && reach >= width && std::isfinite(reach / width))) {
    throw std::invalid_argument("NearBins: the width must be above 0 and the reach at least it");
  }
  return static_cast<std::size_t>(std::llround(std::ceil(reach / width - 1e-9)));
}

std::optional<double> NearRemovals::mean_force(double within) const {
  return mean(removals, within, &NearRemoval::force);
}

std::optional<double> NearRemovals::mean_speed(double within) const {
  return mean(removals, within, &NearRemoval::speed);
}

NearRemovals near_removals(const Procedure& procedure, const std::string& structure,
                           const bone::DistanceField& field, double reach) {
  NearRemovals near;
  near.structure = structure;
  for (const Removal& removal : procedure.removals) {
    const std::optional<double> distance = field.at(removal.voxel);
    if (distance && *distance <= reach) {
      near.removals.push_back({static_cast<float>(*distance), static_cast<float>(removal.force),
                               static_cast<float>(removal.speed)});
    }
  }
  return near;
}

std::vector<ProfileBin> near_profile(std::span<const NearCase> group, NearQuantity quantity,
                                     const NearBins& bins) {
  std::vector<BinValues> values(bins.count());
  for (const NearCase& one : group) {
    for (const NearRemoval& removal : one.removals->removals) {
      // A distance is a float: one just below an edge belongs to the edge.
      const double place = static_cast<double>(removal.distance) / bins.width * (1.0 + 1e-6);
      const auto bin = static_cast<std::size_t>(place);
      if (bin < values.size()) {
        const double value =
            static_cast<double>(quantity == NearQuantity::kForce ? removal.force : removal.speed);
        values[bin].all.push_back(value);
        values[bin].by_participant[one.participant].push_back(value);
      }
    }
  }
  std::vector<ProfileBin> profile;
  for (std::size_t bin = 0; bin < values.size(); ++bin) {
    const double low = bins.width * static_cast<double>(bin);
    profile.push_back(bin_of(values[bin], low, std::min(low + bins.width, bins.reach)));
  }
  return profile;
}

}  // namespace haptrial::analysis::drilling
