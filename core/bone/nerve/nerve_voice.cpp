#include "core/bone/nerve/nerve_voice.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

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

using record::NerveEventRow;

RecordedVoice::RecordedVoice(Record record, const MonitorParameters& monitor, std::size_t channels,
                             double card)
    : record_(std::move(record)),
      monitor_(monitor),
      channels_(std::min(channels, kMostChannels)),
      voice_(monitor.rate, card) {}

/// Events are few and closed soon: those from here on are looked at until one began later.
bool RecordedVoice::tone(std::size_t channel, std::uint64_t sequence) const {
  const auto later = [](std::uint64_t tick, const NerveEventRow& row) {
    return tick < row.sequence;
  };
  const auto first =
      std::upper_bound(record_.events.begin(), record_.events.end(), sequence, later);
  return std::any_of(first, record_.events.end(), [&](const NerveEventRow& row) {
    return static_cast<std::size_t>(row.channel) == channel && row.begin <= sequence &&
           row.kind != NerveEventRow::Kind::kArtefact;
  });
}

void RecordedVoice::tick(std::uint64_t sequence, std::span<const record::EmgRow> samples,
                         bool heard) {
  for (; next_setting_ < record_.thresholds.size() &&
         record_.thresholds[next_setting_].sequence <= sequence;
       ++next_setting_) {
    const record::NerveThresholdRow& row = record_.thresholds[next_setting_];
    muted_[static_cast<std::size_t>(row.channel) % kMostChannels] = row.muted;
  }
  VoiceTick voice;
  voice.count = static_cast<std::uint16_t>(std::min(samples.size(), voice.raw.size()));
  for (std::size_t i = 0; heard && i < channels_; ++i) {
    if (muted_[i]) {
      continue;
    }
    const double frequency =
        monitor_.lowest_tone * std::pow(monitor_.tone_step, static_cast<double>(i));
    voice.tones[i] = tone(i, sequence) ? static_cast<float>(frequency) : 0.0F;
    for (std::size_t s = 0; s < voice.count; ++s) {
      voice.raw[s] += static_cast<float>(samples[s].channels[i]);
    }
  }
  voice_.push(voice);
}

}  // namespace haptrial::nerve
