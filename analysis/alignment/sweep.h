#pragma once

// The two sweeps over the matrix, written once for every instruction set. Included by the kernel
// files after their target pragma; Lanes is the vector type of that file.

#include <cstddef>
#include <limits>

#include "analysis/alignment/error.h"
#include "analysis/alignment/kernel.h"
#include "analysis/alignment/raise.h"

namespace haptrial::analysis::kernel {
namespace {

/// The recurrence, for `lanes` independent cells. Ties go to `diagonal`, then to `up`.
/// @tparam straight  weight of the error of a step from the diagonal
template <class Lanes, int straight, int power>
[[gnu::always_inline]] inline typename Lanes::Number relax(
    typename Lanes::Number diagonal, typename Lanes::Number up, typename Lanes::Number left,
    typename Lanes::Number force_difference, typename Lanes::Number slope_difference,
    typename Lanes::Number penalty, Directions& directions) {
  const auto error =
      powered<power, Lanes>(force_difference) + powered<power, Lanes>(slope_difference);
  if constexpr (straight == 2) {
    diagonal = diagonal + error;
  }
  const auto aside = Lanes::smaller(left, up) + penalty;
  directions.aside = Lanes::less(aside, diagonal);
  directions.left = Lanes::less(left, up);
  return error + Lanes::smaller(aside, diagonal);
}

/// How a sweep lays cells into vectors: what separates one pair from a batch.
///
/// One pair: the lanes are consecutive rows on one anti-diagonal, the lowest row in lane 0.
template <class Lanes>
struct OnePair {
  using Number = typename Lanes::Number;
  static constexpr std::ptrdiff_t kRowsOfVector = Lanes::kCount;
  static constexpr std::ptrdiff_t kStride = 1;  // from one column to the next
  static Number up(Number left, Number from) { return Lanes::shift_in(left, from); }
  static Number border(const float* at) { return Lanes::all(*at); }
};

/// A batch: lane k holds pair k.
template <class Lanes>
struct PairPerLane {
  using Number = typename Lanes::Number;
  static constexpr std::ptrdiff_t kRowsOfVector = 1;
  static constexpr std::ptrdiff_t kStride = Lanes::kCount;
  static Number up(Number, Number from) { return from; }
  static Number border(const float* at) { return Lanes::load(at); }
};

/// Sweeps strips: in each step of a strip its row r meets column step - r, so that no cell of a
/// step needs another of the same step. D moves down from vector to vector; memory sees only the
/// last row of a strip.
template <class Lanes, class Layout, int straight, int power, std::size_t vectors>
void sweep(const Task& task) {
  using Number = typename Lanes::Number;
  constexpr std::ptrdiff_t kRows = vectors * Layout::kRowsOfVector;
  constexpr std::ptrdiff_t kStride = Layout::kStride;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const Number penalty = Lanes::all(task.penalty);
  const float* applied_force = task.applied_force;
  const float* applied_slope = task.applied_slope;
  float* boundary = task.boundary;
  Directions* out = task.directions;
  const std::ptrdiff_t steps = task.columns + kRows - 1;
  for (std::size_t strip = 0; strip < task.strips; ++strip) {
    Number target_force[vectors], target_slope[vectors], left[vectors], diagonal[vectors];
    for (std::size_t v = 0; v < vectors; ++v) {
      target_force[v] = Lanes::load(task.target_force + (strip * vectors + v) * Lanes::kCount);
      target_slope[v] = Lanes::load(task.target_slope + (strip * vectors + v) * Lanes::kCount);
      left[v] = diagonal[v] = Lanes::all(kInfinity);
    }
    diagonal[0] = Layout::up(diagonal[0], Layout::border(boundary - kStride));
    for (std::ptrdiff_t step = 0; step < steps; ++step) {
      Number from = Layout::border(boundary + step * kStride);
#pragma GCC unroll 8
      for (std::size_t v = 0; v < vectors; ++v) {
        const std::ptrdiff_t last_row = std::ptrdiff_t(v + 1) * Layout::kRowsOfVector - 1;
        const std::ptrdiff_t at = (step - last_row) * kStride;
        const Number up = Layout::up(left[v], from);
        const Number cost = relax<Lanes, straight, power>(
            diagonal[v], up, left[v], target_force[v] - Lanes::load(applied_force + at),
            target_slope[v] - Lanes::load(applied_slope + at), penalty, *out++);
        from = left[v];
        diagonal[v] = up;
        left[v] = cost;
      }
      // One pair: lane 0 is the last row; what the other lanes write, later steps overwrite.
      Lanes::store(boundary + (step - kRows + 1) * kStride, left[vectors - 1]);
    }
  }
}

template <class Lanes, std::size_t single, std::size_t batch>
Kernels kernels_of() {
  using One = OnePair<Lanes>;
  using Batch = PairPerLane<Lanes>;
  return {Lanes::kCount,
          single,
          batch,
          {{sweep<Lanes, One, 1, 1, single>, sweep<Lanes, One, 1, 2, single>},
           {sweep<Lanes, One, 2, 1, single>, sweep<Lanes, One, 2, 2, single>}},
          {{sweep<Lanes, Batch, 1, 1, batch>, sweep<Lanes, Batch, 1, 2, batch>},
           {sweep<Lanes, Batch, 2, 1, batch>, sweep<Lanes, Batch, 2, 2, batch>}},
          raise};
}

}  // namespace
}  // namespace haptrial::analysis::kernel
