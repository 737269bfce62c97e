#pragma once

#include <array>
#include <cstdint>

#include "core/base/random.h"
#include "core/sound/spectrum_table.h"

namespace haptrial::sound {

/// sin(2 pi x / 2^64) by a polynomial, within 1e-11: the same bits on every machine, which the C
/// library does not promise.
double sine_of_turn(std::uint64_t x) noexcept;

/// A series of noisy harmonics, one sample after another:
///
///     x(t) = sum over i of a_i sin(phi_i) + noise,  phi_i' = 2 pi f_i + sqrt(2 pi b_i) w_i
///
/// with white noise w_i, which widens line i to a Lorentzian b_i wide at half its power. Phases
/// are never set back, so the sound has no break where a frequency glides. Lines at or above half
/// the sample rate, which it cannot carry, are left out, also when a pitch brings them there.
///
/// A pure function of the rate, the stream and the calls. One thread; no allocation, lock or throw.
/// Source: Morris 2006, §3.2.3.8 and §3.2.9; docs/algorithms/drill-sound.md.
class Harmonics {
 public:
  /// @param rate   samples per second, above 0 [Hz]
  /// @param glide  time constant with which lines follow aim() >= 0 [s]
  /// @throws std::invalid_argument for other numbers.
  Harmonics(double rate, const RandomStream& stream, double glide = 0.01);

  /// Sets the targets of the lines from now on.
  /// @param pitch     every frequency is multiplied by it >= 0
  /// @param loudness  every amplitude, and the noise, is multiplied by it >= 0
  void aim(const Spectrum& spectrum, double pitch, double loudness) noexcept;

  /// The next sample, in the unit of the spectrum's amplitudes.
  double next() noexcept;

 private:
  struct Line {
    std::uint64_t phase{0};  // 2^64 is a turn
    double frequency{0.0};   // [turns per sample]
    double amplitude{0.0};
    double spread{0.0};  // of the phase per sample [turns]
    double frequency_aim{0.0};
    double amplitude_aim{0.0};
  };

  double rate_;
  double follow_;  // share of the way to the aim per sample
  RandomStream stream_;
  std::array<Line, Spectrum::kMaxPeaks> lines_{};
  int count_{0};
  double noise_{0.0};
  double noise_aim_{0.0};
};

}  // namespace haptrial::sound
