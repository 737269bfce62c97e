#include "analysis/alignment.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "analysis/alignment_buffer.h"
#include "analysis/alignment_error.h"
#include "analysis/alignment_kernel.h"

namespace haptrial::analysis {
namespace {

using kernel::Directions;

void require_parameter(bool holds, const char* sentence) {
  if (!holds) throw std::invalid_argument(std::string("alignment: ") + sentence);
}

void check(const AlignmentParameters& p) {
  const auto bounded = [](double x) { return x >= 0.0 && x <= Aligner::kMaxError; };
  require_parameter(bounded(p.force_weight), "force_weight must be finite and at least 0");
  require_parameter(bounded(p.slope_weight), "slope_weight must be finite and at least 0");
  require_parameter(bounded(p.penalty), "penalty must be finite and at least 0");
  require_parameter(p.power == 1 || p.power == 2, "power must be 1 or 2");
}

void check(const CurveView& curve) {
  require_parameter(!curve.force.empty(), "a curve must hold at least one sample");
  require_parameter(curve.force.size() <= Aligner::kMaxSamples, "a curve holds too many samples");
  require_parameter(curve.force.size() == curve.slope.size(),
                    "a curve's force and slope must have the same length");
}

/// What a curve's values are multiplied by before they meet in single precision.
struct Scales {
  double force, slope;
  double limit;  // largest |scaled value|

  explicit Scales(const AlignmentParameters& p)
      : force(scale_of_weight(p.force_weight, p.power)),
        slope(scale_of_weight(p.slope_weight, p.power)),
        limit(p.power == 1 ? Aligner::kMaxError : std::sqrt(Aligner::kMaxError)) {}
};

/// to[i * stride] = scale * from[i], for any order of places that `place` gives.
template <class Place>
void write_scaled(std::span<const double> from, double scale, double limit, Place place) {
  bool good = true;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double value = scale * from[i];
    good &= std::abs(value) <= limit;  // false for a NaN
    *place(i) = static_cast<float>(value);
  }
  require_parameter(good, "a value is not finite or too large");
}

template <int power>
double path_cost_of(const CurveView& a, const CurveView& b, const AlignmentParameters& p,
                    std::span<const PathPoint> path) {
  const auto error = [&](PathPoint at) {
    const double force = a.force[at.target] - b.force[at.applied];
    const double slope = a.slope[at.target] - b.slope[at.applied];
    return p.force_weight * powered<power, DoubleOps>(force) +
           p.slope_weight * powered<power, DoubleOps>(slope);
  };
  double cost = path.empty() ? 0.0 : error(path[0]);
  for (std::size_t k = 1; k < path.size(); ++k) {
    const bool diagonal =
        path[k].target != path[k - 1].target && path[k].applied != path[k - 1].applied;
    cost += error(path[k]) + (diagonal ? 0.0 : p.penalty);
  }
  return cost;
}

/// Walks one path backwards; knows nothing of where a cell's bits lie.
struct Walker {
  std::uint32_t row, column;
  PathPoint* out;  // one past the next place, filled downwards

  bool at_start() const { return row == 0 && column == 0; }
  void note() { *--out = {row, column}; }
  void step(Directions directions, unsigned lane) {
    const std::uint32_t aside = directions.aside >> lane & 1u;
    const std::uint32_t left = directions.left >> lane & 1u;
    row -= (aside & left) ^ 1u;
    column -= (aside & (left ^ 1u)) ^ 1u;
    note();
  }
};

Walker start_of_walk(const CurveView& target, const CurveView& applied, Alignment& result) {
  const auto rows = static_cast<std::uint32_t>(target.force.size());
  const auto columns = static_cast<std::uint32_t>(applied.force.size());
  result.path.resize(rows + columns - 1);
  Walker walker{rows - 1, columns - 1, result.path.data() + result.path.size()};
  walker.note();
  return walker;
}

void finish_walk(const Walker& walker, const CurveView& target, const CurveView& applied,
                 const AlignmentParameters& parameters, Alignment& result) {
  result.path.erase(result.path.begin(), result.path.begin() + (walker.out - result.path.data()));
  result.cost = path_cost(target, applied, parameters, result.path);
}

std::size_t round_up(std::size_t count, std::size_t unit) {
  return (count + unit - 1) / unit * unit;
}

/// A sweep takes the time of `lanes` pairs of the largest size whatever it holds, and is slower
/// than pairs one by one when the direction bits leave the cache.
bool pays_side_by_side(std::span<const AlignmentPair> pairs, std::size_t lanes) {
  constexpr std::size_t kCellsInCache = std::size_t{1} << 22;
  std::size_t rows = 0, columns = 0, cells = 0;
  for (const AlignmentPair& pair : pairs) {
    rows = std::max(rows, pair.target.force.size());
    columns = std::max(columns, pair.applied.force.size());
    cells += pair.target.force.size() * pair.applied.force.size();
  }
  return rows * columns <= kCellsInCache && 10 * cells >= 9 * lanes * rows * columns;
}

}  // namespace

