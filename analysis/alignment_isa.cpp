#include "analysis/alignment_isa.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "analysis/alignment_kernel.h"

namespace haptrial::analysis {

std::vector<InstructionSet> available_instruction_sets() {
  std::vector<InstructionSet> sets{InstructionSet::kBaseline};
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) sets.push_back(InstructionSet::kAvx2);
  if (__builtin_cpu_supports("avx512f")) sets.push_back(InstructionSet::kAvx512);
#endif
  return sets;
}

InstructionSet best_instruction_set() { return available_instruction_sets().back(); }

std::string_view name_of(InstructionSet set) {
  switch (set) {
    case InstructionSet::kAvx512:
      return "AVX-512";
    case InstructionSet::kAvx2:
      return "AVX2";
    case InstructionSet::kBaseline:
      break;
  }
  return "baseline";
}

namespace kernel {

const Kernels& kernels_for(InstructionSet set) {
  const auto sets = available_instruction_sets();
  if (std::find(sets.begin(), sets.end(), set) == sets.end()) {
    throw std::invalid_argument("this machine cannot run the alignment kernel for " +
                                std::string(name_of(set)));
  }
#ifdef __x86_64__
  if (set == InstructionSet::kAvx512) return avx512_kernels();
  if (set == InstructionSet::kAvx2) return avx2_kernels();
#endif
  return baseline_kernels();
}

}  // namespace kernel
}  // namespace haptrial::analysis
