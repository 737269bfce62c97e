#pragma once

#include <cstddef>

#include "core/base/instruction_set.h"

// Sums over the parameter grid, compiled for each instruction set. All give the same bits.
namespace haptrial::psychometric {

constexpr std::size_t kColumns = 32;           // cells side by side; rows are padded to a multiple
constexpr std::size_t kBlock = 16 * kColumns;  // cells that are summed in single precision

/// The relative error of a sum of products that are not negative: of both factors, of the product,
/// and of the additions within a block.
constexpr double kSumError = 20.0 * 0x1p-24;

/// sums[r] = sum over c of rows[r * cells + c] * weights[c], in single precision within a block.
/// @param rows     (count x cells)
/// @param weights  (cells), a multiple of kColumns
using RowSums = void(const float* rows, std::size_t count, std::size_t cells, const float* weights,
                     double* sums);

/// @throws std::invalid_argument when this machine cannot run it.
RowSums* row_sums(InstructionSet set = best_instruction_set());

/// These exist where the compiler targets x86-64.
void row_sums_avx2(const float* rows, std::size_t count, std::size_t cells, const float* weights,
                   double* sums);
void row_sums_avx512(const float* rows, std::size_t count, std::size_t cells, const float* weights,
                     double* sums);

/// The same in double precision, any number of cells; slower.
double row_sum(const double* row, std::size_t cells, const double* weights) noexcept;

}  // namespace haptrial::psychometric
