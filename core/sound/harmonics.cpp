#include "core/sound/harmonics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::sound {
namespace {

constexpr double kTurn = 18446744073709551616.0;  // 2^64
constexpr double kPi = 3.14159265358979323846;

/// A part of a turn, from -1/2 to 1/2, as a step of the phase.
std::uint64_t to_phase(double turns) noexcept {
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(turns * kTurn));
}

}  // namespace

double sine_of_turn(std::uint64_t x) noexcept {
  // A signed part of a turn from -1/2 to 1/2, folded to a quarter turn around 0.
  const double part = static_cast<double>(static_cast<std::int64_t>(x)) / kTurn;
  const double folded = part > 0.25 ? 0.5 - part : part < -0.25 ? -0.5 - part : part;
  const double a = 2.0 * kPi * folded;
  const double s = a * a;
  // Taylor's series up to a^15: the next term is below 7e-12 at a right angle.
  double sum = -1.0 / 1307674368000.0;
  sum = sum * s + 1.0 / 6227020800.0;
  sum = sum * s - 1.0 / 39916800.0;
  sum = sum * s + 1.0 / 362880.0;
  sum = sum * s - 1.0 / 5040.0;
  sum = sum * s + 1.0 / 120.0;
  sum = sum * s - 1.0 / 6.0;
  return a + a * s * sum;
}

Harmonics::Harmonics(double rate, const RandomStream& stream, double glide)
    : rate_(rate), follow_(1.0 / (1.0 + glide * rate)), stream_(stream) {
  if (!(rate > 0.0 && std::isfinite(rate) && glide >= 0.0 && std::isfinite(glide))) {
    throw std::invalid_argument(
        "Harmonics: the rate must be above 0 Hz and the glide not below 0 s");
  }
  for (Line& line : lines_) {
    line.phase = stream_.bits();
  }
}

void Harmonics::aim(const Spectrum& spectrum, double pitch, double loudness) noexcept {
  for (int i = 0; i < std::max(count_, spectrum.count); ++i) {
    Line& line = lines_[static_cast<std::size_t>(i)];
    const Peak peak = i < spectrum.count ? spectrum.peaks[static_cast<std::size_t>(i)] : Peak{};
    const double frequency = pitch * peak.frequency / rate_;  // [turns per sample]
    if (!(frequency < 0.5 && i < spectrum.count)) {
      line.amplitude_aim = 0.0;  // fades where it was
      continue;
    }
    if (line.amplitude == 0.0) {
      line.frequency = frequency;  // silent: nothing to glide from
    }
    line.frequency_aim = frequency;
    line.amplitude_aim = loudness * peak.amplitude;
    // phi += sqrt(2 pi b / rate) w radians a sample.
    line.spread = std::sqrt(2.0 * kPi * pitch * peak.bandwidth / rate_) / (2.0 * kPi);
  }
  count_ = std::max(count_, spectrum.count);
  noise_aim_ = loudness * spectrum.noise;
}

double Harmonics::next() noexcept {
  constexpr double kSilent = 1e-9;
  double sum = 0.0;
  for (int i = 0; i < count_; ++i) {
    Line& line = lines_[static_cast<std::size_t>(i)];
    line.amplitude += follow_ * (line.amplitude_aim - line.amplitude);
    if (line.amplitude_aim == 0.0 && line.amplitude < kSilent) {
      line.amplitude = 0.0;
      continue;
    }
    line.frequency += follow_ * (line.frequency_aim - line.frequency);
    const double step = line.frequency + (line.spread > 0.0 ? line.spread * stream_.normal() : 0.0);
    line.phase += to_phase(std::clamp(step, -0.49, 0.49));
    sum += line.amplitude * sine_of_turn(line.phase);
  }
  noise_ += follow_ * (noise_aim_ - noise_);
  return noise_ > 0.0 ? sum + noise_ * stream_.normal() : sum;
}

}  // namespace haptrial::sound
