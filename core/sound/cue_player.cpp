#include "core/sound/cue_player.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "core/sound/card_player.h"
#include "core/sound/mixer.h"
#include "core/sound/speech_track.h"

namespace haptrial::sound {
namespace {

/// A text that waits until nothing else is heard.
struct WaitingText {
  std::vector<float> clip;
  std::uint64_t ticket{0};
};

/// The sounds of the loudspeakers, or of one actuator, on a channel of their own.
struct Output {
  std::size_t channel;            // from 0
  std::vector<std::size_t> cues;  // which it plays: those of the set, then those of the trial
  std::size_t fixed{0};           // of them, of the set
  std::unique_ptr<Mixer> mixer;
};

/// Sounds of a trial, by output.
struct VariedClips {
  std::vector<std::vector<std::size_t>> cues;   // (outputs) their numbers
  std::vector<std::vector<Mixer::Clip>> clips;  // likewise
};

/// Whether loudspeakers play the sound; else the actuator does.
bool plays_on(const Cue& cue, const Actuator* actuator) {
  return actuator == nullptr ? cue.actuator.empty() : cue.actuator == actuator->name;
}

/// @param actuator  null: the loudspeakers, which have the masking noise, too
Output output_of(const CueSet& set, const Actuator* actuator, std::uint64_t seed) {
  Output output{
      actuator == nullptr ? 0 : static_cast<std::size_t>(actuator->channel - 1), {}, 0, {}};
  std::vector<std::vector<float>> clips;
  for (std::size_t i = 0; i < set.cues.size(); ++i) {
    if (!set.cues[i].varies && plays_on(set.cues[i], actuator)) {
      output.cues.push_back(i);
      clips.push_back(rendered(set.cues[i], seed));
    }
  }
  output.fixed = output.cues.size();
  const bool masked = actuator == nullptr && set.masking.has_value();
  output.mixer = std::make_unique<Mixer>(
      std::move(clips), masked ? rendered(*set.masking, seed) : std::vector<float>{},
      masked ? set.masking->fade : 0.0, CardPlayer::kRate);
  return output;
}

/// The loudspeakers' comes first.
std::vector<Output> outputs_of(const CueSet& set, std::uint64_t seed) {
  std::vector<Output> outputs;
  outputs.push_back(output_of(set, nullptr, seed));
  for (const Actuator& actuator : set.actuators) {
    outputs.push_back(output_of(set, &actuator, seed));
  }
  return outputs;
}

/// One channel, which a card gives to all loudspeakers; with actuators as many as they reach.
unsigned channels_of(const CueSet& set) {
  constexpr int kLoudspeakers = 2;
  int channels = set.actuators.empty() ? 1 : kLoudspeakers;
  for (const Actuator& actuator : set.actuators) {
    channels = std::max(channels, actuator.channel);
  }
  return static_cast<unsigned>(channels);
}

}  // namespace

struct CuePlayer::Impl {
  Impl(const CueSet& from, std::uint64_t of_session, std::function<std::int64_t()> clock)
      : set(from),
        seed(of_session),
        now(std::move(clock)),
        outputs(outputs_of(set, seed)),
        channels(channels_of(set)),
        player(
            set.device, [this](std::span<float> part) { fill(part); }, [this] { hand_over(); },
            channels) {}

  void fill(std::span<float> part);
  void fill_output(Output& output, std::span<float> samples);
  void take_requests();
  void take_speech();
  void begin(std::size_t cue);
  void begin_all(std::vector<std::pair<std::size_t, std::uint64_t>>& cues);
  void take(const VariedClips& varied);
  bool is_asked() const { return !asked_before.empty() || !asked.empty(); }
  bool is_felt(std::size_t cue) const;
  void spread(std::span<float> part);
  void hand_over();

  CueSet set;
  std::uint64_t seed;
  std::function<std::int64_t()> now;
  std::vector<Output> outputs;
  unsigned channels;
  std::vector<float> own;                   // of one output
  std::vector<std::uint64_t> begun;         // with the samples that the card has not taken yet
  std::optional<std::uint64_t> begun_text;  // likewise
  SpeechTrack speech{CardPlayer::kRate};

