#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "experiments/study/next_case.h"
#include "protocols/interface/protocol.h"
#include "protocols/tutoring/model_motion.h"

namespace haptrial::experiments {

/// A dry run: the whole study with virtual subjects on a simulated clock.
struct DryRun {
  int participants{0};
  std::uint64_t seed{1};
  int jobs{1};
  int frames_per_pass{0};
  int max_trials{0};  // of each session; 0: all
  int session{0};     // of each participant; 0: all of the definition, in their order
  std::optional<protocols::TutorChoice> tutor;  // see SessionRequest
  bool taught{false};                // each participant by a second one over a simulated network
  std::filesystem::path folder;      // created; one session file per participant
  std::filesystem::path definition;  // file, whose plan is copied there; empty: it has none
  /// The folder is the state: finished sessions stay and are not run again. Without frames, tutor
  /// and teachers.
  bool parts{false};
  /// Cases of a study with a curriculum: each participant's sessions follow from those before.
  FindCase find_case{};
  double start{0.0};  // of parts: share of the sessions that comes last
};

struct DryRunSummary {
  int sessions{0};  // that were run
  std::uint64_t ticks{0};
  int passes{0};
  int aborted_passes{0};
  int given_up{0};  // sessions that ended with trials left, since too many were never completed
  double recorded_seconds{0.0};  // simulated time
  double elapsed_seconds{0.0};   // on the wall
};

/// Participants are shared out over threads; the files do not depend on how many.
/// Where anything fails the other sessions are stopped and, but for parts, nothing is left.
/// @throws InputError when the folder exists, or is of other parts, or cannot be made.
DryRunSummary run_dry(const protocols::Protocol& protocol, const protocols::Definition& definition,
                      const DryRun& dry_run);

/// One session of a study.
struct PlannedSession {
  int participant{0};  // from 0
  int session{1};      // of the participant, from 1
};
/// The sessions to which participants come, participant after participant.
/// @param session  that one alone; 0: all
std::vector<PlannedSession> planned_sessions(const protocols::Definition& definition,
                                             int participants, int session = 0);

/// "S01" for participant 0.
std::string participant_name(int participant);

/// The session files of a folder, sorted by name.
/// @throws InputError when the folder is absent or holds none.
std::vector<std::filesystem::path> session_files(const std::filesystem::path& folder);

}  // namespace haptrial::experiments
