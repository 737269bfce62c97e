#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"

namespace haptrial::sound {

/// How the power of a noise is spread over frequencies.
struct NoiseColour {
  enum class Kind : std::uint8_t {
    kWhite,  // the same in every hertz
    kPink,   // 1 / f: the same in every octave, 3 dB less a hertz with each
    kBand,   // white between low and high, nothing outside
  };
  Kind kind{Kind::kWhite};
  double low{20.0};       // [Hz]
  double high{20'000.0};  // > low, below half the rate [Hz]
};

/// Gaussian noise, synthesised in the frequency domain: every line below `low` and above `high` is
/// exactly zero, those between have the power of the colour, each with a normal real and imaginary
/// part. Its end joins its beginning, so that it can be repeated without a click.
/// @param size   samples, a power of two of 16 or more
/// @param rate   [Hz]
/// @param level  of its root mean square over all samples, below full scale 1 [dB]
/// @throws std::invalid_argument naming what breaks its bound
std::vector<float> noise_loop(const NoiseColour& colour, std::size_t size, double rate,
                              double level, std::uint64_t seed, const std::string& name);

/// 10^(level / 20).
double amplitude_of(double level) noexcept;

/// A vibrotactile actuator on a channel of the sound card, as it was calibrated: what a signal of
/// full scale makes of it, with its amplifier and whoever wears it.
struct Actuator {
  std::string name;
  int channel{3};          // of the card, from 1
  double full_scale{1.0};  // peak that full scale gives > 0 [unit]
  std::string unit;        // "m/s²", "g", "N", as it was measured
  double lowest{20.0};     // frequencies for which that holds, 0 < lowest < highest [Hz]
  double highest{1000.0};
};

/// Reads [actuators.NAME] of a definition or lab file, in the order of the file; none without the
/// table. Problems are noted.
std::vector<Actuator> read_actuators(Table& root);

/// A short sound of a definition. Levels are root mean squares between the ramps, below full scale
/// 1; a sine that just fits has -3.01 dB.
struct Cue {
  enum class Kind : std::uint8_t {
    kTone,   // a sine
    kNoise,  // a burst
    kClick,  // a rectangular pulse
    kFile,   // a recording
  };
  std::string name;
  Kind kind{Kind::kTone};
  double frequency{1000.0};  // of a tone [Hz]
  NoiseColour colour;        // of a burst
  double duration{0.1};      // all but a recording [s]
  double level{-20.0};       // of a recording its gain [dB]
  double rise{0.005};        // raised cosine at both ends, of tone and burst [s]
  std::filesystem::path file;
  std::string actuator{};  // that gives it as a vibration; empty: loudspeakers play it
  double amplitude{0.0};  // of that vibration: a noise's root mean square, else the peak [its unit]
  bool varies{false};  // its numbers follow from the trial (read_varied_cues); here they are none
};

/// Noise that keeps the device's own sounds from being heard.
struct Masking {
  NoiseColour colour{.kind = NoiseColour::Kind::kPink};
  double level{-30.0};              // root mean square [dB]
  double fade{0.5};                 // at its beginning and end [s]
  std::vector<std::string> stages;  // in which it sounds; none: the whole session
};

/// The sounds of a definition.
struct CueSet {
  std::vector<Cue> cues;
  std::optional<Masking> masking;
  std::string device{"default"};  // ALSA's name of the card
  std::vector<Actuator> actuators{};
  bool empty() const { return cues.empty() && !masking; }
  /// Whether some of them are stimuli, without which a trial is another one: vibrations, and sounds
  /// that follow from the trial.
  bool has_stimuli() const {
    return std::ranges::any_of(cues,
                               [](const Cue& cue) { return cue.varies || !cue.actuator.empty(); });
  }
};

/// The samples of a cue at CardPlayer::kRate.
/// @param seed  of the session; noise is drawn from the stream "sound NAME"
/// @throws InputError if its file cannot be read or has another rate
std::vector<float> rendered(const Cue& cue, std::uint64_t seed);

/// A loop of about 22 s from the stream "sound masking".
std::vector<float> rendered(const Masking& masking, std::uint64_t seed);

}  // namespace haptrial::sound
