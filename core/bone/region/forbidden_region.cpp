#include "core/bone/region/forbidden_region.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/bone/data/anatomy.h"

namespace haptrial::bone {
namespace {

// The power of the norm of the balls' depths is so high that the deepest ball has nearly all of the
// force.
constexpr double kPower = 32.0;

}  // namespace

RegionMap::RegionMap(const RegionSetup& setup, const BoneModel& model, double largest) {
  for (const std::string& structure : setup.structures) {
    const std::uint8_t label = label_named(model, structure, "forbidden");
    if (std::count(labels_.begin(), labels_.end(), label) == 0) {
      labels_.push_back(label);
      depths_.emplace_back(model, label, largest + setup.margin);
    }
  }
}

ForbiddenRegion::ForbiddenRegion(const RegionSetup& setup, std::shared_ptr<const RegionMap> map)
    : margin_(setup.margin),
      spring_(setup.spring()),
      most_(setup.most_force()),
      map_(std::move(map)),
      depths_(map_->size(), 0.0),
      felt_(map_->size(), false) {}

void ForbiddenRegion::forget() noexcept {
  std::fill(depths_.begin(), depths_.end(), 0.0);
  std::fill(felt_.begin(), felt_.end(), false);
}

ForbiddenRegion::Depth ForbiddenRegion::depth(std::size_t structure,
                                              std::span<const BurrShape::Ball> balls,
                                              const Eigen::Vector3d& tip_B,
                                              const Eigen::Vector3d& axis_B) const noexcept {
  const auto depth_of = [&](const BurrShape::Ball& ball, SurfaceDepth::LocalTissue& here) {
    const bool known = map_->depth(structure).at(tip_B + ball.z * axis_B, here);
    return known ? std::max(0.0, ball.radius + margin_ - here.distance) : 0.0;
  };
  Depth found;
  SurfaceDepth::LocalTissue here{};
  for (const BurrShape::Ball& ball : balls) {
    found.deepest = std::max(found.deepest, depth_of(ball, here));
  }
  if (found.deepest <= 0.0) {
    return found;
  }
  double sum = 0.0;
  for (const BurrShape::Ball& ball : balls) {
    const double share = depth_of(ball, here) / found.deepest;
    const double weight = std::pow(share, kPower - 1.0);
    sum += weight * share;
    found.way_out += weight * here.gradient;
  }
  const double ratio = std::pow(sum, 1.0 / kPower);
  found.joint = ratio * found.deepest;
  found.way_out *= ratio / sum;
  return found;
}

Eigen::Vector3d ForbiddenRegion::tick(std::span<const BurrShape::Ball> balls,
                                      const Eigen::Vector3d& tip_B,
                                      const Eigen::Vector3d& axis_B) noexcept {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (std::size_t n = 0; n < depths_.size(); ++n) {
    const Depth found = depth(n, balls, tip_B, axis_B);
    depths_[n] = found.deepest;
    felt_[n] = felt_[n] || found.deepest <= 0.0;
    if (felt_[n]) {
      force += std::min(spring_ * found.joint, most_) * found.way_out;
    }
  }
  return force;
}

double ForbiddenRegion::energy(std::span<const BurrShape::Ball> balls, const Eigen::Vector3d& tip_B,
                               const Eigen::Vector3d& axis_B) const noexcept {
  double sum = 0.0;
  const double bend = spring_ > 0.0 ? most_ / spring_ : 0.0;  // where the force grows no more [m]
  for (std::size_t n = 0; n < depths_.size(); ++n) {
    const double joint = depth(n, balls, tip_B, axis_B).joint;
    const double bent = std::min(joint, bend);
    sum += 0.5 * spring_ * bent * bent + most_ * (joint - bent);
  }
  return sum;
}

}  // namespace haptrial::bone

namespace haptrial::record {

template <>
const Table<CrossingRow>& table_of<CrossingRow>() {
  using R = CrossingRow;
  using T = Table<R>;
  static const T table(
      {"crossings",
       "one row for each way of a burr through a forbidden region, when it ended",
       53,
       RowsOf::kTick,
       {"sequence"}},
      {T::column("sequence", &R::sequence, "1", "last tick in the region"),
       T::column("begin", &R::begin, "1", "first tick in it"),
       T::column("label", &R::label, "1", "of the structure, in /structures"),
       T::column("given", &R::given, "1",
                 "1 where the participant felt or heard the region; else only recorded"),
       T::column("depth", &R::depth, "m", "greatest, of the burr's surface in the margin")});
  return table;
}

}  // namespace haptrial::record

namespace haptrial::bone {

CrossingWatch::CrossingWatch(std::vector<std::uint8_t> labels) : crossings_(labels.size()) {
  for (std::size_t n = 0; n < labels.size(); ++n) {
    crossings_[n].row.label = labels[n];
  }
}

bool CrossingWatch::after_tick(std::uint64_t sequence, bool given, std::span<const double> depths,
                               realtime::BlockLog<record::CrossingRow>& log) noexcept {
  bool entered = false;
  for (std::size_t n = 0; n < crossings_.size(); ++n) {
    Crossing& crossing = crossings_[n];
    if (depths[n] > 0.0 && !crossing.on) {
      crossing.on = entered = true;
      crossing.row.begin = sequence;
      crossing.row.given = given;
      crossing.row.depth = 0.0;
    }
    if (depths[n] > 0.0) {
      crossing.row.sequence = sequence;
      crossing.row.depth = std::max(crossing.row.depth, depths[n]);
    } else if (crossing.on) {
      log.push(crossing.row);
      crossing.on = false;
    }
  }
  return entered;
}

void CrossingWatch::end(realtime::BlockLog<record::CrossingRow>& log) noexcept {
  for (Crossing& crossing : crossings_) {
    if (crossing.on) {
      log.push(crossing.row);
      crossing.on = false;
    }
  }
}

}  // namespace haptrial::bone
