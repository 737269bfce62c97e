#include "core/bone/nerve/nerve_distances.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "core/base/nearest.h"

namespace haptrial::nerve {
namespace {

constexpr double kMm = 1e3;
constexpr double kMostVoxels = 240.0;  // that a field of distances reaches

std::string name_of(const bone::BoneModel& model) {
  return model.name.empty() ? "the bone" : model.name;
}

/// Which labels a structure's voxels have. @throws InputError
std::vector<bool> labels_of(const bone::BoneModel& model, const std::string& structure) {
  std::vector<bool> there(model.structures.size(), false);
  for (const std::uint8_t label : model.labels) {
    there[label] = true;
  }
  std::vector<bool> labels(model.structures.size(), false);
  std::vector<std::string> known;
  bool found = false;
  for (std::size_t label = 1; label < there.size(); ++label) {
    if (there[label]) {
      known.push_back(model.structures[label].name);
      labels[label] = model.structures[label].name == structure;
      found = found || labels[label];
    }
  }
  if (!found) {
    const std::string hint = did_you_mean(structure, known);
    throw InputError(
        fmt::format("nerve_monitor.nerves names \"{}\", which {} does not have{} "
                    "allowed: {}",
                    structure, name_of(model), hint.empty() ? ";" : hint, fmt::join(known, ", ")));
  }
  return labels;
}

void check_curve(const bone::BoneModel& model, const WatchedNerve& nerve) {
  const geometry::VoxelGrid& grid = model.grid;
  const Eigen::Vector3d low = kMm * grid.centre(0, 0, 0);
  const Eigen::Vector3d high = kMm * grid.centre(grid.last());
  for (std::size_t i = 0; i < nerve.curve.size(); ++i) {
    const Eigen::Vector3d point = kMm * nerve.curve[i];
    if ((point.array() < low.array()).any() || (point.array() > high.array()).any()) {
      throw InputError(fmt::format(
          "nerve_monitor.curves: point {} of \"{}\", ({:g}, {:g}, {:g}) mm, lies outside {}; "
          "allowed: from ({:.1f}, {:.1f}, {:.1f}) to ({:.1f}, {:.1f}, {:.1f}) mm",
          i + 1, nerve.name, point.x(), point.y(), point.z(), name_of(model), low.x(), low.y(),
          low.z(), high.x(), high.y(), high.z()));
    }
  }
}

double to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                  const Eigen::Vector3d& b) noexcept {
  const Eigen::Vector3d way = b - a;
  const double square = way.squaredNorm();
  const double share = square > 0.0 ? std::clamp((p - a).dot(way) / square, 0.0, 1.0) : 0.0;
  return (p - a - share * way).norm();
}

float to_curve(const WatchedNerve& nerve, const Eigen::Vector3d& p_B) noexcept {
  double nearest = NerveDistances::kFar;
  for (std::size_t i = 1; i < nerve.curve.size(); ++i) {
    nearest = std::min(nearest, to_segment(p_B, nerve.curve[i - 1], nerve.curve[i]));
  }
  return static_cast<float>(nearest - nerve.radius);
}

}  // namespace

NerveDistances::NerveDistances(const bone::BoneModel& model,
                               const std::vector<WatchedNerve>& nerves)
    : low_(model.grid.centre(0, 0, 0)),
      high_(model.grid.centre(model.grid.last())),
      spacing_(model.grid.spacing),
      nerves_(nerves) {
  for (const WatchedNerve& nerve : nerves_) {
    fields_.emplace_back();
    if (!nerve.curve.empty()) {
      check_curve(model, nerve);
    } else {
      fields_.back().emplace(model, labels_of(model, nerve.name),
                             std::min(kReach, kMostVoxels * spacing_));
    }
  }
}

/// The nerve's surface is half a voxel before the centre of its outermost one. From outside of the
/// bone's volume the way into it comes on top.
float NerveDistances::to_structure(const bone::DistanceField& field,
                                   const Eigen::Vector3d& p_B) const noexcept {
  if (!p_B.allFinite()) {
    return kFar;
  }
  const Eigen::Vector3d inside = p_B.cwiseMax(low_).cwiseMin(high_);
  const double way = (p_B - inside).norm();
  const std::optional<double> distance = field.linear_at(inside);
  return distance && way + *distance <= kReach
             ? static_cast<float>(way + *distance - 0.5 * spacing_)
             : kFar;
}

NerveDistances::Distances NerveDistances::at(const Eigen::Vector3d& p_B) const noexcept {
  Distances distances;
  distances.fill(kFar);
  for (std::size_t i = 0; i < nerves_.size() && i < distances.size(); ++i) {
    distances[i] = fields_[i] ? to_structure(*fields_[i], p_B) : to_curve(nerves_[i], p_B);
  }
  return distances;
}

}  // namespace haptrial::nerve
