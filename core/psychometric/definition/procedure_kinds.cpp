#include "core/psychometric/definition/procedure_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/psychometric/definition/read_procedures.h"

namespace haptrial::psychometric {
namespace {

std::vector<ProcedureKind>& all_kinds() {
  static std::vector<ProcedureKind> kinds{
      {"staircase", read_staircase},
      {"limits", read_limits},
      {"pest", read_pest},
      {"psi", read_psi},
      {"quest_plus", read_quest, OutcomeForm::kAnswer, "stimulus"},
      {"surface", read_surface, OutcomeForm::kAnswer, "stimulus"},
      {"constant", read_constant},
      {"adjustment", read_adjustment, OutcomeForm::kAdjustment},
      {"magnitude", read_magnitude, OutcomeForm::kMagnitude},
  };
  return kinds;
}

}  // namespace

const std::vector<ProcedureKind>& kinds_of_procedure() { return all_kinds(); }

const ProcedureKind& kind_of_procedure(std::string_view word) {
  const auto found = std::ranges::find(all_kinds(), word, &ProcedureKind::word);
  if (found == all_kinds().end()) {
    throw std::out_of_range(fmt::format("kind_of_procedure: there is no procedure '{}'", word));
  }
  return *found;
}

void add_kind_of_procedure(const ProcedureKind& kind) {
  if (std::ranges::find(all_kinds(), kind.word, &ProcedureKind::word) != all_kinds().end()) {
    throw std::invalid_argument(
        fmt::format("add_kind_of_procedure: there is a procedure '{}' already", kind.word));
  }
  all_kinds().push_back(kind);
}

}  // namespace haptrial::psychometric
