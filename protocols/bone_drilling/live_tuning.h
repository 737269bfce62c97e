#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "core/bone/record/tool_rows.h"
#include "core/bone/simulator/simulator.h"
#include "core/realtime/latest_value.h"
#include "core/sound/drill_sound.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::protocols {

/// Constants of feel, sound and removal that tunable keys set, in the terms of the tick. Plain
/// data.
struct TunedValues {
  bone::Tuning simulator{};
  double vibration_gain{0.0};
  sound::ThinBone thin_bone{};
};
TunedValues tuned_values(const BoneDefinition& definition) noexcept;

/// The text of a definition in which a key has another value.
std::string tuned_text(std::string_view text, std::string_view file_name, const std::string& key,
                       double value);

/// A tick from which on the changes up to a number hold. Goes through a block log.
struct TakenTuning {
  std::uint64_t sequence{0};
  std::uint64_t number{0};
};

/// Tunable keys of a definition while a pilot runs: the page changes them, the servo thread takes
/// the newest values between two ticks, the session's thread records what was taken. A change is
/// read as the definition would be, so that bounds and sentences are those of its keys.
class LiveTuning {
 public:
  explicit LiveTuning(const BoneDefinition& definition);

  // Any thread but the servo's. -------------------------------------------------------------------

  /// Gives a tunable key another value.
  /// @throws InputError for a key that is not tunable, or a value that the definition does not take
  void change(const std::string& key, double value);
  struct View {
    std::uint64_t changes{0};          // asked for so far
    std::uint64_t taken{0};            // of them
    std::vector<TunableKey> at_first;  // keys with the values of the definition
    std::vector<TunableKey> now;       // the same keys with the newest values
    std::string contact;               // how stiff bone is and may be, a sentence; empty: no burr
    std::string file_name;             // of the definition
    std::string text;                  // of the tuned definition; it needs no lab file
  };
  View view() const;

  // Servo thread: no allocation, lock, wait or throw. ---------------------------------------------

  /// Takes the newest values, but not while the force is on its way to those before.
  /// @param vibration  of the burr; null: it does not shake
  /// @returns the number of changes that hold from this tick on; 0: none is new
  std::uint64_t take(bone::Simulator& simulator, sound::DrillVibration* vibration) noexcept;
  const sound::ThinBone& thin_bone() const noexcept { return taken_.values.thin_bone; }

  // Session's thread, while no pass runs. ---------------------------------------------------------

  /// Gives a new simulator, and what shakes its burrs, the values that were taken last.
  void begin(bone::Simulator& simulator, sound::DrillVibration* vibration) noexcept;
  /// The rows of changes that were taken; also while a pass runs.
  std::vector<record::TuningRow> rows_of(std::span<const TakenTuning> taken);

 private:
  struct NumberedValues {
    std::uint64_t number{0};
    TunedValues values{};
  };
  struct Change {
    std::string key;
    double before;
    double after;
  };
  void read(const BoneDefinition& definition);

  mutable std::mutex mutex_;  // never taken by the servo thread
  std::string file_name_;
  std::string text_;
  std::vector<TunableKey> at_first_;
  std::vector<TunableKey> now_;
  std::string contact_;
  std::vector<Change> changes_;
  std::size_t recorded_{0};  // of changes_; the session's thread
  realtime::LatestValue<NumberedValues> latest_;
  NumberedValues taken_;  // the servo thread's
  std::atomic<std::uint64_t> taken_number_{0};
};

/// The tunings of a recorded pilot, for a replay of it.
class RecordedTuning {
 public:
  /// @param rows   of /tuning; they outlive it
  /// @param first  tick that is simulated: changes before it hold already
  RecordedTuning(const BoneDefinition& definition, std::span<const record::TuningRow> rows,
                 std::uint64_t first);

  /// Gives a new simulator the values that hold, if any changed.
  void begin(bone::Simulator& simulator) const;
  /// Gives it those of this tick, if one changed on it. Ticks ascend.
  void step(bone::Simulator& simulator, std::uint64_t sequence);

 private:
  bool apply_until(std::uint64_t end);

  std::string file_name_;
  std::string text_;
  std::span<const record::TuningRow> rows_;
  std::size_t next_{0};
};

}  // namespace haptrial::protocols
