#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/sound/actuator.h"
#include "core/sound/noise.h"

namespace haptrial::sound {

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
};

/// The samples of a cue at CardPlayer::kRate.
/// @param seed  of the session; noise is drawn from the stream "sound NAME"
/// @throws InputError if its file cannot be read or has another rate
std::vector<float> rendered(const Cue& cue, std::uint64_t seed);

/// A loop of about 22 s from the stream "sound masking".
std::vector<float> rendered(const Masking& masking, std::uint64_t seed);

}  // namespace haptrial::sound
