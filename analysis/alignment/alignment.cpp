#include "analysis/alignment/alignment.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

#include "analysis/alignment/buffer.h"
#include "analysis/alignment/error.h"
#include "analysis/alignment/kernel.h"
#include "analysis/alignment/rows.h"
#include "core/base/parallel.h"

namespace haptrial::analysis {
namespace {

using kernel::Directions;

void require_parameter(bool holds, std::string_view sentence) {
  if (!holds) {
    throw std::invalid_argument("alignment: " + std::string(sentence));
  }
}

void check(const AlignmentOptions& options) {
  const std::string problem = problem_of(options);
  require_parameter(problem.empty(), problem);
}

void check(const CurveView& curve) {
  require_parameter(!curve.force.empty(), "a curve must hold at least one sample");
  require_parameter(curve.force.size() <= Aligner::kMaxSamples, "a curve holds too many samples");
  require_parameter(curve.force.size() == curve.slope.size(),
                    "a curve's force and slope must have the same length");
}

constexpr const char* kBadValue = "a value is not finite or too large";

/// Factors of a curve's values before they meet in single precision.
struct Scales {
  double force, slope;
  double limit;  // largest |scaled value|

  /// Precondition: is_vectorized(o).
  explicit Scales(const AlignmentOptions& o)
      : force(scale_of_weight(o.force_weight, static_cast<int>(o.power))),
        slope(scale_of_weight(o.slope_weight, static_cast<int>(o.power))),
        limit(o.power == 1.0 ? Aligner::kMaxError : std::sqrt(Aligner::kMaxError)) {}
};

/// *place(i) = scale * from[i]
template <class Place>
void write_scaled(std::span<const double> from, double scale, double limit, Place place) {
  bool good = true;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double value = scale * from[i];
    good &= std::abs(value) <= limit;  // false for a NaN
    *place(i) = static_cast<float>(value);
  }
  require_parameter(good, kBadValue);
}

/// The same for values that are not scaled.
void check_values(std::span<const double> values, double weight, double power) {
  const double limit = std::pow(Aligner::kMaxError / weight, 1.0 / power);
  bool good = true;
  for (const double value : values) {
    good &= std::abs(value) <= limit && std::isfinite(value);
  }
  require_parameter(good, kBadValue);
}

/// Walks one path backwards; knows nothing of where a cell's bits lie.
struct Walker {
  std::uint32_t row, column;
  PathPoint* out;  // one past the next place, filled downwards

  bool at_start() const { return row == 0 && column == 0; }
  void note() { *--out = {row, column}; }
  void step(Directions directions, std::size_t lane) {
    const std::uint32_t aside = directions.aside >> lane & 1u;
    const std::uint32_t left = directions.left >> lane & 1u;
    row -= (aside & left) ^ 1u;
    column -= (aside & (left ^ 1u)) ^ 1u;
    note();
  }
};

Walker start_of_walk(const AlignmentPair& pair, Alignment& result) {
  const auto rows = static_cast<std::uint32_t>(pair.target.force.size());
  const auto columns = static_cast<std::uint32_t>(pair.applied.force.size());
  result.path.resize(rows + columns - 1);
  Walker walker{rows - 1, columns - 1, result.path.data() + result.path.size()};
  walker.note();
  return walker;
}

/// Places of the values for the sweep, and of the bits for the walk, of a row, a column and a pair.
struct Layout {
  std::size_t lanes;
  int vector_shift;   // a vector holds 2^vector_shift rows: `lanes` for one pair, 1 for a batch
  std::size_t strip;  // rows, a power of two
  std::size_t strips, columns;

