#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

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

}  // namespace haptrial::sound
