#include "core/control/curve_chords.h"

namespace haptrial::control {
namespace {

constexpr std::size_t kLanes = 2;
typedef long long Flags __attribute__((vector_size(8 * kLanes)));  // -1 or 0
inline unsigned bits_of(Flags flags) {
  return static_cast<unsigned>(flags[0] & 1) | static_cast<unsigned>(flags[1] & 2);
}

}  // namespace
}  // namespace haptrial::control

#include "core/control/curve_chords_kernel.h"

namespace haptrial::control {

ChordKernel chord_kernel(InstructionSet set) {
  require_instruction_set(set);
#ifdef __x86_64__
  if (set == InstructionSet::kAvx2) {
    return chord_kernel_avx2();
  }
  if (set == InstructionSet::kAvx512) {
    return chord_kernel_avx512();
  }
#endif
  return {measure, scan};
}

}  // namespace haptrial::control
