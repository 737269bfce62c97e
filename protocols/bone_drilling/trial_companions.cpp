#include "protocols/bone_drilling/trial_companions.h"

#include <fmt/format.h>

#include <atomic>
#include <utility>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/bone/nerve/nerve_rows.h"
#include "core/record/read/session_reader.h"
#include "protocols/bone_drilling/nerve_page.h"
#include "protocols/interface/session_file.h"

namespace haptrial::protocols {
namespace {

/// Tells the watch the bone that was drilled away before.
void tell_gone(const bone::BoneWorld& world, const geometry::VoxelGrid& grid,
               hint::HintWatch& watch) {
  geometry::visit_voxels(grid, [&](const bone::Voxel& voxel, std::size_t) {
    if (world.holder(voxel) < 0) {
      watch.gone(voxel);
    }
  });
}

}  // namespace

TrialHints::TrialHints(const BoneDefinition& definition, bool real,
                       std::shared_ptr<hint::Chime> chime)
    : d_(definition), limits_(record::limit_rows(definition.hints->limits)) {
  if (real) {
    beside_ = std::make_unique<hint::ThreadedHints>(std::move(chime));
  } else {
    beside_ = std::make_unique<hint::SteppedHints>(std::move(chime));
  }
}

void TrialHints::check_resumed(const record::SessionReader& file) const {
  if (file.rows<record::HintLimitRow>() != limits_) {
    throw InputError(fmt::format(
        "{}: its hints went by other safe values than {} has now; resume it with the same file",
        file.path().string(), d_.hints->file));
  }
}

void TrialHints::watch(std::size_t bone, const bone::Simulator& simulator) {
  const std::shared_ptr<const bone::BoneModel>& model = d_.bones[bone];
  auto watch = std::make_unique<hint::HintWatch>(*d_.hints, d_.hint_maps[bone], model,
                                                 pose_of(d_.placement, model->grid), d_.rate);
  if (simulator.emptied_so_far() > 0) {
    tell_gone(simulator.world(), model->grid, *watch);
  }
  beside_->begin(std::move(watch));
}

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

namespace {

/// The notes where a burr enters a forbidden region: between those of hints and of injuries.
constexpr hint::ChimeNotes kRegionNotes{660.0, 660.0, 0.3};

}  // namespace

TrialSound::TrialSound(const BoneDefinition& definition, const SessionPlace& place,
                       const std::shared_ptr<LiveTuning>& tuning) {
  if (!definition.sound_card || !place.real) {
    return;
  }
  try {
    open(definition, place, tuning);
  } catch (const RunError& error) {
    trouble_ = error.what();
    nerves_.reset();
    hints_.reset();
    regions_.reset();
  }
}

void TrialSound::open(const BoneDefinition& d, const SessionPlace& place,
                      const std::shared_ptr<LiveTuning>& tuning) {
  if (d.nerves) {
    nerves_ = std::make_shared<nerve::NerveVoice>(d.nerves->monitor.rate);
  }
  if (d.hints && d.hints->sound) {
    hints_ = std::make_shared<hint::Chime>();
  }
  if (d.forbidden) {
    regions_ = std::make_shared<hint::Chime>(kRegionNotes);
  }
  const auto mix = [nerves = nerves_, hints = hints_, regions = regions_](std::span<float> part) {
    const auto add = [part](const auto& source) {
      if (source) {
        source->mix(part);
      }
    };
    add(nerves);
    add(hints);
    add(regions);
  };
  BoneSound::ThinBoneNow thin;
  if (tuning) {
    thin = [tuning] { return tuning->thin_bone(); };
  }
  drill_ = std::make_unique<BoneSound>(d, derived_seed(place.session_seed, "sound"), mix, thin);
}

void TrialSound::listen_to(const std::shared_ptr<const BoneStage>& stage) {
  if (drill_) {
    drill_->listen_to(stage);
  }
}

}  // namespace haptrial::protocols
