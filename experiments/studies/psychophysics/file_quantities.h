#pragma once

#include <filesystem>
#include <vector>

#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::protocols {
struct TrialsDefinition;
}

namespace haptrial::experiments {

/// Adds the quantities of kinds that look at what hands did or at pairs: "reaching", "pursuit",
/// "produced" and "paired". Other kinds have theirs from the answers already.
/// @param files  of the sessions in `result`
/// @throws InputError as the analyses of these kinds do
void add_file_quantities(const protocols::TrialsDefinition& definition,
                         const std::vector<std::filesystem::path>& files, int threads,
                         analysis::trials::TrialsResult& result);

}  // namespace haptrial::experiments
