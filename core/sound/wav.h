#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/sound/drill_sound.h"

namespace haptrial::sound {

/// A sound in one channel.
struct Recording {
  double rate{0.0};            // samples per second [Hz]
  std::vector<float> samples;  // full scale is from -1 to 1
};

/// Reads what libsndfile reads (WAV, FLAC, AIFF, ...); several channels become their mean.
/// @throws InputError when the file is absent, no sound, empty, not finite or over an hour long.
Recording read_recording(const std::filesystem::path& file);

/// The channels of a recording one by one. @throws InputError as read_recording() does
std::vector<Recording> read_channels(const std::filesystem::path& file);

/// A WAV file of 16 bits in one channel, written bit by bit: under another name first, which
/// finish() changes; without that nothing is left.
class WavWriter {
 public:
  /// @throws InputError where the file is there (unless it may be replaced) or cannot be made.
  WavWriter(std::filesystem::path file, int rate, bool overwrite = false);
  ~WavWriter();
  WavWriter(const WavWriter&) = delete;
  WavWriter& operator=(const WavWriter&) = delete;

  /// Values beyond full scale are cut off. @throws RunError, as on a full disk.
  void write(std::span<const float> samples);
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The sound of a drill from what it did, as a session's record gives it, into a WAV file. The same
/// states, table and seed give the same bytes.
class SoundTrack {
 public:
  /// Adds what else is heard to the next samples.
  using Mix = std::function<void(std::span<float>)>;

  /// @param rate  of the states > 0, at most 48 kHz [Hz]
  /// @param mix   may be empty
  /// @throws as WavWriter and DrillSound do, and std::invalid_argument for another rate.
  SoundTrack(const std::filesystem::path& file, double rate, SpectrumTable table,
             const ThinBone& thin, std::uint64_t seed, bool overwrite = false, Mix mix = {});
  /// The next state, which lasts 1 / rate seconds.
  void add(const DrillState& drill);
  void finish() { writer_.finish(); }

 private:
  double rate_;
  DrillSound sound_;
  WavWriter writer_;
  Mix mix_;
  std::uint64_t states_{0};
  std::uint64_t samples_{0};
  std::vector<float> buffer_;
};

}  // namespace haptrial::sound
