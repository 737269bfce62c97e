#include "analysis/alignment/kernel.h"

namespace haptrial::analysis::kernel {

const Kernels& kernels_for(InstructionSet set) {
  return choose(set, baseline_kernels, HAPTRIAL_X86(avx2_kernels), HAPTRIAL_X86(avx512_kernels))();
}

}  // namespace haptrial::analysis::kernel
