#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/psychometric/definition/track.h"
#include "core/psychometric/definition/track_keys.h"

namespace haptrial::psychometric {

/// One kind of procedure: what its `kind` says, and how its keys are read.
struct ProcedureKind {
  std::string word;
  /// Reads the keys of the kind, of which track_keys.h has those that kinds share, and sets how the
  /// track begins and what else a Track says. Problems are noted.
  void (*read)(const TrackKeys& keys, Track& track);
  OutcomeForm learns{OutcomeForm::kAnswer};
  /// Key that names what a level sets. If it is another one than `variable`, read() reads it, and
  /// the keys `variable`, `resolution` and `expect` are unknown.
  std::string variables{"variable"};

  bool sets_one_variable() const { return variables == "variable"; }
};

/// Every kind that read_tracks() knows. Call before threads are started.
const std::vector<ProcedureKind>& kinds_of_procedure();

/// @throws std::out_of_range for an unknown word
const ProcedureKind& kind_of_procedure(std::string_view word);

/// Adds a kind of a program's own.
/// @throws std::invalid_argument for a word that is taken
void add_kind_of_procedure(const ProcedureKind& kind);

}  // namespace haptrial::psychometric
