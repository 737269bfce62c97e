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

namespace {

ChordKernel chord_kernel_baseline() { return {measure, scan}; }

}  // namespace

ChordKernel chord_kernel(InstructionSet set) {
  return choose(set, chord_kernel_baseline, HAPTRIAL_X86(chord_kernel_avx2))();
}

}  // namespace haptrial::control
