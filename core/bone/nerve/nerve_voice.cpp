#include "core/bone/nerve/nerve_voice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptrial::nerve {
namespace {

constexpr double kRawGain = 1000.0;   // 100 uV are a tenth of full scale [1/V]
constexpr double kRawMost = 0.3;      // louder is cut off
constexpr double kTone = 0.12;        // of full scale
constexpr double kFade = 0.005;       // of a tone [s]
constexpr double kStart = 0.02;       // of samples before they are played [s]
constexpr double kMostBehind = 0.06;  // then some are left out [s]

}  // namespace

NerveVoice::NerveVoice(double rate, double card) : step_(rate / card), card_(card) {}

void NerveVoice::take() noexcept {
  ticks_.flush([this](std::span<const VoiceTick> ticks) {
    for (const VoiceTick& tick : ticks) {
      for (std::size_t s = 0; s < tick.count; ++s) {
        raw_[written_++ % kAhead] = tick.raw[s];
      }
      for (std::size_t i = 0; i < kMostChannels; ++i) {
        frequency_[i] = static_cast<double>(tick.tones[i]);
      }
    }
  });
}

/// The next sample: between two ticks a line; silence while there are none.
float NerveVoice::next_raw() noexcept {
  const double rate = step_ * card_;
  const double behind = static_cast<double>(written_) - at_;
  if (!runs_ && behind >= kStart * rate) {
    runs_ = true;
  }
  if (behind > kMostBehind * rate) {  // the clocks of loop and card differ
    at_ = static_cast<double>(written_) - kStart * rate;
  }
  if (!runs_ || static_cast<double>(written_) - at_ < 2.0) {
    runs_ = false;
    return 0.0f;
  }
  const auto first = static_cast<std::uint64_t>(at_);
  const auto share = static_cast<float>(at_ - static_cast<double>(first));
  at_ += step_;
  return (1.0f - share) * raw_[first % kAhead] + share * raw_[(first + 1) % kAhead];
}

float NerveVoice::tones() noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < kMostChannels; ++i) {
    const double wanted = frequency_[i] > 0.0 ? kTone : 0.0;
    loudness_[i] += (wanted - loudness_[i]) / (kFade * card_);
    if (frequency_[i] > 0.0) {
      phase_[i] = std::fmod(phase_[i] + frequency_[i] / card_, 1.0);
    }
    sum += loudness_[i] * std::sin(2.0 * std::numbers::pi * phase_[i]);
  }
  return static_cast<float>(sum);
}

void NerveVoice::mix(std::span<float> part) noexcept {
  take();
  for (float& sample : part) {
    const double raw = std::clamp(kRawGain * static_cast<double>(next_raw()), -kRawMost, kRawMost);
    sample = std::clamp(sample + static_cast<float>(raw) + tones(), -1.0f, 1.0f);
  }
}

}  // namespace haptrial::nerve
