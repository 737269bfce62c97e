#pragma once

#include "core/base/instruction_set.h"

namespace haptrial::analysis {

// Instruction sets of the alignment kernels. All of them give the same bits: the same operations in
// the same order, none contracted (docs/algorithms/alignment.md).
using haptrial::available_instruction_sets;
using haptrial::best_instruction_set;
using haptrial::InstructionSet;
using haptrial::name_of;

}  // namespace haptrial::analysis
