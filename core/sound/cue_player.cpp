#include "core/sound/cue_player.h"

#include <span>

#include "core/sound/card_player.h"
#include "core/sound/mixer.h"

namespace haptrial::sound {
namespace {

Mixer mixer_of(const CueSet& set, std::uint64_t seed) {
  std::vector<std::vector<float>> clips;
  for (const Cue& cue : set.cues) {
    clips.push_back(rendered(cue, seed));
  }
  const bool masked = set.masking.has_value();
  return {std::move(clips), masked ? rendered(*set.masking, seed) : std::vector<float>{},
          masked ? set.masking->fade : 0.0, CardPlayer::kRate};
}

}  // namespace

struct CuePlayer::Impl {
  Impl(const CueSet& set, std::uint64_t seed, std::function<std::int64_t()> clock)
      : now(std::move(clock)),
        mixer(mixer_of(set, seed)),
        player(
            set.device, [this](std::span<float> part) { fill(part); }, [this] { hand_over(); }) {}

  void fill(std::span<float> part);
  void hand_over();

  std::function<std::int64_t()> now;
  Mixer mixer;
  std::vector<std::uint64_t> begun;  // with the samples that the card has not taken yet

  mutable std::mutex mutex;  // all that follow
  std::vector<std::pair<std::size_t, std::uint64_t>> asked;
  bool masked{false};
  std::vector<StartedCue> started;

  CardPlayer player;  // last: its thread uses the others
};

void CuePlayer::Impl::fill(std::span<float> part) {
  {
    const std::lock_guard lock(mutex);
    for (const auto& [cue, ticket] : asked) {
      mixer.start(cue);
      begun.push_back(ticket);
    }
    asked.clear();
    mixer.mask(masked);
  }
  mixer.fill(part);
}

void CuePlayer::Impl::hand_over() {
  if (begun.empty()) {
    return;
  }
  const std::int64_t time = now();
  const std::lock_guard lock(mutex);
  for (const std::uint64_t ticket : begun) {
    started.push_back({ticket, time});
  }
  begun.clear();
}

CuePlayer::CuePlayer(const CueSet& set, std::uint64_t seed, std::function<std::int64_t()> now)
    : impl_(std::make_unique<Impl>(set, seed, std::move(now))) {}

CuePlayer::~CuePlayer() = default;

void CuePlayer::start(std::size_t cue, std::uint64_t ticket) {
  const std::lock_guard lock(impl_->mutex);
  impl_->asked.emplace_back(cue, ticket);
}

void CuePlayer::mask(bool on) {
  const std::lock_guard lock(impl_->mutex);
  impl_->masked = on;
}

std::vector<StartedCue> CuePlayer::take_started() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->started, {});
}

std::string CuePlayer::trouble() const {
  if (impl_->player.lost()) {
    return "the sound card was lost: nothing was played from then on";
  }
  if (impl_->mixer.limited() > 0) {
    return "the sounds together were too loud for the card and were made softer; lower their "
           "levels";
  }
  if (impl_->player.gaps() > 0) {
    return "the sound card ran out of samples: sounds have gaps";
  }
  return "";
}

}  // namespace haptrial::sound
