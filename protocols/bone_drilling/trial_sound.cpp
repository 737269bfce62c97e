#include "protocols/bone_drilling/trial_sound.h"

#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial::protocols {
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
