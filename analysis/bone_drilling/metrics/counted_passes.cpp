#include "analysis/bone_drilling/metrics/counted_passes.h"

#include "core/bone/record/drilling_tables.h"
#include "core/record/read/session_reader.h"

namespace haptrial::analysis::drilling {

std::map<std::int32_t, std::vector<CountedPass>> counted_passes(const record::SessionReader& file) {
  std::map<std::int32_t, std::vector<CountedPass>> trials;
  const std::vector<record::PassRow> passes = file.passes();
  for (std::size_t row = 0; row < passes.size(); ++row) {
    const record::PassRow& pass = passes[row];
    if (pass.practice || pass.phase != record::kDrillingPhase) {
      continue;
    }
    std::vector<CountedPass>& own = trials[pass.trial];
    if (!own.empty() && own.back().pass.repetition < pass.repetition) {
      own.clear();
    }
    own.push_back({row, pass});
  }
  return trials;
}

}  // namespace haptrial::analysis::drilling
