#pragma once

// The two sweeps over the matrix, written once for every instruction set. Included by the kernel
// files after their target pragma; Lanes is the vector type of that file.

#include <cstddef>
#include <limits>

#include "analysis/alignment_error.h"
#include "analysis/alignment_kernel.h"

namespace haptrial::analysis::kernel {
namespace {

/// The recurrence, for `lanes` independent cells. Ties go to `diagonal`, then to `up`.
template <class Lanes, int power>
[[gnu::always_inline]] inline typename Lanes::Number relax(
    typename Lanes::Number diagonal, typename Lanes::Number up, typename Lanes::Number left,
    typename Lanes::Number force_difference, typename Lanes::Number slope_difference,
    typename Lanes::Number penalty, Directions& directions) {
  const auto error =
      powered<power, Lanes>(force_difference) + powered<power, Lanes>(slope_difference);
  const auto aside = Lanes::smaller(left, up) + penalty;
  directions.aside = Lanes::less(aside, diagonal);
  directions.left = Lanes::less(left, up);
  return error + Lanes::smaller(aside, diagonal);
}

/// Rows r of a strip meet column step - r, so that no cell of a step needs another of the same
/// step. D moves from lane to lane and from vector to vector; memory sees only the last row of a
/// strip.
template <class Lanes, int power, std::size_t vectors>
void fill_single(const SingleTask& task) {
  using Number = typename Lanes::Number;
  constexpr std::size_t kRows = vectors * Lanes::kCount;
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
      target_force[v] = Lanes::load(task.target_force + strip * kRows + v * Lanes::kCount);
      target_slope[v] = Lanes::load(task.target_slope + strip * kRows + v * Lanes::kCount);
      left[v] = diagonal[v] = Lanes::all(kInfinity);
    }
    diagonal[0] = Lanes::shift_in(diagonal[0], Lanes::all(boundary[-1]));
    for (std::ptrdiff_t step = 0; step < steps; ++step) {
      Number from = Lanes::all(boundary[step]);
#pragma GCC unroll 8
      for (std::size_t v = 0; v < vectors; ++v) {
        const std::ptrdiff_t column = step - std::ptrdiff_t((v + 1) * Lanes::kCount) + 1;
        const Number up = Lanes::shift_in(left[v], from);
        const Number cost = relax<Lanes, power>(
            diagonal[v], up, left[v], target_force[v] - Lanes::load(applied_force + column),
            target_slope[v] - Lanes::load(applied_slope + column), penalty, *out++);
        from = left[v];
        diagonal[v] = up;
        left[v] = cost;
      }
      // Lane 0 is the last row; the lanes above it are overwritten by the steps that follow.
      Lanes::store(boundary + step - std::ptrdiff_t(kRows) + 1, left[vectors - 1]);
    }
  }
}

/// Lane k holds pair k. A tile of rows goes through a column before the next column is read, so
/// that the row above and the applied curve are loaded once for all of them, and the rows of a tile
/// work on different columns at the same time as far as the processor looks ahead.
template <class Lanes, int power, std::size_t rows>
void fill_batch(const BatchTask& task) {
  using Number = typename Lanes::Number;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const Number penalty = Lanes::all(task.penalty);
  Number corner = Lanes::all(0.0f);
  const float* applied_force = task.applied_force;
  const float* applied_slope = task.applied_slope;
  float* boundary = task.boundary;
  Directions* out = task.directions;
  for (std::size_t tile = 0; tile < task.tiles; ++tile) {
    Number target_force[rows], target_slope[rows], left[rows];
    for (std::size_t r = 0; r < rows; ++r) {
      target_force[r] = Lanes::load(task.target_force + (tile * rows + r) * Lanes::kCount);
      target_slope[r] = Lanes::load(task.target_slope + (tile * rows + r) * Lanes::kCount);
      left[r] = Lanes::all(kInfinity);
    }
    for (std::size_t column = 0; column < task.columns; ++column) {
      const Number force = Lanes::load(applied_force + column * Lanes::kCount);
      const Number slope = Lanes::load(applied_slope + column * Lanes::kCount);
      Number up = Lanes::load(boundary + column * Lanes::kCount);
      Number diagonal = corner;
      corner = up;
#pragma GCC unroll 8
      for (std::size_t r = 0; r < rows; ++r) {
        const Number cost = relax<Lanes, power>(diagonal, up, left[r], target_force[r] - force,
                                                target_slope[r] - slope, penalty, *out++);
        diagonal = left[r];
        up = left[r] = cost;
      }
      Lanes::store(boundary + column * Lanes::kCount, up);
    }
    corner = Lanes::all(kInfinity);
  }
}

template <class Lanes, std::size_t vectors, std::size_t rows>
Kernels kernels_of() {
  return {Lanes::kCount,
          vectors * Lanes::kCount,
          rows,
          {fill_single<Lanes, 1, vectors>, fill_single<Lanes, 2, vectors>},
          {fill_batch<Lanes, 1, rows>, fill_batch<Lanes, 2, rows>}};
}

}  // namespace
}  // namespace haptrial::analysis::kernel
