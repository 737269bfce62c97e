#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "analysis/bone_drilling/report/with_without.h"
#include "core/bone/hint/hint_setup.h"

namespace haptrial::record {
class SessionReader;
}

namespace haptrial::analysis::drilling {

/// Hints of one kind in a procedure.
struct HintCounts {
  int hints{0};
  int removals{0};   // that they were about
  double time{0.0};  // that they lasted [s]
};

/// One procedure of a session that gives hints. Hints that were not shown are recorded as well.
struct HintProcedure : GivenProcedure {
  std::array<HintCounts, hint::kHintKinds> kinds;  // by hint::HintKind

  const HintCounts& of(hint::HintKind kind) const { return kinds[static_cast<std::size_t>(kind)]; }
  int hints() const;
};

/// The procedures of a session in the order of trials, those of practice left out; none where it
/// gives no hints. @param summaries  of the session's procedures, for the time of drilling
/// @throws InputError where the file is damaged
std::vector<HintProcedure> load_hints(const record::SessionReader& file,
                                      std::span<const ProcedureSummary> summaries);

/// A row for each procedure and kind.
std::string hints_csv(std::span<const HintProcedure> procedures);

}  // namespace haptrial::analysis::drilling
