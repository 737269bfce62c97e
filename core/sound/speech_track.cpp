#include "core/sound/speech_track.h"

#include <algorithm>
#include <utility>

namespace haptrial::sound {

SpeechTrack::SpeechTrack(double rate) : fade_(std::max(1, static_cast<int>(0.005 * rate))) {}

void SpeechTrack::start(std::vector<float> clip) {
  clip_ = std::move(clip);
  at_ = 0;
  left_ = -1;
}

void SpeechTrack::stop() noexcept { left_ = left_ < 0 ? fade_ : left_; }

void SpeechTrack::add(std::span<float> samples) noexcept {
  for (float& sample : samples) {
    if (!sounds()) {
      return;
    }
    const float gain = left_ < 0 ? 1.0F : static_cast<float>(left_--) / static_cast<float>(fade_);
    sample = std::clamp(sample + gain * clip_[at_++], -1.0F, 1.0F);
    if (left_ == 0) {
      at_ = clip_.size();
    }
  }
}

}  // namespace haptrial::sound
