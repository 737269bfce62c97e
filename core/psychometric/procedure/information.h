#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/instruction_set.h"

// Sums over the parameter grid, compiled for each instruction set. All give the same bits.
namespace haptrial::psychometric {

constexpr std::size_t kColumns = 32;  // cells side by side; rows are padded to a multiple
constexpr std::size_t kBlock = 16;    // groups of kColumns that are summed in single precision

/// The relative error of a sum of products that are not negative: of both factors, of the product,
/// and of the additions within a block.
constexpr double kSumError = 20.0 * 0x1p-24;

/// Weights of cells, of which only those of some groups of kColumns cells are summed.
struct GroupedWeights {
  const float* values;                    // (cells)
  std::span<const std::uint32_t> groups;  // in ascending order, the cell that each begins with
};

/// sums[r] = sum over c of rows[r * cells + c] * weights[c], in single precision within a block.
/// @param rows   (count x cells)
/// @param cells  a multiple of kColumns
using RowSums = void(const float* rows, std::size_t count, std::size_t cells,
                     const GroupedWeights& weights, double* sums);

/// @throws std::invalid_argument when this machine cannot run it.
RowSums* row_sums(InstructionSet set = best_instruction_set());

/// Exists where the compiler targets x86-64, as row_sum_avx2() does.
void row_sums_avx2(const float* rows, std::size_t count, std::size_t cells,
                   const GroupedWeights& weights, double* sums);

/// One such sum in double precision, over any number of cells.
using RowSum = double(const double* row, std::size_t cells, const double* weights);
double row_sum_avx2(const double* row, std::size_t cells, const double* weights);
/// Sum of a row by the best instruction set of this machine; all give the same bits.
double row_sum(const double* row, std::size_t cells, const double* weights) noexcept;

}  // namespace haptrial::psychometric
