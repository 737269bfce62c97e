#include "core/sound/card_player.h"

#include <alsa/asoundlib.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/base/error.h"

namespace haptrial::sound {
namespace {

constexpr unsigned kLatency = 20'000;         // [us] between a change and its sound
constexpr std::size_t kPart = 240;            // samples at a time: 5 ms
constexpr std::chrono::milliseconds kHad{5};  // that they last

void say_nothing(const char*, int, const char*, int, const char*, ...) {}

struct ClosePcm {
  void operator()(snd_pcm_t* pcm) const { snd_pcm_close(pcm); }
};

}  // namespace

struct CardPlayer::Card {
  std::unique_ptr<snd_pcm_t, ClosePcm> pcm;

  Card(const std::string& device, unsigned channels) {
    snd_lib_error_set_handler(say_nothing);  // what is wrong is said below, in a sentence
    snd_pcm_t* opened = nullptr;
    int error = snd_pcm_open(&opened, device.c_str(), SND_PCM_STREAM_PLAYBACK, 0);
    pcm.reset(opened);
    if (error >= 0) {
      constexpr auto kWhole = static_cast<unsigned>(kRate);
      error = snd_pcm_set_params(opened, SND_PCM_FORMAT_FLOAT, SND_PCM_ACCESS_RW_INTERLEAVED,
                                 channels, kWhole, 1, kLatency);
    }
    if (error < 0) {
      throw RunError(fmt::format("sound card '{}': {}", device, snd_strerror(error)));
    }
  }
};

CardPlayer::CardPlayer(const std::string& device, Fill fill, Handed handed, unsigned channels)
    : fill_(std::move(fill)),
      handed_(std::move(handed)),
      channels_(channels),
      card_(std::make_unique<Card>(device, channels)) {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

CardPlayer::~CardPlayer() = default;

/// Samples that the card has run out of time for are tried once more. @returns whether it took them
bool CardPlayer::write(std::span<const float> part, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const snd_pcm_sframes_t written = snd_pcm_writei(
        card_->pcm.get(), part.data(), static_cast<snd_pcm_uframes_t>(part.size() / channels_));
    if (written >= 0) {
      played_.fetch_add(static_cast<std::uint64_t>(written), std::memory_order_relaxed);
      part = part.subspan(channels_ * static_cast<std::size_t>(written));
      if (part.empty()) {
        return true;
      }
      continue;
    }
    gaps_.fetch_add(1, std::memory_order_relaxed);
    if (snd_pcm_recover(card_->pcm.get(), static_cast<int>(written), 1) < 0) {
      lost_.store(true, std::memory_order_relaxed);
      return false;
    }
  }
  return false;
}

void CardPlayer::run(const std::stop_token& stop) {
  using Clock = std::chrono::steady_clock;
  std::vector<float> part(channels_ * kPart);
  Clock::time_point due = Clock::now();
  while (!stop.stop_requested()) {
    fill_(part);
    if (!write(part, stop)) {
      return;
    }
    if (handed_) {
      handed_();
    }
    // A card makes this thread wait; one that only swallows samples must not be fed without pause.
    due = std::max(due + kHad, Clock::now() - 4 * kHad);
    std::this_thread::sleep_until(due - 4 * kHad);
  }
}

}  // namespace haptrial::sound
