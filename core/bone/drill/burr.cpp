#include "core/bone/drill/burr.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/definition/schema.h"

namespace haptrial::bone {
namespace {

constexpr Bounds kDiameter{0.0005, 0.03};
constexpr double kShortest = 1e-4;  // length, and neck of a pear [m]
constexpr double kMostSamples = 1e6;

/// Distance between samples for a given number of them.
double spacing_of(const BurrShape& shape, double samples) {
  return shape.dimensions().diameter * std::cbrt(shape.fullness() / samples);
}

void check(const BurrParameters& p, const BurrShape& shape) {
  const auto need = [](bool good, const char* name, double value, const char* allowed) {
    if (!good) {
      throw std::invalid_argument(fmt::format("Burr: {} is {}; allowed: {}", name, value, allowed));
    }
  };
  need(p.diameter >= kDiameter.low && p.diameter <= kDiameter.high, "diameter", p.diameter,
       "from 0.0005 to 0.03 [m]");
  need(p.sample_spacing >= spacing_of(shape, kMostSamples) && p.sample_spacing <= 0.5 * p.diameter,
       "sample_spacing", p.sample_spacing, "at most half of the diameter, and 1e6 samples [m]");
  need(p.removal_rate >= 0.0 && p.removal_rate < 1e6, "removal_rate", p.removal_rate,
       "from 0 to 1e6 [1/(N·s)]");
  need(p.falloff >= 0.0 && p.falloff < 1e6, "falloff", p.falloff, "from 0 to 1e6 [1/(N·s·rad)]");
  need(p.tangential_gain >= 0.0 && std::isfinite(p.tangential_gain), "tangential_gain",
       p.tangential_gain, "at least 0 [N/m^4]");
  need(p.wear_volume >= 0.0 && std::isfinite(p.wear_volume), "wear_volume", p.wear_volume,
       "at least 0 [m^3]");
}

/// Evenly spread places in a unit cube: the additive recurrence of Roberts (2018).
class Places {
 public:
  Eigen::Vector3d next() {
    for (int axis = 0; axis < 3; ++axis) {
      at_[axis] += kStep[static_cast<std::size_t>(axis)];
      at_[axis] -= std::floor(at_[axis]);
    }
    return at_;
  }