  mutable std::mutex mutex;                                                // all that follow
  std::vector<std::pair<std::size_t, std::uint64_t>> asked, asked_before;  // varied were taken
  std::optional<VariedClips> varied;                                       // not yet taken
  bool masked{false};
  bool stilled{false};  // before what is asked for
  std::vector<StartedCue> started;
  std::optional<WaitingText> waiting;
  bool hushed{false};
  bool speaking{false};  // as of the last part
  std::vector<StartedCue> said;

  CardPlayer player;  // last: its thread uses the others
};

bool CuePlayer::Impl::is_felt(std::size_t cue) const {
  const std::vector<std::size_t>& fixed = outputs.front().cues;
  const bool is_new = varied && cue >= set.cues.size();
  const std::vector<std::size_t>& heard = is_new ? varied->cues.front() : fixed;
  return std::ranges::find(heard, cue) == heard.end();
}

void CuePlayer::Impl::begin(std::size_t cue) {
  for (Output& output : outputs) {
    const auto at = std::ranges::find(output.cues, cue);
    if (at != output.cues.end()) {
      output.mixer->start(static_cast<std::size_t>(at - output.cues.begin()));
    }
  }
}

/// Starts what was asked for.
void CuePlayer::Impl::begin_all(std::vector<std::pair<std::size_t, std::uint64_t>>& cues) {
  for (const auto& [cue, ticket] : cues) {
    begin(cue);
    begun.push_back(ticket);
  }
  cues.clear();
}

void CuePlayer::Impl::take(const VariedClips& taken) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    outputs[i].cues.resize(outputs[i].fixed);
    outputs[i].cues.insert(outputs[i].cues.end(), taken.cues[i].begin(), taken.cues[i].end());
    outputs[i].mixer->take_further(taken.clips[i]);
  }
}

/// Speech is cut before a sound begins: what was asked for waits for the next part.
void CuePlayer::Impl::take_requests() {
  if (std::exchange(stilled, false)) {
    for (Output& output : std::span(outputs).subspan(1)) {
      output.mixer->still();
    }
  }
  if (speech.sounds() && (is_asked() || masked)) {
    speech.stop();
    return;
  }
  begin_all(asked_before);
  if (varied) {
    take(*varied);
    varied.reset();
  }
  begin_all(asked);
  outputs.front().mixer->mask(masked);
}

void CuePlayer::Impl::take_speech() {
  if (std::exchange(hushed, false)) {
    speech.stop();
  }
  const bool heard = masked || std::ranges::any_of(outputs, [](const Output& output) {
                       return output.mixer->sounds();
                     });
  if (waiting && !heard && !is_asked() && !speech.sounds()) {
    speech.start(std::move(waiting->clip));
    begun_text = waiting->ticket;
    waiting.reset();
  }
  speaking = speech.sounds();
}

void CuePlayer::Impl::fill_output(Output& output, std::span<float> samples) {
  output.mixer->fill(samples);
  if (&output == &outputs.front()) {
    speech.add(samples);
  }
}

void CuePlayer::Impl::fill(std::span<float> part) {
  {
    const std::lock_guard lock(mutex);
    take_requests();
    take_speech();
  }
  if (channels == 1) {
    fill_output(outputs.front(), part);
  } else {
    spread(part);
  }
}

/// Each output on its channel; the loudspeakers are the first two that no actuator has.
void CuePlayer::Impl::spread(std::span<float> part) {
  constexpr std::size_t kLoudspeakers = 2;
  std::ranges::fill(part, 0.0F);
  own.resize(part.size() / channels);
  for (Output& output : outputs) {
    fill_output(output, own);
    const bool speakers = &output == &outputs.front();
    for (std::size_t channel = 0; channel < channels; ++channel) {
      if (speakers ? channel < kLoudspeakers : channel == output.channel) {
        for (std::size_t i = 0; i < own.size(); ++i) {
          part[i * channels + channel] = own[i];
        }
      }
    }
  }
}

