#include "protocols/bone_drilling/display/bone_sound.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace haptrial::protocols {
namespace {

constexpr double kThick = 1.0;  // where there is no thin bone to be heard [m]

}  // namespace

double ThicknessProbe::under(const bone::DrillingView& seen) {
  const bone::BoneWorld& world = std::as_const(*stage_->simulator).world();
  const bone::ToolSpec& tool = stage_->simulator->tools()[static_cast<std::size_t>(seen.tool)];
  const auto* burr = tool.as<bone::BurrTool>();
  if (burr == nullptr || !seen.contact) {
    return kThick;
  }
  double thinnest = kThick;
  world.published_poses().read(world.pieces(), [&](int piece, const Eigen::Isometry3d& pose) {
    const bone::BoneVolume& volume = world.volume(piece);
    const double reach =
        bone::BurrShape(burr->burr.dimensions()).reach() + 2.0 * volume.grid().spacing;
    bone::surface_voxels_within(volume, pose.inverse(Eigen::Isometry) * seen.tip, reach, voxels_);
    if (const auto mean = bone::mean_thickness(volume, voxels_)) {
      thinnest = std::min(thinnest, *mean);
    }
  });
  return thinnest;
}

sound::DrillState sound_of(const bone::DrillingView& seen, std::span<const bone::ToolSpec> tools,
                           double thickness) noexcept {
  sound::DrillState state;
  const bone::ToolSpec& tool = tools[static_cast<std::size_t>(seen.tool)];
  const auto* burr = tool.as<bone::BurrTool>();
  if (!seen.shown || burr == nullptr) {
    return state;
  }
  state.burr =
      burr->burr.kind == bone::BurrKind::kDiamond ? sound::Burr::kDiamond : sound::Burr::kCutting;
  state.speed = seen.power ? 1.0 : 0.0;
  state.contact = seen.contact;
  state.force = seen.sound_force;
  state.thickness = thickness;
  return state;
}

void InjuryChime::hear(const bone::DrillingView& seen) noexcept {
  if (bone::begins(std::exchange(before_, seen.injury), seen.injury)) {
    chime_.ring();
  }
}

BoneSound::BoneSound(const BoneDefinition& definition, std::uint64_t seed,
                     sound::SoundOutput::Mix mix, ThinBoneNow thin)
    : output_(definition.sound_table, definition.thin_bone, seed, "default",
              [this, others = std::move(mix)](std::span<float> part) {
                injury_.mix(part);
                if (others) {
                  others(part);
                }
              }),
      tools_(definition.simulator.tools),
      thin_(std::move(thin)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void BoneSound::listen_to(std::shared_ptr<const BoneStage> stage) {
  const std::lock_guard lock(mutex_);
  stage_ = std::move(stage);
}

void BoneSound::observe(const stimulus::Shown& shown, const stimulus::Forces&, double) noexcept {
  const auto* view = shown.as<bone::DrillingView>();
  const bone::DrillingView seen = view != nullptr ? *view : bone::DrillingView{};
  seen_.write(seen);
  injury_.hear(seen);
  sound::DrillState state = sound_of(seen, tools_, thickness_.load(std::memory_order_relaxed));
  if (thin_) {
    state.thin = thin_();
  }
  output_.set(state);
}

void BoneSound::run(const std::stop_token& stop) {
  constexpr std::chrono::milliseconds kBetween{20};
  bone::DrillingView seen;
  while (!stop.stop_requested()) {
    std::shared_ptr<const BoneStage> stage;
    {
      const std::lock_guard lock(mutex_);
      stage = stage_;
    }
    seen_.read(seen);
    if (stage && seen.shown) {
      thickness_.store(ThicknessProbe(stage).under(seen), std::memory_order_relaxed);
    }
    std::this_thread::sleep_for(kBetween);
  }
}

}  // namespace haptrial::protocols