 private:
  // Powers of 1 / 1.2207440846057596, the root of x^4 = x + 1.
  static constexpr std::array<double, 3> kStep{0.8191725133961645, 0.6710436067037893,
                                               0.5497004779019703};
  Eigen::Vector3d at_{0.5, 0.5, 0.5};
};

/// Half of the samples, in units of the reach, row by row: of a point-symmetric shape those in
/// cells of the upper half, else those of y > 0.
std::vector<Eigen::Vector3d> half_of_samples(const BurrShape& shape, double cell) {
  const double reach = shape.reach();
  const auto cells = [&](double wide) { return static_cast<int>(std::ceil(wide / reach / cell)); };
  const int across = cells(0.5 * shape.dimensions().diameter);
  const int along = cells(shape.half_length());
  const bool upper = shape.is_point_symmetric();
  std::vector<Eigen::Vector3d> samples;
  Places places;
  for (int k = upper ? 0 : -along; k < along; ++k) {
    for (int j = upper ? -across : 0; j < across; ++j) {
      for (int i = -across; i < across; ++i) {
        const Eigen::Vector3d at = cell * (Eigen::Vector3d(i, j, k) + places.next());
        const bool inside = shape.is_ball() ? at.squaredNorm() <= 1.0 && at.squaredNorm() > 0.0
                                            : shape.nearest(reach * at).distance <= 0.0;
        if (inside) {
          samples.push_back(at);
        }
      }
    }
  }
  return samples;
}

/// Mirror image of a sample in the other half.
Eigen::Vector3d image_of(const BurrShape& shape, const Eigen::Vector3d& at) {
  return shape.is_point_symmetric() ? Eigen::Vector3d(-at)
                                    : Eigen::Vector3d(-at.x(), -at.y(), at.z());
}

/// Direction in which a sample pushes: inwards. @param at  in units of the reach
Eigen::Vector3d inwards(const BurrShape& shape, const Eigen::Vector3d& at) {
  return shape.is_ball() ? Eigen::Vector3d(-at.normalized())
                         : Eigen::Vector3d(-shape.nearest(shape.reach() * at).normal);
}

constexpr std::size_t kFew = 16384;  // samples that are as fast without a tree

/// Cubes of the tree are 16, 8 and 4 cells of a sample wide.
constexpr std::array<int, 3> kWidths{16, 8, 4};

/// The cube of a level that a place is in, z first, as samples run.
std::array<int, 3> cube_of(const Eigen::Vector3d& at, double cell, std::size_t level) {
  const Eigen::Array3d place = (at.array() + 1.0) / (cell * kWidths[2]);
  const int halvings = static_cast<int>(kWidths.size() - 1 - level);
  return {static_cast<int>(place.z()) >> halvings, static_cast<int>(place.y()) >> halvings,
          static_cast<int>(place.x()) >> halvings};
}

/// Numbers of the cubes of all levels in one, the widest first; the last 3 bits are the leaf's.
std::uint64_t key_of(const Eigen::Vector3d& at, double cell) {
  constexpr int kBits = 12;  // of a number
  std::uint64_t key = 0;
  for (std::size_t level = 0; level < kWidths.size(); ++level) {
    for (const int n : cube_of(at, cell, level)) {
      const auto number = static_cast<std::uint64_t>(n);
      key = level == 0 ? key << kBits | number : key << 1 | (number & 1U);
    }
  }
  return key;
}

/// So that those of a cube lie together. @returns their keys
std::vector<std::uint64_t> sort_by_cell(std::vector<Eigen::Vector3d>& samples, double cell) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(samples.size());
  for (const Eigen::Vector3d& at : samples) {
    order.emplace_back(key_of(at, cell), static_cast<std::uint32_t>(order.size()));
  }
  std::sort(order.begin(), order.end());
  std::vector<Eigen::Vector3d> sorted;
  std::vector<std::uint64_t> keys;
  sorted.reserve(samples.size());
  keys.reserve(samples.size());
  for (const auto& [key, sample] : order) {
    sorted.push_back(samples[sample]);
    keys.push_back(key);
  }
  samples = std::move(sorted);
  return keys;
}

/// One cube and what is in it.
Burr::Cell cell_of(const Burr::Arrays& samples, const std::array<int, 3>& cube, double edge,
                   std::size_t first, std::size_t end) {
  Burr::Cell made{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    made.centre[axis] = static_cast<std::int32_t>(
        std::lround(Burr::kRadius * ((cube[2 - axis] + 0.5) * edge - 1.0)));
  }
  made.half = static_cast<std::int32_t>(std::ceil(0.5 * edge * Burr::kRadius)) + 2;  // rounded
  made.first = static_cast<std::int32_t>(first);
  made.count = static_cast<std::int32_t>(end - first);
  for (std::size_t s = first; s < end; ++s) {
    const std::array direction{samples.dx[s], samples.dy[s], samples.dz[s]};
    const std::array position{samples.x[s], samples.y[s], samples.z[s]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      made.direction[axis] += direction[axis];
      made.position[axis] += position[axis];
    }
  }
  return made;
}

std::vector<Burr::Cell> cells_of(const Burr::Arrays& samples,
                                 const std::vector<Eigen::Vector3d>& places,
                                 const std::vector<std::uint64_t>& keys, double cell) {
  std::vector<Burr::Cell> cells;
  const auto split = [&](auto&& self, std::size_t level, std::size_t first,
                         std::size_t end) -> void {
    constexpr std::size_t kBitsOfLevel = 3;
    const std::size_t below = kBitsOfLevel * (kWidths.size() - 1 - level);
    while (first < end) {
      std::size_t last = first;
      while (last < end && keys[last] >> below == keys[first] >> below) {
        ++last;
      }
      const std::size_t number = cells.size();
      cells.push_back(cell_of(samples, cube_of(places[first], cell, level), cell * kWidths[level],
                              first, last));
      cells[number].leaf = below == 0;
      if (below > 0) {
        self(self, level + 1, first, last);
      }
      cells[number].after = static_cast<std::int32_t>(cells.size());
      first = last;
    }
  };
  split(split, 0, 0, places.size());
  return cells;
}

std::int16_t rounded(double value) { return static_cast<std::int16_t>(std::lround(value)); }

}  // namespace

double sharpness(const BurrParameters& burr, double removed) noexcept {
  return burr.wear_volume > 0.0 ? burr.wear_volume / (burr.wear_volume + removed) : 1.0;
}

BurrParameters default_burr(BurrKind kind, double diameter) {
  return default_burr(kind, {BurrForm::kBall, diameter, 0.0, 0.0});
}