void CuePlayer::Impl::hand_over() {
  if (begun.empty() && !begun_text) {
    return;
  }
  const std::int64_t time = now();
  const std::lock_guard lock(mutex);
  for (const std::uint64_t ticket : begun) {
    started.push_back({ticket, time});
  }
  begun.clear();
  if (begun_text) {
    said.push_back({*begun_text, time});
    begun_text.reset();
  }
}

CuePlayer::CuePlayer(const CueSet& set, std::uint64_t seed, std::function<std::int64_t()> now)
    : impl_(std::make_unique<Impl>(set, seed, std::move(now))) {}

CuePlayer::~CuePlayer() = default;

void CuePlayer::take_varied(const std::vector<Cue>& cues) {
  VariedClips varied{std::vector<std::vector<std::size_t>>(impl_->outputs.size()),
                     std::vector<std::vector<Mixer::Clip>>(impl_->outputs.size())};
  for (std::size_t i = 0; i < cues.size(); ++i) {
    const auto clip = std::make_shared<const std::vector<float>>(rendered(cues[i], impl_->seed));
    for (std::size_t output = 0; output < impl_->outputs.size(); ++output) {
      const Actuator* actuator = output == 0 ? nullptr : &impl_->set.actuators[output - 1];
      if (plays_on(cues[i], actuator)) {
        varied.cues[output].push_back(impl_->set.cues.size() + i);
        varied.clips[output].push_back(clip);
      }
    }
  }
  const std::lock_guard lock(impl_->mutex);
  impl_->asked_before.insert(impl_->asked_before.end(), impl_->asked.begin(), impl_->asked.end());
  impl_->asked.clear();
  impl_->varied = std::move(varied);
}

void CuePlayer::start(std::size_t cue, std::uint64_t ticket) {
  const std::lock_guard lock(impl_->mutex);
  impl_->asked.emplace_back(cue, ticket);
}

/// Vibrations that were asked for and have not begun do not begin.
void CuePlayer::still() {
  const std::lock_guard lock(impl_->mutex);
  impl_->stilled = true;
  for (auto* asked : {&impl_->asked_before, &impl_->asked}) {
    std::erase_if(*asked, [this](const auto& each) {
      const bool felt = impl_->is_felt(each.first);
      if (felt) {
        impl_->started.push_back({each.second, -1});
      }
      return felt;
    });
  }
}

void CuePlayer::mask(bool on) {
  const std::lock_guard lock(impl_->mutex);
  impl_->masked = on;
}

std::vector<StartedCue> CuePlayer::take_started() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->started, {});
}

void CuePlayer::say(std::vector<float> clip, std::uint64_t ticket) {
  const std::lock_guard lock(impl_->mutex);
  impl_->hushed = true;
  impl_->waiting = WaitingText{std::move(clip), ticket};
}

void CuePlayer::forget() {
  const std::lock_guard lock(impl_->mutex);
  impl_->waiting.reset();
}

void CuePlayer::hush() {
  const std::lock_guard lock(impl_->mutex);
  impl_->waiting.reset();
  impl_->hushed = true;
}

bool CuePlayer::speaks() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->waiting || impl_->speaking;
}

std::vector<StartedCue> CuePlayer::take_said() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->said, {});
}

bool CuePlayer::lost() const { return impl_->player.lost(); }

std::string CuePlayer::trouble() const {
  if (lost()) {
    return "the sound card was lost: nothing was played from then on";
  }
  const bool limited = std::ranges::any_of(
      impl_->outputs, [](const Output& output) { return output.mixer->limited() > 0; });
  if (limited) {
    return "the sounds together were too loud for the card and were made softer; lower their "
           "levels";
  }
  if (impl_->player.gaps() > 0) {
    return "the sound card ran out of samples: sounds have gaps";
  }
  return "";
}

}  // namespace haptrial::sound
