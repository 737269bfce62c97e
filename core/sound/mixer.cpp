#include "core/sound/mixer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptrial::sound {

Limiter::Limiter(double rate) : back_(1.0 / (0.05 * rate)) {}

float Limiter::limited(double sample) noexcept {
  if (!std::isfinite(sample)) {
    return 0.0F;
  }
  gain_ = std::min(1.0, gain_ + back_);
  const double size = std::abs(sample);
  if (size * gain_ > 1.0) {
    gain_ = 1.0 / size;
  }
  return static_cast<float>(std::clamp(gain_ * sample, -1.0, 1.0));
}

Mixer::Mixer(std::vector<std::vector<float>> clips, std::vector<float> masking, double fade,
             double rate)
    : fixed_(clips.size()),
      masking_(std::move(masking)),
      step_(fade * rate > 1.0 ? 1.0 / (fade * rate) : 1.0),
      fade_(std::max(1, static_cast<int>(0.005 * rate))),
      limiter_(rate) {
  for (std::vector<float>& clip : clips) {
    clips_.push_back(std::make_shared<const std::vector<float>>(std::move(clip)));
  }
}

void Mixer::take_further(const std::vector<Clip>& clips) {
  clips_.resize(fixed_);
  clips_.insert(clips_.end(), clips.begin(), clips.end());
}

void Mixer::still() noexcept {
  for (Voice& voice : voices_) {
    voice.left = voice.left < 0 ? fade_ : voice.left;
  }
}

void Mixer::start(std::size_t clip) noexcept {
  if (clip >= clips_.size()) {
    return;
  }
  auto voice = std::ranges::find(voices_, nullptr, &Voice::clip);
  if (voice == voices_.end()) {
    voice = voices_.begin() + static_cast<std::ptrdiff_t>(oldest_);
    oldest_ = (oldest_ + 1) % kMostVoices;
  }
  *voice = {clips_[clip], 0};
}

bool Mixer::sounds() const noexcept {
  const bool clip =
      std::ranges::any_of(voices_, [](const Voice& voice) { return voice.clip != nullptr; });
  return clip || (!masking_.empty() && (masked_ || gain_ > 0.0));
}

double Mixer::next() noexcept {
  double sum = 0.0;
  for (Voice& voice : voices_) {
    if (voice.clip != nullptr) {
      const double gain = voice.left < 0 ? 1.0 : static_cast<double>(voice.left--) / fade_;
      sum += gain * (*voice.clip)[voice.at++];
      if (voice.at >= voice.clip->size() || voice.left == 0) {
        voice.clip = nullptr;
      }
    }
  }
  gain_ = masked_ ? std::min(1.0, gain_ + step_) : std::max(0.0, gain_ - step_);
  if (gain_ > 0.0 && !masking_.empty()) {
    sum += gain_ * masking_[place_];
    place_ = (place_ + 1) % masking_.size();
  }
  return sum;
}

void Mixer::fill(std::span<float> samples) noexcept {
  std::uint64_t held = 0;
  for (float& sample : samples) {
    sample = limiter_.limited(next());
    held += limiter_.acts() ? 1 : 0;
  }
  limited_.fetch_add(held, std::memory_order_relaxed);
}

}  // namespace haptrial::sound