BurrParameters default_burr(BurrKind kind, const BurrDimensions& dimensions) {
  BurrParameters p;
  p.kind = kind;
  p.form = dimensions.form;
  p.diameter = dimensions.diameter;
  p.length = dimensions.length;
  p.narrow_diameter = dimensions.narrow_diameter;
  // Small burrs need as many samples as large ones to push as evenly.
  const double as_ball = std::cbrt(BurrShape(dimensions).fullness() / kBallFullness);
  p.sample_spacing = std::min(0.25e-3, p.diameter / 28.0 * as_ball);
  const bool cutting = kind == BurrKind::kCutting;
  p.removal_rate = cutting ? 25.0 : 10.0;
  p.falloff = cutting ? 12.0 : 2.0;
  const double radius = 0.5 * p.diameter;
  p.tangential_gain = (cutting ? 1.2e6 : 0.4e6) / (radius * radius);
  return p;
}

BurrParameters for_bone(const BurrParameters& burr, double voxel) {
  BurrParameters p = burr;
  if (p.follows_bone) {
    constexpr double kMostFollowing = 4e5;  // samples that a tick has time for
    const double finest = spacing_of(BurrShape(p.dimensions()), kMostFollowing);
    // At half a voxel the burr misses pieces of voxels at its edge: docs/algorithms/bone-feel.md.
    const double share = voxel < 0.5e-3 ? 0.46 : 0.5;
    p.sample_spacing = std::min(p.sample_spacing, std::max(share * voxel, finest));
  }
  return p;
}

namespace {

using P = BurrParameters;

double least_length(const P& p) {
  constexpr double kPearsLeast = 1.01;  // length over diameter: else it is a ball
  return p.form == BurrForm::kPear ? kPearsLeast * p.diameter : kShortest;
}

/// A problem of a burr's dimensions is noted and mended: what is computed from them needs a shape.
void check_burr(Table& table, P& p) {
  const std::string diameter = fmt::format("diameter, {} [m]", p.diameter);
  if (p.form == BurrForm::kPear && p.length < least_length(p)) {
    table.reject("length", fmt::format("{}", p.length), "at least 1.01 times " + diameter);
    p.length = least_length(p);
  }
  const double least = p.form == BurrForm::kPear ? kShortest : 0.0;
  if (p.narrow_diameter > p.diameter) {
    table.reject("narrow_diameter", fmt::format("{}", p.narrow_diameter), "at most " + diameter);
    p.narrow_diameter = p.diameter;
  } else if (p.form != BurrForm::kBall && p.form != BurrForm::kCylinder &&
             p.narrow_diameter < least) {
    table.reject("narrow_diameter", fmt::format("{}", p.narrow_diameter),
                 fmt::format("at least {} [m] for shape \"pear\"", least));
    p.narrow_diameter = least;
  }
}

void check_samples(Table& table, P& p) {
  p.follows_bone = !table.has("sample_spacing");
  const double closest = spacing_of(BurrShape(p.dimensions()), kMostSamples);
  if (!p.follows_bone && (p.sample_spacing < closest || p.sample_spacing > 0.5 * p.diameter)) {
    table.reject("sample_spacing", fmt::format("{}", p.sample_spacing),
                 fmt::format("at least {} (a million samples) and at most half of diameter, {} [m]",
                             closest, p.diameter));
  }
}

}  // namespace

const Schema<BurrParameters>& burr_schema() {
  static const auto schema =
      Schema<P>()
          .choice("kind", &P::kind,
                  {{"diamond", BurrKind::kDiamond}, {"cutting", BurrKind::kCutting}},
                  "Kind of the burr; a cutting one removes more and pulls harder along the bone")
          .required()
          .choice("shape", &P::form,
                  {{"ball", BurrForm::kBall},
                   {"cylinder", BurrForm::kCylinder},
                   {"cone", BurrForm::kCone},
                   {"pear", BurrForm::kPear}},
                  "Shape of the burr, or of the plate")
          .otherwise("a burr is a ball")
          .number("diameter", &P::diameter, kDiameter, "m", "Greatest diameter of the burr")
          .required()
          .number("length", &P::length, {kShortest, 0.04}, "m",
                  "Length along its axis of a burr that is no ball")
          .required()
          .only_if([](const P& p) { return p.form != BurrForm::kBall; })
          .derive([](P& p) {
            const bool tapers = p.form == BurrForm::kCone || p.form == BurrForm::kPear;
            p.narrow_diameter = tapers ? 0.5 * p.diameter : 0.0;
          })
          .number("narrow_diameter", &P::narrow_diameter, {0.0, kDiameter.high}, "m",
                  "Diameter of the tip of a cone, or of the neck of a pear")
          .otherwise("half of the diameter")
          .only_if(
              [](const P& p) { return p.form == BurrForm::kCone || p.form == BurrForm::kPear; })
          .check(check_burr)
          .derive([](P& p) { p = default_burr(p.kind, p.dimensions()); })
          .number("sample_spacing", &P::sample_spacing, {0.0, 0.5 * kDiameter.high, true}, "m",
                  "Edge of a cell of the burr with one sample; a finer sampling costs time")
          .check(check_samples)
          .number("removal_rate", &P::removal_rate, {0.0, 1e6}, "1/(N·s)",
                  "Share of the bone within the burr that goes in a second at a force of 1 N")
          .tunable()
          .otherwise("25 of a cutting burr, 10 of a diamond")
          .number("falloff", &P::falloff, {0.0, 1e6}, "1/(N·s·rad)",
                  "Decrease of the removal rate from the burr's equator towards its tip")
          .tunable()
          .otherwise("12 of a cutting burr, 2 of a diamond")
          .number("tangential_gain", &P::tangential_gain, {0.0, 1e15}, "N/m^4",
                  "Strength with which the turning burr pulls along the bone")
          .tunable()
          .otherwise("as fits kind and size of the burr")
          .number("wear_volume", &P::wear_volume, {0.0, 1.0, true}, "m3",
                  "Volume of bone after which the burr removes half as much")
          .otherwise("never")
          .choice("rotation", &P::clockwise, {{"clockwise", true}, {"counterclockwise", false}},
                  "Direction in which the burr turns, seen from the handle");
  return schema;
}