  std::size_t stride() const { return lanes >> vector_shift; }
  std::size_t vectors() const { return strip >> vector_shift; }
  std::size_t steps() const { return columns + strip - 1; }
  std::size_t lane(std::size_t row, std::size_t pair) const {
    return pair + (~row & ((std::size_t{1} << vector_shift) - 1));
  }
  std::size_t target(std::size_t row, std::size_t pair) const {
    return (row >> vector_shift) * lanes + lane(row, pair);
  }
  /// Places over columns, with those before the first and after the last that a sweep touches.
  std::size_t padded() const { return (columns + 2 * strip) * stride(); }
  std::size_t first_column() const { return strip * stride(); }
};

/// e(0,0), by the operations of the sweep.
float first_error(const kernel::Task& task, const Layout& layout, std::size_t pair, bool square) {
  const float force = task.target_force[layout.target(0, pair)] - task.applied_force[pair];
  const float slope = task.target_slope[layout.target(0, pair)] - task.applied_slope[pair];
  return square ? force * force + slope * slope : std::abs(force) + std::abs(slope);
}

void finish(const AlignmentPair& pair, const AlignmentOptions& options, Alignment& result) {
  result.cost = path_cost(pair.target, pair.applied, options, result.path);
  result.weight = path_weight(options.pattern, result.path);
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
  RowSearch rows;

  Layout layout_of(std::span<const AlignmentPair> pairs, bool side_by_side) const;
  float* place_target(WorkBuffer<float>& buffer, const Layout& layout,
                      std::span<const AlignmentPair> pairs,
                      std::span<const double> CurveView::*values, double scale, double limit);
  float* place_applied(WorkBuffer<float>& buffer, const Layout& layout,
                       std::span<const AlignmentPair> pairs,
                       std::span<const double> CurveView::*values, double scale, double limit);
  void align(std::span<const AlignmentPair> pairs, bool side_by_side,
             const AlignmentOptions& options, std::span<Alignment> results);
  void align_by_rows(const AlignmentPair& pair, const AlignmentOptions& options, Alignment& result);
  void walk(const Layout& layout, std::span<const AlignmentPair> pairs,
            std::span<Alignment> results);
};

Aligner::Aligner(InstructionSet set)
    : workspace_(new Workspace{
          kernel::kernels_for(set), {}, {}, {}, {}, {}, {}, RowSearch(kernel::kernels_for(set))}) {}
Aligner::~Aligner() = default;
Aligner::Aligner(Aligner&&) noexcept = default;
Aligner& Aligner::operator=(Aligner&&) noexcept = default;

std::size_t Aligner::lanes() const { return workspace_->kernels.lanes; }

Layout Aligner::Workspace::layout_of(std::span<const AlignmentPair> pairs,
                                     bool side_by_side) const {
  Layout layout{kernels.lanes, side_by_side ? 0 : std::countr_zero(kernels.lanes), 0, 0, 0};
  layout.strip = side_by_side ? kernels.batch_vectors : kernels.single_vectors * kernels.lanes;
  for (const AlignmentPair& pair : pairs) {
    layout.strips = std::max(layout.strips, (pair.target.force.size() - 1) / layout.strip + 1);
    layout.columns = std::max(layout.columns, pair.applied.force.size());
  }
  return layout;
}

float* Aligner::Workspace::place_target(WorkBuffer<float>& buffer, const Layout& layout,
                                        std::span<const AlignmentPair> pairs,
                                        std::span<const double> CurveView::*values, double scale,
                                        double limit) {
  const std::size_t count = layout.strips * layout.vectors() * layout.lanes;
  float* to = buffer.at_least(count);
  std::fill_n(to, count, 0.0f);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    write_scaled(pairs[k].target.*values, scale, limit,
                 [=](std::size_t i) { return to + layout.target(i, k); });
  }
  return to;
}

/// Infinite values before column 0 make the cells there infinitely dear.
float* Aligner::Workspace::place_applied(WorkBuffer<float>& buffer, const Layout& layout,
                                         std::span<const AlignmentPair> pairs,
                                         std::span<const double> CurveView::*values, double scale,
                                         double limit) {
  float* to = buffer.at_least(layout.padded());
  std::fill_n(to, layout.first_column(), std::numeric_limits<float>::infinity());
  std::fill_n(to + layout.first_column(), layout.padded() - layout.first_column(), 0.0f);
  to += layout.first_column();
  const std::size_t stride = layout.stride();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    write_scaled(pairs[k].applied.*values, scale, limit,
                 [=](std::size_t j) { return to + j * stride + k; });
  }
  return to;
}

void Aligner::Workspace::align(std::span<const AlignmentPair> pairs, bool side_by_side,
                               const AlignmentOptions& options, std::span<Alignment> results) {
  const Layout layout = layout_of(pairs, side_by_side);
  const Scales scales(options);
  const std::size_t stride = layout.stride();
  float* above = boundary.at_least(layout.padded());
  std::fill_n(above, layout.padded(), std::numeric_limits<float>::infinity());
  above += layout.first_column();
  std::fill_n(above - stride, stride, 0.0f);  // a path starts at (0,0) for nothing

  const kernel::Task task{
      place_target(target_force, layout, pairs, &CurveView::force, scales.force, scales.limit),
      place_target(target_slope, layout, pairs, &CurveView::slope, scales.slope, scales.limit),
      place_applied(applied_force, layout, pairs, &CurveView::force, scales.force, scales.limit),
      place_applied(applied_slope, layout, pairs, &CurveView::slope, scales.slope, scales.limit),
      above,
      directions.at_least(layout.strips * layout.steps() * layout.vectors()),
      layout.strips,
      layout.columns,
      static_cast<float>(options.penalty)};
  const bool square = options.power == 2.0;
  const bool twice = doubles_straight(options.pattern);
  for (std::size_t k = 0; twice && k < pairs.size(); ++k) {
    above[k - stride] = -first_error(task, layout, k, square);  // (0,0) counts once all the same
  }
  const auto& sweeps = side_by_side ? kernels.sweep_batch : kernels.sweep_single;
  sweeps[twice][square](task);
  walk(layout, pairs, results);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    finish(pairs[k], options, results[k]);
  }
}

