#include "core/psychometric/procedure/information.h"

namespace haptrial::psychometric {
namespace {

constexpr std::size_t kLanes = 4;

}  // namespace
}  // namespace haptrial::psychometric

#include "core/psychometric/procedure/information_kernel.h"

namespace haptrial::psychometric {
namespace {

void row_sums_baseline(const float* rows, std::size_t count, std::size_t cells,
                       const GroupedWeights& weights, double* sums) {
  row_sums_of(rows, count, cells, weights, sums);
}

double row_sum_baseline(const double* row, std::size_t cells, const double* weights) {
  return row_sum_in_double(row, cells, weights);
}

}  // namespace

RowSums* row_sums(InstructionSet set) {
  return choose(set, row_sums_baseline, HAPTRIAL_X86(row_sums_avx2));
}

double row_sum(const double* row, std::size_t cells, const double* weights) noexcept {
  static RowSum* const sum =
      choose(best_instruction_set(), row_sum_baseline, HAPTRIAL_X86(row_sum_avx2));
  return sum(row, cells, weights);
}

}  // namespace haptrial::psychometric
