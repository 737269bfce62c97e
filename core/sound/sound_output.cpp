#include "core/sound/sound_output.h"

#include <alsa/asoundlib.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
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

struct SoundOutput::Card {
  std::unique_ptr<snd_pcm_t, ClosePcm> pcm;

  explicit Card(const std::string& device) {
    snd_lib_error_set_handler(say_nothing);  // what is wrong is said below, in a sentence
    snd_pcm_t* opened = nullptr;
    int error = snd_pcm_open(&opened, device.c_str(), SND_PCM_STREAM_PLAYBACK, 0);
    pcm.reset(opened);
    if (error >= 0) {
      constexpr auto kRate = static_cast<unsigned>(DrillSound::kRate);
      error = snd_pcm_set_params(opened, SND_PCM_FORMAT_FLOAT, SND_PCM_ACCESS_RW_INTERLEAVED, 1,
                                 kRate, 1, kLatency);
    }
    if (error < 0) {
      throw RunError(
          fmt::format("sound card '{}': {}; the session's sound can be written to a WAV "
                      "file instead",
                      device, snd_strerror(error)));
    }
  }
};

SoundOutput::SoundOutput(SpectrumTable table, const ThinBone& thin, std::uint64_t seed,
                         const std::string& device)
    : sound_(std::move(table), thin, seed), card_(std::make_unique<Card>(device)) {
  thread_ = std::thread([this] { run(); });
}

SoundOutput::~SoundOutput() {
  stop_.store(true, std::memory_order_relaxed);
  thread_.join();
}

void SoundOutput::run() {
  using Clock = std::chrono::steady_clock;
  std::array<float, kPart> part{};
  DrillState drill;
  Clock::time_point due = Clock::now();
  while (!stop_.load(std::memory_order_relaxed)) {
    if (latest_.read(drill)) {
      sound_.set(drill);
    }
    for (float& sample : part) {
      sample = sound_.next();
    }
    snd_pcm_sframes_t written = snd_pcm_writei(card_->pcm.get(), part.data(), kPart);
    if (written < 0) {
      gaps_.fetch_add(1, std::memory_order_relaxed);
      if (snd_pcm_recover(card_->pcm.get(), static_cast<int>(written), 1) < 0) {
        lost_.store(true, std::memory_order_relaxed);
        return;
      }
      continue;
    }
    played_.fetch_add(static_cast<std::uint64_t>(written), std::memory_order_relaxed);
    // A card makes this thread wait; one that only swallows samples must not be fed without pause.
    due = std::max(due + kHad, Clock::now() - 4 * kHad);
    std::this_thread::sleep_until(due - 4 * kHad);
  }
}

}  // namespace haptrial::sound