struct Aligner::Workspace {
  const kernel::Kernels& kernels;
  WorkBuffer<float> target_force, target_slope, applied_force, applied_slope, boundary;
  WorkBuffer<Directions> directions;

  void align_one(const CurveView& target, const CurveView& applied,
                 const AlignmentParameters& parameters, Alignment& result);
  void walk_one(const CurveView& target, const CurveView& applied,
                const AlignmentParameters& parameters, Alignment& result);
  void align_lanes(std::span<const AlignmentPair> pairs, const AlignmentParameters& parameters,
                   std::span<Alignment> results);
  void walk_lanes(std::span<const AlignmentPair> pairs, std::size_t columns,
                  const AlignmentParameters& parameters, std::span<Alignment> results);
  void interleave(std::span<const AlignmentPair> pairs, const Scales& scales, std::size_t rows,
                  std::size_t columns);
};

Aligner::Aligner(InstructionSet set)
    : workspace_(new Workspace{kernel::kernels_for(set), {}, {}, {}, {}, {}, {}}) {}
Aligner::~Aligner() = default;
Aligner::Aligner(Aligner&&) noexcept = default;
Aligner& Aligner::operator=(Aligner&&) noexcept = default;

std::size_t Aligner::lanes() const { return workspace_->kernels.lanes; }

void Aligner::Workspace::align_one(const CurveView& target, const CurveView& applied,
                                   const AlignmentParameters& parameters, Alignment& result) {
  const Scales scales(parameters);
  const std::size_t lanes = kernels.lanes;
  const std::size_t strip = kernels.strip_rows;
  const std::size_t rows = round_up(target.force.size(), strip);
  const std::size_t columns = applied.force.size();

  // A vector's lowest row sits in lane 0.
  const auto place_row = [lanes](float* to) {
    return [lanes, to](std::size_t i) { return to + (i ^ (lanes - 1)); };
  };
  float* forces = target_force.at_least(rows);
  float* slopes = target_slope.at_least(rows);
  std::fill_n(forces + rows - strip, strip, 0.0f);
  std::fill_n(slopes + rows - strip, strip, 0.0f);
  write_scaled(target.force, scales.force, scales.limit, place_row(forces));
  write_scaled(target.slope, scales.slope, scales.limit, place_row(slopes));

  // Infinite values before column 0 make the cells there infinitely dear.
  const auto place_columns = [&](WorkBuffer<float>& buffer, std::span<const double> values,
                                 double scale) {
    float* to = buffer.at_least(columns + 2 * strip) + strip;
    std::fill_n(to - strip, strip, std::numeric_limits<float>::infinity());
    std::fill_n(to + columns, strip, 0.0f);
    write_scaled(values, scale, scales.limit, [to](std::size_t j) { return to + j; });
    return to;
  };
  const float* applied_forces = place_columns(applied_force, applied.force, scales.force);
  const float* applied_slopes = place_columns(applied_slope, applied.slope, scales.slope);
  float* above = boundary.at_least(columns + 2 * strip) + strip;
  std::fill_n(above - strip, columns + 2 * strip, std::numeric_limits<float>::infinity());
  above[-1] = 0.0f;

  const std::size_t steps = columns + strip - 1;
  const std::size_t vectors = strip / lanes;
  Directions* bits = directions.at_least(rows / strip * steps * vectors);
  kernels.fill_single[parameters.power - 1]({forces, slopes, applied_forces, applied_slopes, above,
                                             bits, rows / strip, columns,
                                             static_cast<float>(parameters.penalty)});

  walk_one(target, applied, parameters, result);
}

void Aligner::Workspace::walk_one(const CurveView& target, const CurveView& applied,
                                  const AlignmentParameters& parameters, Alignment& result) {
  const std::size_t lanes = kernels.lanes;
  const std::size_t strip = kernels.strip_rows;
  const std::size_t steps = applied.force.size() + strip - 1;
  const std::size_t vectors = strip / lanes;
  const Directions* bits = directions.at_least(0);
  const int strip_shift = std::countr_zero(strip);
  const int lane_shift = std::countr_zero(lanes);
  Walker walker = start_of_walk(target, applied, result);
  while (!walker.at_start()) {
    const std::size_t row = walker.row & (strip - 1);
    const std::size_t step = (walker.row >> strip_shift) * steps + row + walker.column;
    walker.step(bits[step * vectors + (row >> lane_shift)],
                static_cast<unsigned>(~row & (lanes - 1)));
  }
  finish_walk(walker, target, applied, parameters, result);
}

