#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/record/read/session_reader.h"
#include "core/record/rows/session_types.h"
#include "core/record/rows/trial_facts.h"

namespace haptrial::record {

/// @throws InputError that names the first phase of /trials that is none of `known`
void check_phases(const SessionReader& file, std::span<const Phase> known);

/// Kind of the event of a session whose trials another program presented; its text names the file.
inline constexpr const char* kImportedEvent = "imported";

/// The table that a session was imported from, as its event says; empty: haptrial recorded it.
/// An imported session has no samples, and the numbers of its ticks count trials.
std::string imported_from(const SessionReader& reader);

/// Kind of the event of a session whose device and view were mirrored for a left-handed
/// participant, as design.mirror_left_handed says.
inline constexpr const char* kMirroredEvent = "mirrored";

/// Whether x of the session's tables runs to the participant's left, so that they can be compared
/// with those of right hands.
bool is_mirrored(const SessionReader& reader);

/// Kind of the event of a run of a curriculum's session: its case.
inline constexpr const char* kCaseEvent = "case";

/// The case that a session is of, by its events; empty: it has none, or a version before 0.3
/// recorded it.
std::string case_in(const std::vector<EventRow>& events);

/// "812 of 950 ticks (85.5 %) overran their period" where more than one tick in a hundred did. Each
/// gives its force late; beyond that share the readings from which velocity is estimated are no
/// longer even, and damping is not what the definition says.
std::optional<std::string> too_many_overruns(std::uint64_t ticks, std::uint64_t overruns);

/// How far a session has come in its study; practice counts nowhere.
struct TrialProgress {
  std::optional<int> planned;  // nothing where the file does not say it
  int done{0};                 // the last pass of the trial was completed
  int skipped{0};              // by the experimenter
  int aborted{0};              // begun, and neither done nor skipped
  std::string ended_early;     // why the session ended with trials left; empty: it did not
};

TrialProgress trial_progress(const SessionReader& reader);

/// The trials that were skipped for good, each once; in files of versions before 5 the events said
/// so.
std::vector<SkippedRow> skipped_trials(const SessionReader& reader);
/// The passes with reduced damping; in files of versions before 5 the events said so.
std::vector<DampingRow> reduced_damping(const SessionReader& reader);

}  // namespace haptrial::record
