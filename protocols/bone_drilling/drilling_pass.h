#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>

#include "core/bone/nerve/nerve_exposures.h"
#include "core/bone/simulator/companions.h"
#include "core/bone/simulator/drilling_view.h"
#include "core/bone/simulator/simulator.h"
#include "core/sound/drill_sound.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/drilling_rows.h"
#include "protocols/bone_drilling/region_guard.h"
#include "protocols/bone_drilling/shared_bone.h"
#include "protocols/interface/pass.h"

namespace haptrial::protocols {

/// A reading on the grids of the session file: what is simulated from it, is simulated again from
/// the file. Servo thread.
device::DeviceReading as_recorded(const device::DeviceReading& reading) noexcept;

/// Turns recorded readings into inputs of the simulator.
class DrillingInput {
 public:
  /// @throws std::invalid_argument for a handle without length or a scale not above 0.
  explicit DrillingInput(const DrillingParameters& parameters);
  /// @param second  of the second device, as it is recorded; null: there is one device
  bone::SimulatorInput of(const device::DeviceReading& recorded, double dt,
                          const device::DeviceReading* second = nullptr) const noexcept;

 private:
  DrillingParameters parameters_;
  Eigen::Quaterniond grip_;         // from the tool frame T to the handle's
  Eigen::Quaterniond second_grip_;  // likewise, of the tube
};

/// The participant's view of a simulator.
bone::DrillingView view_of(const bone::Simulator& simulator,
                           const bone::SimulatorInput& input) noexcept;

/// Force of the burr's shaking on the hand: neither drilled with nor recorded as contact. Servo
/// thread. @param vibration  null: it does not shake; nor does a tool that is no burr
/// @param force  between burr and bone [N]
Eigen::Vector3d shaking(sound::DrillVibration* vibration, const bone::Simulator& simulator,
                        bool contact, double force, const ToolState& tool) noexcept;

/// Work on a bone: drilling, suction, cutting, plating, looking around. Ends when the time is over
/// or the participant says so. Source: Morris 2006, §3.2 and §8.2.2.
class DrillingPass final : public Pass {
 public:
  /// Everything given outlives the pass.
  /// @param spent      ticks of the time limit that passes before this one have taken
  /// @param vibration  of the burr; null: it does not shake
  /// @param nerves     of the bone; null: nobody watches them
  DrillingPass(bone::Simulator& simulator, bone::Companions& companions,
               const DrillingParameters& parameters, DrillingLogs& logs, double rate,
               std::uint64_t spent = 0, sound::DrillVibration* vibration = nullptr,
               nerve::NerveExposures* nerves = nullptr);

  /// Shares the bone with another session, which follows it; call before the pass begins.
  void share(SharedBone& shared) noexcept { shared_ = &shared; }
  /// Gives hints; likewise. @param hints  outlive the pass
  void give(hint::HintsBeside& hints) noexcept { hints_ = &hints; }
  /// Keeps burrs out of forbidden regions; likewise. @param guard  outlives the pass
  void keep_out(RegionGuard& guard) noexcept { guard_ = &guard; }

  /// Takes tuned constants; likewise. @param tuning  outlives the pass
  void tune_by(LiveTuning& tuning) noexcept { tuning_ = &tuning; }

  void begin(std::uint64_t sequence) noexcept override;
  PassOutput tick(const Readings& readings, double dt) noexcept override;
  std::span<const Drive> others() const noexcept override {
    return {&second_, parameters_.second ? 1U : 0U};
  }
  PassState state() const noexcept override { return state_; }
  bool wants_attention() noexcept override;

  /// Ticks of this pass and those before it. Not the servo thread while it ticks.
  std::uint64_t ticks() const noexcept { return ticks_; }

 private:
  bone::Simulator& simulator_;
  bone::Companions& companions_;
  DrillingParameters parameters_;
  DrillingInput input_;
  Drive second_;  // of the second device
  DrillingLogs& logs_;
  DrillingRows rows_;
  sound::DrillVibration* vibration_;
  nerve::NerveExposures* nerves_;
  SharedBone* shared_{nullptr};
  hint::HintsBeside* hints_{nullptr};
  RegionGuard* guard_{nullptr};
  LiveTuning* tuning_{nullptr};
  std::uint64_t time_limit_;  // [ticks]
  std::uint64_t ticks_;
  std::uint64_t sequence_{0};
  bool first_{true};
  std::array<std::uint64_t, 3> attended_{};  // rows of each log, when attention was asked for last
  PassState state_{PassState::kRunning};
};

}  // namespace haptrial::protocols
