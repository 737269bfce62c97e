#include "core/bone/nerve/recorded_voice.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptrial::nerve {

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
