#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "core/base/definition/schema_forward.h"
#include "core/base/tool_state.h"
#include "core/realtime/latest_value.h"
#include "core/sound/card_player.h"
#include "core/sound/harmonics.h"

namespace haptrial::sound {

/// Pitch against the thickness of bone: 1 where it is thick, and
///
///     1 + rise (1 - thickness / threshold)   below the threshold.
///
/// Source: Morris 2006, §3.2.9, which chose both by ear and from its recordings.
struct ThinBone {
  double threshold{2e-3};  // > 0 [m]
  double rise{0.3};        // of the pitch where no bone is left >= 0
};

/// Audible state of a drill. Plain data.
struct DrillState {
  Burr burr{Burr::kCutting};
  double speed{0.0};               // of its full speed, 0 (off) to 1
  bool contact{false};             // touches bone
  double force{0.0};               // with which it presses on bone >= 0 [N]
  double thickness{1.0};           // of the bone under the burr >= 0 [m]
  std::optional<ThinBone> thin{};  // in place of the sound's own, while it is tuned
};

/// Pitch over that of thick bone.
double pitch(const ThinBone& thin, const DrillState& drill) noexcept;

/// The keys of [sound] about thin bone.
const Schema<ThinBone>& thin_bone_schema();

/// The sound of a drill, sample by sample. Frequencies and amplitudes follow the drill's speed.
/// One thread; no allocation, lock or throw after construction.
class DrillSound {
 public:
  static constexpr double kRate = 48'000.0;  // [Hz]

  /// @throws std::invalid_argument as check(table) does, and for thin bone out of its bounds.
  DrillSound(SpectrumTable table, const ThinBone& thin, std::uint64_t seed);

  void set(const DrillState& drill) noexcept;
  /// The next sample from -1 to 1: louder sound is cut off.
  float next() noexcept;

 private:
  SpectrumTable table_;
  ThinBone thin_;
  Harmonics harmonics_;
};

/// The vibration of a drill as a force on the hand, across the drill's axis (along x of the tool
/// frame T), at the rate of the servo loop. Servo thread: no allocation, lock or throw.
/// Source: Morris 2006, §3.2.3.8.
class DrillVibration {
 public:
  /// @param rate  of the servo loop > 0 [Hz]
  /// @param gain  >= 0; multiplies the table's amplitudes
  /// @throws std::invalid_argument as check(table) does, and for another rate or gain.
  DrillVibration(SpectrumTable table, double gain, double rate, std::uint64_t seed);

  /// @returns the force of this tick on the tool in W [N]; zero where the tool is not finite.
  Eigen::Vector3d tick(const DrillState& drill, const ToolState& tool) noexcept;
  /// Another gain from now on, finite and >= 0; lines glide to their new amplitudes.
  void set_gain(double gain) noexcept { gain_ = gain; }

 private:
  SpectrumTable table_;
  double gain_;
  Harmonics harmonics_;
};

/// Plays a drill on the sound card while it runs, from a thread of its own.
class SoundOutput {
 public:
  /// Adds to the next samples of the drill; called on the player's thread.
  using Mix = std::function<void(std::span<float>)>;

  /// @param device  a name of ALSA's ("default", "hw:0")
  /// @param mix     what else is heard; may be empty
  /// @throws RunError with a sentence where there is no such card, as on a server; a session goes
  /// on without, and its sound can be made from its record (SoundTrack). Else as DrillSound does.
  SoundOutput(SpectrumTable table, const ThinBone& thin, std::uint64_t seed,
              const std::string& device = "default", Mix mix = {});
  SoundOutput(const SoundOutput&) = delete;
  SoundOutput& operator=(const SoundOutput&) = delete;

  /// Sets the state of the drill from now on. Servo thread: no allocation, lock, wait or throw.
  void set(const DrillState& drill) noexcept { latest_.write(drill); }

  /// Counts of CardPlayer. Any thread.
  std::uint64_t played() const noexcept { return player_.played(); }
  bool lost() const noexcept { return player_.lost(); }

 private:
  void fill(std::span<float> part) noexcept;

  DrillSound sound_;
  Mix mix_;
  DrillState drill_;  // of the player's thread
  realtime::LatestValue<DrillState> latest_;
  CardPlayer player_;  // last: its thread uses the others
};

}  // namespace haptrial::sound
