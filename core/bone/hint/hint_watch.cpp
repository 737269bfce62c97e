#include "core/bone/hint/hint_watch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/error.h"

namespace haptrial::hint {
namespace {

constexpr double kFar = 1.0;           // beyond any reach [m]
constexpr double kMostVoxels = 250.0;  // that a distance field reaches

std::uint64_t ticks_of(double seconds, double rate) {
  return static_cast<std::uint64_t>(std::max(1.0, std::round(seconds * rate)));
}

}  // namespace

HintMap::HintMap(const HintSetup& setup, const bone::BoneModel& bone) {
  const double reach = std::min(setup.reach, kMostVoxels * bone.grid.spacing);
  for (const std::string& name : bone::vital_structures(bone)) {
    const SafeStructure* known = setup.limits.of(name);
    structures_.push_back(known != nullptr ? *known : SafeStructure{name, {}});
    fields_.push_back(
        std::make_shared<const bone::DistanceField>(bone, bone::labels_named(bone, name), reach));
  }
  if (setup.needs_limits() && judged().empty()) {
    std::vector<std::string_view> known;
    for (const SafeStructure& each : setup.limits.structures) {
      known.push_back(each.name);
    }
    throw InputError(
        fmt::format("hints.file {} has safe values near {}, of which bone {} has none; allowed: "
                    "values near one "
                    "of its structures: {}",
                    setup.file, fmt::join(known, ", "), bone.name,
                    fmt::join(bone::vital_structures(bone), ", ")));
  }
}

std::vector<std::string> HintMap::judged() const {
  std::vector<std::string> names;
  for (const SafeStructure& each : structures_) {
    if (!each.intervals.empty()) {
      names.push_back(each.name);
    }
  }
  return names;
}

HintMap::Place HintMap::at(const bone::Voxel& voxel) const noexcept {
  const bone::NearestStructure nearest = bone::nearest_structure(fields_, voxel);
  if (nearest.structure < 0) {
    return {};
  }
  const auto distance = static_cast<double>(nearest.distance);
  return {nearest.structure, distance,
          structures_[static_cast<std::size_t>(nearest.structure)].at(distance)};
}

std::string HintMap::name(std::int32_t structure) const {
  return structure < 0 ? "" : structures_[static_cast<std::size_t>(structure)].name;
}

HintWatch::HintWatch(const HintSetup& setup, std::shared_ptr<const HintMap> map,
                     std::shared_ptr<const bone::BoneModel> bone, const Eigen::Isometry3d& pose_WB,
                     double rate)
    : setup_(setup),
      map_(std::move(map)),
      sight_(std::move(bone), pose_WB),
      within_(ticks_of(setup.within, rate)),
      holds_(ticks_of(setup.holds, rate)) {}

void HintWatch::tick(const HintTick& tick, std::span<const HintVoxel> voxels, bool shown) {
  last_ = tick.sequence;
  sight_.look_from(tick.eye);
  const auto each = [&voxels](HintVoxel::What what, auto&& f) {
    for (const HintVoxel& voxel : voxels) {
      if (voxel.what == what) {
        f(voxel);
      }
    }
  };
  each(HintVoxel::What::kCrumb, [this](const HintVoxel& v) { sight_.crumble(v.voxel); });
  each(HintVoxel::What::kRemoved, [&](const HintVoxel& v) { removal(tick, v, shown); });
  each(HintVoxel::What::kCut, [this](const HintVoxel& v) { sight_.cut(v.voxel); });
  for (const HintKind kind : kAllHintKinds) {
    RunningHint& running = of(kind);
    if (running.on && last_ >= running.faults.back() + holds_) {
      end(running);
    }
  }
}

void HintWatch::removal(const HintTick& tick, const HintVoxel& voxel, bool shown) {
  const bool seen = sight_.remove(voxel.voxel, tick.burr);
  Fault fault{voxel, map_->at(voxel.voxel), 0.0};
  if (const SafeInterval* safe = fault.place.safe) {
    // The values are in single precision, as the analysis has them.
    const auto force = static_cast<double>(static_cast<float>(voxel.force));
    const auto speed = static_cast<double>(static_cast<float>(voxel.speed));
    fault.excess = force - safe->force;
    note(HintKind::kForce, force > safe->force, fault, shown);
    fault.excess = speed - safe->speed;
    note(HintKind::kSpeed, speed > safe->speed, fault, shown);
  }
  // The nearer to a structure, the worse.
  fault.excess = fault.place.structure >= 0 ? -fault.place.distance : -kFar;
  note(HintKind::kHidden, !seen, fault, shown);
}

void HintWatch::note(HintKind kind, bool faulty, const Fault& fault, bool shown) {
  if (!faulty || !setup_.gives(kind)) {
    return;
  }
  RunningHint& running = of(kind);
  const bool enough = running.come(fault.voxel.sequence, setup_.fewest, within_);
  if (!running.on && !enough) {
    return;
  }
  const bool begins = !std::exchange(running.on, true);
  if (begins) {
    running.row = {};
    running.row.begin = fault.voxel.sequence;
    running.row.kind = kind;
    running.row.shown = shown;
    running.row.removals = setup_.fewest - 1;
    structure_ = kind != HintKind::kHidden ? fault.place.structure : structure_;
  }
  ++running.row.removals;
  if (begins || fault.excess > running.excess) {
    keep_worst(running, fault);
  }
}

/// @returns whether `fewest` came within `within` ticks.
bool HintWatch::RunningHint::come(std::uint64_t sequence, int fewest, std::uint64_t within) {
  const auto needed = static_cast<std::size_t>(fewest);
  if (faults.size() >= needed) {
    faults.erase(faults.begin());
  }
  faults.push_back(sequence);
  return faults.size() == needed && sequence - faults.front() <= within;
}

void HintWatch::keep_worst(RunningHint& running, const Fault& fault) const {
  const HintMap::Place& place = fault.place;
  running.excess = fault.excess;
  running.row.structure = map_->name(place.structure);
  running.row.distance = place.distance;
  running.row.force = fault.voxel.force;
  running.row.speed = fault.voxel.speed;
  running.row.limit_force = place.safe != nullptr ? place.safe->force : 0.0;
  running.row.limit_speed = place.safe != nullptr ? place.safe->speed : 0.0;
}

void HintWatch::end(RunningHint& running) {
  running.on = false;
  running.faults.clear();
  running.row.sequence = last_;
  rows_.push_back(std::move(running.row));
}

void HintWatch::end() {
  for (const HintKind kind : kAllHintKinds) {
    RunningHint& running = of(kind);
    if (running.on) {
      end(running);
    }
    running.faults.clear();
  }
}

std::uint8_t HintWatch::on() const noexcept {
  std::uint8_t bits = 0;
  for (const HintKind kind : kAllHintKinds) {
    bits = static_cast<std::uint8_t>(bits |
                                     (running_[static_cast<std::size_t>(kind)].on ? bit(kind) : 0));
  }
  return bits;
}

}  // namespace haptrial::hint
