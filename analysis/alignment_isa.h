#pragma once

#include <string_view>
#include <vector>

namespace haptrial::analysis {

/// What a kernel was compiled for. All of them give the same bits: the same operations in the same
/// order, none contracted (docs/algorithms/alignment.md).
enum class InstructionSet { kBaseline, kAvx2, kAvx512 };

/// The sets that this machine can run, slowest first; kBaseline is always among them.
std::vector<InstructionSet> available_instruction_sets();
InstructionSet best_instruction_set();
std::string_view name_of(InstructionSet set);

}  // namespace haptrial::analysis
