#include "analysis/alignment_isa.h"

#include "analysis/alignment_kernel.h"

namespace haptrial::analysis::kernel {

const Kernels& kernels_for(InstructionSet set) {
  require_instruction_set(set);
#ifdef __x86_64__
  if (set == InstructionSet::kAvx512) return avx512_kernels();
  if (set == InstructionSet::kAvx2) return avx2_kernels();
#endif
  return baseline_kernels();
}

}  // namespace haptrial::analysis::kernel
