#pragma once

#include <string_view>
#include <vector>

namespace haptrial {

/// What a kernel was compiled for. Kernels give the same bits on all of them (docs/decisions/0004).
enum class InstructionSet { kBaseline, kAvx2, kAvx512 };  // AVX2 with FMA; AVX-512 F, BW, DQ, VL

/// The sets that this machine can run, slowest first; kBaseline is always among them.
std::vector<InstructionSet> available_instruction_sets();
InstructionSet best_instruction_set();
std::string_view name_of(InstructionSet set);

/// @throws std::invalid_argument naming the set when this machine cannot run it.
void require_instruction_set(InstructionSet set);

}  // namespace haptrial