Burr::Burr(const BurrParameters& parameters)
    : parameters_(parameters), shape_(parameters.dimensions()) {
  check(parameters, shape_);
  const double cell = parameters.sample_spacing / reach();
  const auto half = half_of_samples(shape_, cell);
  for (auto& axis : position_) {
    axis.reserve(2 * half.size());
  }
  // The other half first, so that all samples of a ball run row by row.
  std::vector<Eigen::Vector3d> all(half.rbegin(), half.rend());
  for (Eigen::Vector3d& at : all) {
    at = image_of(shape_, at);
  }
  all.insert(all.end(), half.begin(), half.end());
  std::vector<std::uint64_t> keys;
  if (all.size() > kFew) {
    keys = sort_by_cell(all, cell);
  }
  for (const Eigen::Vector3d& at : all) {
    const Eigen::Vector3d in = inwards(shape_, at);
    for (int axis = 0; axis < 3; ++axis) {
      position_[axis].push_back(rounded(kRadius * at[axis]));
      direction_[axis].push_back(rounded(kUnit * in[axis]));
    }
    latitude_.push_back(std::abs(std::asin(std::clamp(in.z(), -1.0, 1.0))));
  }
  power_.resize(latitude_.size());
  set_rates(parameters.removal_rate, parameters.falloff);
  if (half.empty()) {
    throw std::invalid_argument("Burr: no samples");
  }
  balance();
  if (!keys.empty()) {
    cells_ = cells_of(arrays(), all, keys, cell);
  }
  sample_volume_ =
      shape_.fullness() * std::pow(parameters.diameter, 3) / static_cast<double>(samples());
}

void Burr::set_rates(double removal_rate, double falloff) noexcept {
  parameters_.removal_rate = removal_rate;
  parameters_.falloff = falloff;
  for (std::size_t s = 0; s < power_.size(); ++s) {
    power_[s] = static_cast<float>(std::max(0.0, removal_rate - falloff * latitude_[s]));
  }
}

/// Makes the sum of the directions along the axis zero where images alone do not.
void Burr::balance() noexcept {
  std::int64_t sum = 0;
  for (const std::int16_t z : direction_[2]) {
    sum += z;
  }
  const std::int64_t count = samples();
  const std::int64_t each = sum / count;
  const std::int64_t sign = sum < 0 ? -1 : 1;
  std::int64_t left = std::abs(sum % count);
  for (std::int16_t& z : direction_[2]) {
    z = static_cast<std::int16_t>(z - each - (left > 0 ? sign : 0));
    left -= left > 0 ? 1 : 0;
  }
}

Eigen::Vector3d Burr::position(std::int32_t sample) const {
  const auto at = static_cast<std::size_t>(sample);
  return reach() / kRadius * Eigen::Vector3d(position_[0][at], position_[1][at], position_[2][at]);
}

Eigen::Vector3d Burr::direction(std::int32_t sample) const {
  const auto at = static_cast<std::size_t>(sample);
  return Eigen::Vector3d(direction_[0][at], direction_[1][at], direction_[2][at]) / kUnit;
}

Burr::Arrays Burr::arrays() const noexcept {
  return {position_[0].data(),  position_[1].data(),  position_[2].data(), direction_[0].data(),
          direction_[1].data(), direction_[2].data(), power_.data(),       samples()};
}

}  // namespace haptrial::bone