void Aligner::Workspace::align_by_rows(const AlignmentPair& pair, const AlignmentOptions& options,
                                       Alignment& result) {
  for (const CurveView& curve : {pair.target, pair.applied}) {
    check_values(curve.force, options.force_weight, options.power);
    check_values(curve.slope, options.slope_weight, options.power);
  }
  require_parameter(rows.find(pair.target, pair.applied, options, result.path),
                    "the pattern leaves no path between curves of these lengths");
  finish(pair, options, result);
}

/// All pairs walk together, so that their cache misses overlap.
void Aligner::Workspace::walk(const Layout& layout, std::span<const AlignmentPair> pairs,
                              std::span<Alignment> results) {
  constexpr std::size_t kMostLanes = 16;
  Walker walkers[kMostLanes];
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    walkers[k] = start_of_walk(pairs[k], results[k]);
  }
  const Directions* bits = directions.at_least(0);
  const std::size_t steps = layout.steps(), vectors = layout.vectors();
  const int strip_shift = std::countr_zero(layout.strip);
  for (bool walking = true; walking;) {
    walking = false;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      Walker& walker = walkers[k];
      if (walker.at_start()) {
        continue;
      }
      const std::size_t row = walker.row & (layout.strip - 1);
      const std::size_t step = (walker.row >> strip_shift) * steps + row + walker.column;
      walker.step(bits[step * vectors + (row >> layout.vector_shift)], layout.lane(row, k));
      walking = true;
    }
  }
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    auto& path = results[k].path;
    path.erase(path.begin(), path.begin() + (walkers[k].out - path.data()));
  }
}

void Aligner::align(const CurveView& target, const CurveView& applied,
                    const AlignmentOptions& options, Alignment& result) {
  check(options);
  check(target);
  check(applied);
  const AlignmentPair pair{target, applied};
  if (is_vectorized(options)) {
    workspace_->align({&pair, 1}, false, options, {&result, 1});
  } else {
    workspace_->align_by_rows(pair, options, result);
  }
}

void Aligner::align_batch(std::span<const AlignmentPair> pairs, const AlignmentOptions& options,
                          std::span<Alignment> results) {
  check(options);
  require_parameter(pairs.size() == results.size(), "a batch needs one result for each pair");
  for (const AlignmentPair& pair : pairs) {
    check(pair.target);
    check(pair.applied);
  }
  if (!is_vectorized(options)) {
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      workspace_->align_by_rows(pairs[k], options, results[k]);
    }
    return;
  }
  for (std::size_t first = 0; first < pairs.size(); first += lanes()) {
    const std::size_t count = std::min(lanes(), pairs.size() - first);
    const auto group = pairs.subspan(first, count);
    if (pays_side_by_side(group, lanes())) {
      workspace_->align(group, true, options, results.subspan(first, count));
      continue;
    }
    for (std::size_t k = 0; k < count; ++k) {
      workspace_->align(group.subspan(k, 1), false, options, results.subspan(first + k, 1));
    }
  }
}

Alignment align(const CurveView& target, const CurveView& applied,
                const AlignmentOptions& options) {
  Alignment result;
  Aligner().align(target, applied, options, result);
  return result;
}

std::vector<Alignment> align_batch(std::span<const AlignmentPair> pairs,
                                   const AlignmentOptions& options, int jobs) {
  std::vector<Alignment> results(pairs.size());
  const std::size_t group = Aligner().lanes();
  in_groups(pairs.size(), group, jobs, [&] {
    return [&, aligner = Aligner()](std::size_t first, std::size_t count) mutable {
      aligner.align_batch(pairs.subspan(first, count), options,
                          std::span(results).subspan(first, count));
    };
  });
  return results;
}

}  // namespace haptrial::analysis
