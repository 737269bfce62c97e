#include "protocols/bone_drilling/trial_nerves.h"

#include <fmt/format.h>

#include "core/base/random.h"
#include "core/bone/nerve/nerve_rows.h"
#include "protocols/bone_drilling/nerve_page.h"
#include "protocols/interface/session_file.h"

namespace haptrial::protocols {

/// A session that goes on has other noise than before.
TrialNerves::TrialNerves(const BoneDefinition& definition, const SessionPlace& place,
                         const std::shared_ptr<nerve::NerveVoice>& voice)
    : d_(definition),
      pulse_(std::make_shared<std::atomic<float>>(static_cast<float>(d_.nerves->current))) {
  for (const nerve::Channel& channel : nerve::channels_of(*d_.nerves)) {
    channels_.push_back({static_cast<std::int32_t>(channels_.size()), channel.name, channel.nerve,
                         d_.nerves->monitor.rate});
  }
  const auto make = [setup = *d_.nerves, rate = d_.rate, seed = place.session_seed,
                     pulse = pulse_](std::uint64_t first) {
    const std::string name = fmt::format("nerves from tick {}", first);
    return std::make_unique<nerve::NerveSimulation>(setup, rate, derived_seed(seed, name), pulse);
  };
  if (place.real) {
    const auto page = page_of<NervePage>(place.auxiliary_pages);
    const nerve::NerveListeners listeners{page ? page->buffer() : nullptr, voice};
    beside_ = std::make_unique<nerve::ThreadedNerves>(make, d_.rate, listeners);
  } else {
    beside_ = std::make_unique<nerve::SteppedNerves>(make);
  }
}

void TrialNerves::watch(std::size_t bone, std::int32_t used, std::uint64_t spent,
                        std::uint64_t seed) {
  const std::string name = fmt::format("nerves {} from tick {}", used, spent);
  exposures_ = std::make_unique<nerve::NerveExposures>(
      *d_.nerves, d_.nerve_distances[bone], derived_seed(seed, name), 1.0 / d_.rate, pulse_);
}

void TrialNerves::write(SessionFile& file) {
  beside_->settle();  // rows of a tick come before its sample
  const record::NerveRows rows = beside_->take();
  file.add(std::span(rows.emg));
  file.add(std::span(rows.events));
  file.add(std::span(rows.thresholds));
  file.add(std::span(rows.stimuli));
  file.add(std::span(rows.discharges));
}

}  // namespace haptrial::protocols
