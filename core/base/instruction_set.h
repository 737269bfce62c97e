#pragma once

#include <string_view>
#include <type_traits>
#include <vector>

namespace haptrial {

/// The instructions that a kernel was compiled for. Kernels give the same bits on all of them
/// (docs/decisions/0004).
enum class InstructionSet { kBaseline, kAvx2, kAvx512 };  // AVX2 with FMA; AVX-512 F, BW, DQ, VL

/// The sets that this machine can run, slowest first; kBaseline is always among them.
std::vector<InstructionSet> available_instruction_sets();
InstructionSet best_instruction_set();
std::string_view name_of(InstructionSet set);

/// @throws std::invalid_argument naming the set when this machine cannot run it.
void require_instruction_set(InstructionSet set);

/// A function that is compiled only for x86-64; elsewhere none.
#ifdef __x86_64__
#define HAPTRIAL_X86(function) (function)
#else
#define HAPTRIAL_X86(function) nullptr
#endif

/// The function that was compiled for `set`:
///
///     choose(set, sum_baseline, HAPTRIAL_X86(sum_avx2))
///
/// @param avx512  given where it makes something that a person waits for at least 1.5 times as
///                fast; otherwise AVX2's function serves there too
/// @throws std::invalid_argument naming the set when this machine cannot run it.
template <class Function>
Function* choose(InstructionSet set, Function* baseline, std::type_identity_t<Function>* avx2,
                 std::type_identity_t<Function>* avx512 = nullptr) {
  require_instruction_set(set);
  if (set == InstructionSet::kAvx512 && avx512 != nullptr) {
    return avx512;
  }
  return set == InstructionSet::kBaseline ? baseline : avx2;
}

}  // namespace haptrial
