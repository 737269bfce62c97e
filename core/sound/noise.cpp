#include "core/sound/noise.h"

#include <gsl/gsl_fft_halfcomplex.h>

#include <bit>
#include <cmath>
#include <stdexcept>

#include "core/base/random.h"

namespace haptrial::sound {

double amplitude_of(double level) noexcept { return std::pow(10.0, level / 20.0); }

std::vector<float> noise_loop(const NoiseColour& colour, std::size_t size, double rate,
                              double level, std::uint64_t seed, const std::string& name) {
  if (size < 16 || !std::has_single_bit(size)) {
    throw std::invalid_argument("noise_loop: size must be a power of two, 16 or more");
  }
  if (!(colour.low >= 0.0 && colour.high > colour.low && colour.high < 0.5 * rate)) {
    throw std::invalid_argument("noise_loop: low and high must rise and lie below half the rate");
  }
  RandomStream random(seed, name);
  const double bin = rate / static_cast<double>(size);
  std::vector<double> line(size, 0.0);  // GSL's half-complex order: real k, imaginary size - k
  double power = 0.0;
  for (std::size_t k = 1; k < size / 2; ++k) {
    const double frequency = bin * static_cast<double>(k);
    const double real = random.normal();
    const double imaginary = random.normal();
    if (frequency < colour.low || frequency > colour.high) {
      continue;
    }
    const double share = colour.kind == NoiseColour::Kind::kPink ? 1.0 / std::sqrt(frequency) : 1.0;
    line[k] = share * real;
    line[size - k] = share * imaginary;
    power += share * share * (real * real + imaginary * imaginary);
  }
  if (!(power > 0.0)) {
    throw std::invalid_argument("noise_loop: no line lies between low and high");
  }
  gsl_fft_halfcomplex_radix2_backward(line.data(), 1, size);
  const double scale = amplitude_of(level) / std::sqrt(2.0 * power);  // Parseval
  std::vector<float> samples(size);
  for (std::size_t i = 0; i < size; ++i) {
    samples[i] = static_cast<float>(scale * line[i]);
  }
  return samples;
}

}  // namespace haptrial::sound
