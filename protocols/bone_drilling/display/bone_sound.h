#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/bone/hint/chime.h"
#include "core/bone/model/thickness.h"
#include "core/realtime/latest_value.h"
#include "core/sound/drill_sound.h"
#include "core/stimulus/observer.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/display/bone_stage.h"

namespace haptrial::protocols {

/// How thick the bone under a burr is (Morris 2006, §3.2.9). Any one thread but the servo thread;
/// allocates.
class ThicknessProbe {
 public:
  explicit ThicknessProbe(std::shared_ptr<const BoneStage> stage) : stage_(std::move(stage)) {}
  /// The mean over the surface in reach of the burr, in any piece; thick where there is none [m].
  double under(const bone::DrillingView& seen);

 private:
  std::shared_ptr<const BoneStage> stage_;
  std::vector<bone::Voxel> voxels_;
};

/// Audible state of a drill at this instant.
sound::DrillState sound_of(const bone::DrillingView& seen, std::span<const bone::ToolSpec> tools,
                           double thickness) noexcept;

/// Rings when a vital structure is opened. Servo thread.
class InjuryChime {
 public:
  void hear(const bone::DrillingView& seen) noexcept;
  /// Adds the next samples to what is there; any one thread.
  void mix(std::span<float> part) noexcept { chime_.mix(part); }

 private:
  hint::Chime chime_{hint::kInjuryNotes};
  bone::LastInjury before_;
};

/// The sound of a drilling on the sound card. The servo thread calls observe(), the session's
/// thread the rest; a thread of its own finds the thickness.
class BoneSound final : public stimulus::Observer {
 public:
  /// Servo thread: no allocation, lock or throw.
  using ThinBoneNow = std::function<sound::ThinBone()>;

  /// @param mix  what else is heard on the same card; may be empty
  /// @param thin    what is tuned of thin bone, asked on each tick; empty: nothing is
  /// @throws RunError where there is no sound card.
  BoneSound(const BoneDefinition& definition, std::uint64_t seed, sound::SoundOutput::Mix mix = {},
            ThinBoneNow thin = {});

  /// Which bone is drilled from now on.
  void listen_to(std::shared_ptr<const BoneStage> stage);
  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double dt) noexcept override;

 private:
  void run(const std::stop_token& stop);

  InjuryChime injury_;
  sound::SoundOutput output_;
  std::vector<bone::ToolSpec> tools_;
  ThinBoneNow thin_;
  realtime::LatestValue<bone::DrillingView> seen_;
  std::atomic<double> thickness_{1.0};  // [m]
  std::mutex mutex_;                    // never taken by the servo thread
  std::shared_ptr<const BoneStage> stage_;
  std::jthread thread_;  // last: it ends before what it uses
};

}  // namespace haptrial::protocols
