#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>

namespace haptrial::record {

/// Part of a pass that the participant's hand is in.
enum class Stage : std::uint8_t { kIdle, kApproach, kWait, kRun, kReturn };

/// One servo tick: a row of /samples. Trivially copyable; goes through the block log.
struct Sample {
  std::uint64_t sequence{0};                          // tick number from 0; a gap would be a loss
  std::int64_t time_ns{0};                            // since the session's first tick [ns]
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  // p_W [m]
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};  // v_W [m/s]
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};     // commanded to the device, in W [N]
  double applied_force{0.0};  // normal force that the participant applies, downward > 0 [N]
  double target_force{0.0};   // [N]
  std::int32_t pass{-1};      // row of /trials; -1 between passes
  Stage stage{Stage::kIdle};
  bool saturated{false};  // the force limit was reached
};

/// Purpose of a pass within its trial: a word of the protocol, as /trials has it.
class Phase {
 public:
  static constexpr std::size_t kBytes = 16;
  static const Phase kTraining;
  static const Phase kTest;

  constexpr Phase() noexcept = default;
  /// @throws std::invalid_argument for more than 15 bytes
  explicit constexpr Phase(std::string_view name) {
    if (name.size() >= kBytes) {
      throw std::invalid_argument("the name of a phase has more than 15 bytes");
    }
    std::copy(name.begin(), name.end(), name_.begin());
  }
  constexpr const char* name() const noexcept { return name_.data(); }
  bool operator==(const Phase&) const = default;
  auto operator<=>(const Phase&) const = default;

 private:
  std::array<char, kBytes> name_{};
};
inline constexpr Phase Phase::kTraining{"training"};
inline constexpr Phase Phase::kTest{"test"};

constexpr const char* name_of(const Phase& phase) noexcept { return phase.name(); }

/// A completed pass of which samples were lost with the file's chunks is damaged: what it answered
/// has had its effect, and its samples are not to be analysed.
enum class PassStatus : std::uint8_t { kCompleted, kAborted, kDamaged };

/// Word of a status in /trials.
constexpr const char* name_of(PassStatus status) noexcept {
  switch (status) {
    case PassStatus::kAborted:
      return "aborted";
    case PassStatus::kDamaged:
      return "damaged";
    case PassStatus::kCompleted:
      break;
  }
  return "completed";
}

/// One pass, a row of /trials. A trial has a pass of each phase of its protocol, and more if it was
/// broken off and went on.
struct PassRow {
  std::int32_t trial{0};  // from 1
  std::string condition;  // of the block: a word of the protocol
  Phase phase{Phase::kTraining};
  std::int32_t block{0};       // from 1; of practice -1, -2, ..., one for each stimulus
  std::int32_t repetition{0};  // from 1 within the block; of a drilling the number of its bone
  std::uint64_t stimulus_seed{0};
  std::uint64_t first_sample{0};  // sequence numbers, both inclusive
  std::uint64_t last_sample{0};
  PassStatus status{PassStatus::kCompleted};
  bool practice{false};     // not part of the study: no analysis counts it
  std::int32_t attempt{1};  // from 1; an aborted trial that was queued again has 2, 3, ...
};

inline constexpr const char* kSessionResumed = "session_resumed";  // a kind: a run that goes on

struct EventRow {
  std::int64_t time_ns{0};
  std::string kind;  // "session_start", "break", "overrun", "fault", ...
  std::string text;
};

/// The stimulus of one block on a common time base, rows of /stimuli.
struct StimulusRow {
  std::int32_t block{0};
  double time{0.0};                                   // since the start of the run [s]
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  // ideal p_W [m]
  double force{0.0};                                  // target normal force [N]
};

/// One drawn frame of the participant's screen, a row of /frames.
struct FrameRow {
  std::int64_t time_ns{0};        // when it was shown, since the session's first tick [ns]
  std::int64_t frame_time_ns{0};  // what drawing it took [ns]
  std::int32_t dropped{0};        // refreshes of the screen missed since the frame before
};

/// How the loop kept time. Histogram counts go with the bin edges below them.
struct TimingRow {
  std::int64_t bin_low_ns{0};
  std::int64_t bin_high_ns{0};
  std::uint64_t period_count{0};
  std::uint64_t lateness_count{0};
  std::uint64_t compute_count{0};
};

/// Counts of the loop over the whole session; attributes of /timing.
struct TimingSummary {
  std::uint64_t ticks{0};     // ticks that the loop ran: rows that /samples must have
  std::uint64_t overruns{0};  // ticks that began after their period had passed
  std::uint64_t dropped{0};   // records that the loop could not hand over
};

/// The participant of a session; root attributes participant_*. Texts are those of the study's
/// form; a text that was not asked for stays empty. There is no field for a name, nor for the
/// experimenter's.
struct Participant {
  std::string identifier;
  std::string handedness;  // "right", "left", ...
  std::string age_band;    // "18-25", ...
  std::string sex;
  std::string consent_confirmed;  // "yes", or a date
  std::string notes;
};

/// Kinds of the events of a session that ended with trials left; their text says why.
inline constexpr const char* kEndedForGood = "ended_for_good";  // by the experimenter
inline constexpr const char* kGivenUp = "given_up";  // too many trials were never completed

/// Root attributes of a session file.
struct SessionInfo {
  std::string program_version;
  std::string program_commit;
  std::string definition;       // the experiment definition as text, whole
  std::string definition_name;  // file name it came from
  std::string subject;          // identifier
  std::uint64_t seed{0};
  std::string device;                   // device name
  double device_max_force{0.0};         // [N]
  double device_workspace_radius{0.0};  // [m]
  std::string clock;                    // "real" or "simulated"
  double rate{1000.0};                  // [Hz]
  std::string start_utc;                // ISO 8601, "2026-11-20T09:30:00Z"
  bool simulated{true};                 // the participant is a virtual subject
  bool pilot{false};                    // tried before the study: no part of it
  std::uint64_t session{1};             // of the participant, from 1: studies may take several days
  std::uint64_t participant_number{
      0};  // that chose the orders, or place in imported tables, from 1; 0: not recorded
  Participant participant{};

  /// No two sessions have it in common: files with the same one are copies.
  auto identity() const { return std::tuple(subject, session, seed, start_utc); }
  using Identity = std::tuple<std::string, std::uint64_t, std::uint64_t, std::string>;
};

/// How a run of a session stands: from one start of the program to its end.
enum class RunState : std::uint8_t {
  kRunning,  // or it was killed
  kStopped,  // it ended in order, and the session goes on in another run
  kEnded     // as did the session
};

/// Word of a state in /runs.
constexpr const char* name_of(RunState state) noexcept {
  switch (state) {
    case RunState::kStopped:
      return "stopped";
    case RunState::kEnded:
      return "ended";
    case RunState::kRunning:
      break;
  }
  return "running";
}

/// Counts of the loop of one run so far, a row of /runs; the last row of a run counts.
struct RunRow {
  std::int32_t run{1};            // from 1
  std::uint64_t first_sample{0};  // sequence number of its first tick
  TimingSummary counts;           // of this run
  std::int32_t planned{-1};       // trials of the study; -1: not known
  RunState state{RunState::kRunning};
};

/// Facts of a pass that are known when it begins, a row of /begun: a kill in mid-pass would lose
/// them.
struct BegunRow {
  std::int32_t row{0};  // that it gets in /trials
  PassRow pass;         // without its samples and its status
};

}  // namespace haptrial::record