void Aligner::Workspace::interleave(std::span<const AlignmentPair> pairs, const Scales& scales,
                                    std::size_t rows, std::size_t columns) {
  const std::size_t lanes = kernels.lanes;
  const auto place = [&](WorkBuffer<float>& buffer, std::size_t length, double scale,
                         auto&& values_of) {
    float* to = buffer.at_least(length * lanes);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      std::size_t filled = 0;
      if (lane < pairs.size()) {
        const std::span<const double> values = values_of(pairs[lane]);
        write_scaled(values, scale, scales.limit,
                     [&](std::size_t i) { return to + i * lanes + lane; });
        filled = values.size();
      }
      for (std::size_t i = filled; i < length; ++i) to[i * lanes + lane] = 0.0f;
    }
  };
  place(target_force, rows, scales.force, [](auto& pair) { return pair.target.force; });
  place(target_slope, rows, scales.slope, [](auto& pair) { return pair.target.slope; });
  place(applied_force, columns, scales.force, [](auto& pair) { return pair.applied.force; });
  place(applied_slope, columns, scales.slope, [](auto& pair) { return pair.applied.slope; });
}

void Aligner::Workspace::align_lanes(std::span<const AlignmentPair> pairs,
                                     const AlignmentParameters& parameters,
                                     std::span<Alignment> results) {
  const std::size_t lanes = kernels.lanes;
  const std::size_t tile = kernels.tile_rows;
  std::size_t rows = 0, columns = 0;
  for (const AlignmentPair& pair : pairs) {
    rows = std::max(rows, round_up(pair.target.force.size(), tile));
    columns = std::max(columns, pair.applied.force.size());
  }
  interleave(pairs, Scales(parameters), rows, columns);
  float* above = boundary.at_least(columns * lanes);
  std::fill_n(above, columns * lanes, std::numeric_limits<float>::infinity());
  Directions* bits = directions.at_least(rows * columns);
  kernels.fill_batch[parameters.power - 1]({target_force.at_least(0), target_slope.at_least(0),
                                            applied_force.at_least(0), applied_slope.at_least(0),
                                            above, bits, rows / tile, columns,
                                            static_cast<float>(parameters.penalty)});
  walk_lanes(pairs, columns, parameters, results);
}

void Aligner::Workspace::walk_lanes(std::span<const AlignmentPair> pairs, std::size_t columns,
                                    const AlignmentParameters& parameters,
                                    std::span<Alignment> results) {
  const std::size_t tile = kernels.tile_rows;
  const Directions* bits = directions.at_least(0);
  // All lanes walk together, so that their cache misses overlap.
  constexpr std::size_t kMostLanes = 16;
  Walker walkers[kMostLanes];
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
    walkers[lane] = start_of_walk(pairs[lane].target, pairs[lane].applied, results[lane]);
  }
  const int tile_shift = std::countr_zero(tile);
  for (bool walking = true; walking;) {
    walking = false;
    for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
      Walker& walker = walkers[lane];
      if (walker.at_start()) continue;
      const std::size_t cell =
          ((walker.row >> tile_shift) * columns + walker.column) * tile + (walker.row & (tile - 1));
      walker.step(bits[cell], static_cast<unsigned>(lane));
      walking = true;
    }
  }
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
    finish_walk(walkers[lane], pairs[lane].target, pairs[lane].applied, parameters, results[lane]);
  }
}

void Aligner::align(const CurveView& target, const CurveView& applied,
                    const AlignmentParameters& parameters, Alignment& result) {
  check(parameters);
  check(target);
  check(applied);
  workspace_->align_one(target, applied, parameters, result);
}

void Aligner::align_batch(std::span<const AlignmentPair> pairs,
                          const AlignmentParameters& parameters, std::span<Alignment> results) {
  check(parameters);
  require_parameter(pairs.size() == results.size(), "a batch needs one result for each pair");
  for (const AlignmentPair& pair : pairs) {
    check(pair.target);
    check(pair.applied);
  }
  for (std::size_t first = 0; first < pairs.size(); first += lanes()) {
    const std::size_t count = std::min(lanes(), pairs.size() - first);
    const auto group = pairs.subspan(first, count);
    if (pays_side_by_side(group, lanes())) {
      workspace_->align_lanes(group, parameters, results.subspan(first, count));
      continue;
    }
    for (std::size_t k = 0; k < count; ++k) {
      workspace_->align_one(group[k].target, group[k].applied, parameters, results[first + k]);
    }
  }
}

Alignment align(const CurveView& target, const CurveView& applied,
                const AlignmentParameters& parameters) {
  Alignment result;
  Aligner().align(target, applied, parameters, result);
  return result;
}

std::vector<Alignment> align_batch(std::span<const AlignmentPair> pairs,
                                   const AlignmentParameters& parameters) {
  std::vector<Alignment> results(pairs.size());
  Aligner().align_batch(pairs, parameters, results);
  return results;
}

double path_cost(const CurveView& target, const CurveView& applied,
                 const AlignmentParameters& parameters, std::span<const PathPoint> path) {
  check(parameters);
  return parameters.power == 1 ? path_cost_of<1>(target, applied, parameters, path)
                               : path_cost_of<2>(target, applied, parameters, path);
}

}  // namespace haptrial::analysis
